"""Shell: the performance and accuracy tables, where the checkout they belong to is at hand."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from app.commands.shared import Commands, add_json
from app.motion.basics import InputError

BENCH = Path(__file__).resolve().parent.parent.parent / "benchmarks" / "bench.py"


def add(commands: Commands) -> None:
    """Its options."""
    bench = commands.add_parser("bench", help="figures measured beside those wanted and beside peers'")
    bench.add_argument("sections", nargs="*", metavar="SECTION", help="accuracy, kinds, cost, …; none: all")
    add_json(bench)


def run(options: argparse.Namespace) -> int:
    """Measure, in a process of its own: figures of cost want a quiet one."""
    if not BENCH.is_file():
        raise InputError(f"bench: {BENCH.parent} is not there, expected a checkout: make bench")
    command = [sys.executable, str(BENCH), *options.sections, *(["--json"] if options.json else [])]
    done = subprocess.run(command, stderr=None, check=False).returncode
    return 2 if done else 0
