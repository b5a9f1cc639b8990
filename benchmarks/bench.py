"""Benchmarks: ``make bench``: every figure measured beside the one wanted, and beside the peers.

``python benchmarks/bench.py [SECTION …] [--json] [--picture SVG]``; without a section, all of them. A missed
figure is told, never an error: another machine, another load. Progress goes to standard error.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks import (
    accuracy,
    cost,
    decoders,
    door,
    gestures,
    ghost,
    page,
    picture,
    recordings,
    start,
    studies,
    town,
)
from benchmarks.figures import Figure, Section, table

SECTIONS = {
    "accuracy": accuracy.accuracy,
    "kinds": accuracy.simulated_kinds,
    "cost": cost.cost,
    "start": start.start,
    "decoders": decoders.decoders,
    "gestures": gestures.gestures,
    "ghost": ghost.ghost,
    "page": page.page,
    "door": door.door,
    "recordings": recordings.recordings,
    "studies": studies.studies,
    "town": town.town,
}


def main() -> int:
    """Measure the sections asked for."""
    parser = argparse.ArgumentParser(prog="bench.py", description="Figures measured beside those wanted.")
    parser.add_argument("sections", nargs="*", metavar="SECTION", help=", ".join(SECTIONS))
    parser.add_argument("--json", action="store_true", help="one JSON object instead of the tables")
    parser.add_argument("--picture", metavar="SVG", type=Path, help="draw the accuracy section there")
    options = parser.parse_args()
    unknown = [name for name in options.sections if name not in SECTIONS]
    if unknown:
        parser.error(f"{unknown[0]}: expected one of {', '.join(SECTIONS)}")
    found: dict[str, list[Figure]] = {}
    began = time.monotonic()
    for name in options.sections or SECTIONS:
        found[name] = measure(name, SECTIONS[name]())
        if not options.json:
            print("\n".join(table(name, found[name])), flush=True)
    if options.picture and "accuracy" in found:
        options.picture.write_text(picture.drawn(found["accuracy"]), "utf-8")
    told = {name: [f._asdict() | {"verdict": f.verdict} for f in figures] for name, figures in found.items()}
    if options.json:
        print(json.dumps(told))
    else:
        missed = sum(f.verdict == "MISSED" for figures in found.values() for f in figures)
        print(f"{missed} missed; {time.monotonic() - began:.0f} s; {machine()}")
    return 0


def measure(name: str, section: Section) -> list[Figure]:
    """All figures of a section; each is named on standard error when it is there."""
    figures = []
    for figure in section:
        print(f"  {name}: {figure.what}", file=sys.stderr, flush=True)
        figures.append(figure)
    return figures


def machine() -> str:
    """What else was going on: figures of a busy machine are no figures."""
    load = ", ".join(f"{x:.1f}" for x in os.getloadavg())
    return f"{os.cpu_count()} cores, load {load}"


if __name__ == "__main__":
    sys.exit(main())
