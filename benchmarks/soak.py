"""Benchmarks: ``make soak``, the long runs: kills, sensors, an hour of walk, handling, stalls, sleep.

``python benchmarks/soak.py [--minutes N] [--json] [WORD …]``: N minutes (15 unless told) for an hour of
walk at 8× (7.5 of them) and rough handling (the other half), two thirds of N more for sensors on serial
ports, as long for a stalled browser, half of that for one asleep, three minutes at most for sensors by
network, three for a calibration and a clock, and about five for the kills. With WORDs only the parts whose
titles have them all: ``serial``, ``network``, ``calibration``, ``kills``, …
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks import asleep, calibrating, feeds, handling, hour, kills, links, stalled
from benchmarks.bench import machine, measure
from benchmarks.figures import table

USUAL_MINUTES = 15.0
LEAST_MINUTES, MOST_MINUTES = 0.5, 19.0


def main() -> int:
    """Run the parts and tell."""
    parser = argparse.ArgumentParser(prog="soak.py", description="The long runs, one table.")
    parser.add_argument(
        "--minutes", type=float, default=USUAL_MINUTES, help="of the hour and of the handling together"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object instead of the tables")
    parser.add_argument("words", nargs="*", metavar="WORD", help="only parts whose title has it (stalled, …)")
    options = parser.parse_args()
    if not LEAST_MINUTES <= options.minutes <= MOST_MINUTES:
        parser.error(f"--minutes {options.minutes:g}: expected {LEAST_MINUTES:g} to {MOST_MINUTES:g}")
    half_s, ports_s = 30.0 * options.minutes, 40.0 * options.minutes
    stalled_s, asleep_s = 40.0 * options.minutes, 20.0 * options.minutes
    count = kills.KILLS if options.minutes >= USUAL_MINUTES else kills.KILLS // 10
    feeds_s = min(half_s, 60.0)
    parts = {
        f"{count} kills of a recording": kills.kills(count),
        f"{ports_s / 60:.1f} minutes of sensors on serial ports": links.links(ports_s),
        f"{feeds_s / 60:.1f} minutes of sensors by network": feeds.feeds(feeds_s),
        "a calibration and a clock on serial ports": calibrating.calibrating(),
        f"{8 * half_s / 60:.0f} minutes of walk at 8×": hour.hour(half_s),
        f"{half_s / 60:.1f} minutes of rough handling": handling.handling(half_s),
        f"{stalled_s / 60:.1f} minutes of a stalled browser": stalled.stalled(stalled_s),
        f"{asleep_s / 60:.1f} minutes of a browser asleep": asleep.asleep(asleep_s),
    }
    parts = {name: part for name, part in parts.items() if all(word in name for word in options.words)}
    found = {}
    for name, section in parts.items():
        found[name] = measure(name, section)
        if not options.json:
            print("\n".join(table(name, found[name])), flush=True)
    if options.json:
        told = {
            name: [f._asdict() | {"verdict": f.verdict} for f in figures] for name, figures in found.items()
        }
        print(json.dumps(told))
    else:
        print(machine())
    return 0


if __name__ == "__main__":
    sys.exit(main())
