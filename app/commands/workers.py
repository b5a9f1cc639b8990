"""Shell: what the commands that share out work have in common: where it is done, and how far it is."""

from __future__ import annotations

import argparse
import sys

from app.motion.basics import InputError

_BAR = 30


def add_workers(command: argparse.ArgumentParser) -> None:
    """The options that say where the work is done."""
    command.add_argument("--jobs", metavar="N", type=int, help="processes to use (all cores)")
    command.add_argument("--cluster", metavar="ADDRESS", help="a running Dask scheduler to use instead")


def jobs_of(options: argparse.Namespace) -> int:
    """How many processes."""
    from app.workers import cores

    if options.jobs is None:
        return cores()
    if not 1 <= options.jobs <= 1024:
        raise InputError(f"--jobs {options.jobs}: expected 1 to 1024")
    return int(options.jobs)


def bar(done: int, of: int) -> None:
    """How far it is, on standard error: a bar for a person, nothing into a file."""
    if not sys.stderr.isatty():
        return
    filled = _BAR * done // of
    end = "\r\033[K" if done == of else ""
    print(f"\r[{'█' * filled}{'·' * (_BAR - filled)}] {done}/{of}{end}", end="", file=sys.stderr, flush=True)
