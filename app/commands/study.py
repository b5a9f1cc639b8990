"""Shell: the papers' studies."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from app.commands.shared import Commands, add_json
from app.motion import InputError

#: Where the report goes if nobody says where.
USUAL_OUT = Path("studies")
_BAR = 30


def add(commands: Commands) -> None:
    """Its options."""
    study = commands.add_parser("study", help="the papers' tables and figures, made again beside the printed")
    study.add_argument("name", metavar="NAME|all")
    study.add_argument(
        "--out", metavar="DIR", type=Path, help="write report.html and rows.json there (./studies)"
    )
    study.add_argument(
        "--recording",
        metavar="SPEC",
        action="append",
        default=[],
        help="a walk that ends where it began, for the study of gains",
    )
    add_json(study)
    add_workers(study)


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


def run(options: argparse.Namespace) -> int:
    """The papers' studies."""
    from app import study

    outcome = study.study(
        study.names_of(options.name), jobs_of(options), options.cluster, bar, options.recording
    )
    out = options.out or (None if options.json else USUAL_OUT)
    files = study.write(outcome, out) if out else []
    if options.json:
        print(json.dumps(study.summary(outcome)))
        return 0
    for line in study.lines(outcome):
        print(line)
    for path in files:
        print(f"wrote {path}")
    return 0


def bar(done: int, of: int) -> None:
    """How far it is, on standard error: a bar for a person, nothing into a file."""
    if not sys.stderr.isatty():
        return
    filled = _BAR * done // of
    end = "\r\033[K" if done == of else ""
    print(f"\r[{'█' * filled}{'·' * (_BAR - filled)}] {done}/{of}{end}", end="", file=sys.stderr, flush=True)
