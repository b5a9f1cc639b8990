"""Shell: what the feet ask for in a recording."""

from __future__ import annotations

import argparse

from app.commands.shared import Commands, add_json, answer


def add(commands: Commands) -> None:
    """Its options."""
    gestures = commands.add_parser("gestures", help="what the feet ask for in a recording, without a browser")
    gestures.add_argument("recording", metavar="RECORDING", help="of two feet; or sim:gestures?…")
    gestures.add_argument("--decoder", choices=("default", "papers"), default="default")
    add_json(gestures)


def run(options: argparse.Namespace) -> int:
    """What the feet ask for in a recording."""
    from app.shell import batch

    done = batch.decode_gestures(options.recording, options.decoder)
    return answer(options.json, batch.gestures_summary(done), batch.gestures_lines(done))
