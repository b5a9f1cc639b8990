"""Shell: a source onto the disk, without a browser."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.commands.shared import Commands
from app.motion.basics import InputError


def add(commands: Commands) -> None:
    """Its options."""
    keep = commands.add_parser("record", help="a source onto the disk, without a browser")
    keep.add_argument("--source", metavar="SPEC", required=True)
    keep.add_argument("--record", metavar="DIR", type=Path, required=True)
    keep.add_argument("--seconds", metavar="N", type=float, help="end after this many seconds")


def run(options: argparse.Namespace) -> int:
    """A source onto the disk, until it ends."""
    from app.shell import record as recording

    if options.seconds is not None and not 0.0 < options.seconds < 1e9:
        raise InputError(f"--seconds {options.seconds:g}: expected more than 0")
    state = recording.record(
        options.source, options.record, options.seconds, lambda line: print(line, flush=True)
    )
    print(f"{state.name}: {state.seconds:.1f} s, {state.size_bytes / 1e6:.2f} MB")
    if state.trouble:
        raise InputError(f"{state.name}: {state.trouble}")
    return 0
