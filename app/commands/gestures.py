"""Shell: what the feet ask for in a recording."""

from __future__ import annotations

import argparse
import json

from app.commands.shared import Commands, add_json


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
    if options.json:
        print(json.dumps(batch.gestures_summary(done)))
        return 0
    for line in batch.gestures_lines(done):
        print(line)
    return 0
