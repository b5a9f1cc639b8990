"""Shell: what is in a recording."""

from __future__ import annotations

import argparse

from app.commands.shared import Commands, add_json, answer


def add(commands: Commands) -> None:
    """Its options."""
    tell = commands.add_parser("info", help="what is in a recording")
    tell.add_argument("file", metavar="FILE")
    add_json(tell)


def run(options: argparse.Namespace) -> int:
    """What is in a recording."""
    from app.shell import library

    told = library.info(options.file)
    return answer(options.json, told, library.lines(told))
