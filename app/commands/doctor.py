"""Shell: what this machine lacks for a walk."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from app.commands.shared import Commands, add_json

MARKS = {"ok": "ok     ", "advice": "advice ", "problem": "PROBLEM"}


def add(commands: Commands) -> None:
    """Its options."""
    seen = commands.add_parser("doctor", help="what this machine lacks for a walk, and the remedy")
    seen.add_argument(
        "--record", metavar="DIR", type=Path, default=Path("recordings"), help="to be recorded to"
    )
    seen.add_argument("--port", type=int, default=8080)
    seen.add_argument(
        "--source", metavar="SPEC", action="append", default=[],
        help="measure this live source too (default: every port that may be opened); again for another",
    )  # fmt: skip
    add_json(seen)


def run(options: argparse.Namespace) -> int:
    """Look, and tell."""
    from app.shell import doctor, measuring

    machine = doctor.Machine(recordings=options.record, port=options.port)
    findings = doctor.examine(machine)
    sources = options.source or [
        f"serial:{port}" for port in doctor.ports(machine) if doctor.usable(machine, port)
    ]
    findings += measuring.measured(sources)
    well = all(finding.state != "problem" for finding in findings)
    if options.json:
        print(json.dumps({"ok": well, "findings": [finding._asdict() for finding in findings]}))
        return 0
    for finding in findings:
        print(f"{MARKS[finding.state]}  {finding.what}: {finding.told}")
        if finding.remedy:
            print(f"           → {finding.remedy}")
    return 0
