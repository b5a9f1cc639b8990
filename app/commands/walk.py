"""Shell: the live page."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.commands.shared import (
    DEFAULT_PROFILE,
    Commands,
    add_door,
    add_settings,
    door_options,
    settings_of,
    tell,
)
from app.motion.basics import InputError

DEMO = Path(__file__).parent.parent.parent / "recordings" / "demo.csv"


def add(commands: Commands) -> None:
    """Its options."""
    walk = commands.add_parser("walk", help="the live page (this is the default)")
    walk.add_argument("--source", metavar="SPEC", default=None, help="a recording, replay:… or sim:walk?…")
    add_settings(walk)
    add_door(walk)
    walk.add_argument(
        "--memory-mb", type=int, default=512, help="budget for samples; beyond it the oldest go"
    )
    walk.add_argument(
        "--record", metavar="DIR", type=Path, help="record from the beginning, into this folder"
    )
    walk.add_argument("--gpx", metavar="FILE", type=Path, help="a GPS track to show beside the walk")
    walk.add_argument(
        "--declination", metavar="DEG", type=float, default=0.0, help="magnetic north east of true north"
    )


def run(options: argparse.Namespace) -> int:
    """The live page, until Ctrl-C."""
    from app.shell import run as viewer  # the heavy imports, after --help and --version
    from app.shell.shelf import track

    if options.memory_mb < 16:
        raise InputError(f"--memory-mb {options.memory_mb}: expected 16 or more")
    if not abs(options.declination) <= 180.0:
        raise InputError(f"--declination {options.declination:g}: expected degrees east, −180 to 180")
    viewer.walk(
        viewer.Options(
            source=options.source if options.source is not None else str(DEMO),
            settings=settings_of(options),
            access=door_options(options),
            open_browser=not options.no_open,
            budget_bytes=options.memory_mb * 2**20,
            told=options.profile is not None or bool(options.set),
            profile=Path(options.profile or DEFAULT_PROFILE).stem,
            record=options.record,
            reference=track(options.gpx, options.declination) if options.gpx else None,
            declination_deg=options.declination,
        ),
        tell,
    )
    return 0
