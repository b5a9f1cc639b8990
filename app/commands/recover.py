"""Shell: a damaged recording's whole part, as a new file."""

from __future__ import annotations

import argparse

from app.commands.shared import Commands


def add(commands: Commands) -> None:
    """Its options."""
    mend = commands.add_parser(
        "recover", help="what is whole in a damaged recording, as a new file beside it"
    )
    mend.add_argument("file", metavar="FILE")


def run(options: argparse.Namespace) -> int:
    """A damaged recording's whole part."""
    from app.shell import library

    path, made = library.recover(options.file)
    print(f"wrote {path}: {made.samples} samples, {made.messages} messages in {made.chunks} whole chunks")
    return 0
