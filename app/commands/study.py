"""Shell: the papers' studies."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.commands.shared import Commands, add_json, answer, wrote
from app.commands.workers import add_workers, bar, jobs_of

#: Where the report goes if nobody says where.
USUAL_OUT = Path("studies")


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


def run(options: argparse.Namespace) -> int:
    """The papers' studies."""
    from app.shell import study

    outcome = study.study(
        study.names_of(options.name), jobs_of(options), options.cluster, bar, options.recording
    )
    out = options.out or (None if options.json else USUAL_OUT)
    files = study.write(outcome, out) if out else []
    return answer(options.json, study.summary(outcome), [*study.lines(outcome), *wrote(files)])
