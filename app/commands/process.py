"""Shell: a recording without a browser."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from app.commands.shared import Commands, add_json, add_settings, settings_of


def add(commands: Commands) -> None:
    """Its options."""
    process = commands.add_parser("process", help="a recording without a browser")
    process.add_argument("recording", metavar="RECORDING")
    add_settings(process)
    process.add_argument("--out", metavar="DIR", type=Path, help="write trajectory and strides there")
    add_json(process)


def run(options: argparse.Namespace) -> int:
    """A recording without a browser."""
    from app import batch

    done = batch.process(options.recording, settings_of(options))
    files = batch.write(done, options.out) if options.out else []
    if options.json:
        print(json.dumps(batch.summary(done)))
        return 0
    for line in batch.lines(done):
        print(line)
    for path in files:
        print(f"wrote {path}")
    return 0
