"""Shell: the town, walked with the feet."""

from __future__ import annotations

import argparse
import re

from app.commands.shared import Commands, add_door, door_options, tell
from app.motion.basics import InputError


def add(commands: Commands) -> None:
    """Its options."""
    town = commands.add_parser("mover", help="a town to walk through by marching in place")
    town.add_argument(
        "--source", metavar="SPEC", help="both feet (sim:gestures: simulated feet, steered by the arrow keys)"
    )
    town.add_argument("--left", metavar="SPEC", help="the left foot's sensor, with --right")
    town.add_argument("--right", metavar="SPEC", help="the right foot's sensor")
    town.add_argument("--decoder", choices=("default", "papers"), default="default")
    town.add_argument("--udp", metavar="HOST:PORT", help="send motion and speed there, as the papers did")
    town.add_argument(
        "--osc", metavar="HOST:PORT", help="send VRChat's input axes there (it listens on 9000)"
    )
    add_door(town)
    town.add_argument("--kiosk", action="store_true", help="no panel, no logo, the full window")
    town.add_argument(
        "--wall", metavar="3x1", help="a wall of browsers, columns x rows: prints their addresses"
    )


def run(options: argparse.Namespace) -> int:
    """The town, until Ctrl-C."""
    from app.shell import mover  # the heavy imports, after --help and --version

    mover.move(
        mover.Options(
            source=options.source,
            left=options.left,
            right=options.right,
            decoder=options.decoder,
            udp=options.udp,
            osc=options.osc,
            access=door_options(options),
            open_browser=not options.no_open,
            kiosk=options.kiosk,
            wall=wall_of(options.wall),
        ),
        tell,
    )
    return 0


def wall_of(text: str | None) -> tuple[int, int] | None:
    """``3x1`` as columns and rows."""
    if text is None:
        return None
    match = re.fullmatch(r"([1-9])x([1-9])", text)
    if match is None:
        raise InputError(f"--wall {text}: expected columns x rows, for example 3x1")
    return int(match[1]), int(match[2])
