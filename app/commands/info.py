"""Shell: what is in a recording."""

from __future__ import annotations

import argparse
import json

from app.commands.shared import Commands, add_json


def add(commands: Commands) -> None:
    """Its options."""
    tell = commands.add_parser("info", help="what is in a recording")
    tell.add_argument("file", metavar="FILE")
    add_json(tell)


def run(options: argparse.Namespace) -> int:
    """What is in a recording."""
    from app.shell import library

    told = library.info(options.file)
    for line in [json.dumps(told)] if options.json else library.lines(told):
        print(line)
    return 0
