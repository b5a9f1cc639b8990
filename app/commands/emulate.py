"""Shell: a recording or a simulation as a sensor on a pseudo-terminal."""

from __future__ import annotations

import argparse

from app.commands.shared import Commands
from app.formats.mounting import parse_axes
from app.formats.wire.catalogue import KINDS
from app.formats.wire.faults import FAULTS, parse_faults
from app.motion.basics import InputError

ABOUT = (
    "Be a sensor: serve a recording or a simulation on a new pseudo-terminal, in the sensor's own protocol, "
    "commands answered, paced as its line is. The first line printed is the path to open, the last (when the "
    "source or Ctrl-C ends it) what was sent, as JSON. It begins to measure when a host opens the path. "
    "Try: stridescope emulate gx1 --source 'sim:walk?loop=1', and in another terminal "
    "stridescope walk --source serial:PATH"
)


def add(commands: Commands) -> None:
    """Its options."""
    emulate = commands.add_parser("emulate", help="be a sensor on a pseudo-terminal")
    emulate.description = ABOUT
    emulate.add_argument("device", metavar="DEVICE", help=f"one of {', '.join(KINDS)}")
    emulate.add_argument(
        "--source", metavar="SPEC", required=True, help="what it measures: a recording or sim:walk?…"
    )
    emulate.add_argument(
        "--baud",
        type=int,
        help="speed of its line; a host at another reads rubbish, as it would (default: the sensor's usual "
        "one, and any host agrees). A gx1 at 115200 is one sped up to 333 Hz",
    )
    emulate.add_argument("--foot", choices=("left", "right", "foot"), help="which foot of a walk of two")
    emulate.add_argument("--axes", help="how it sits on the shoe, e.g. x,-y,-z (default: as is usual for it)")
    emulate.add_argument(
        "--fault", action="append", default=[], metavar="NAME=VALUE", help="; ".join(FAULTS.values())
    )
    emulate.add_argument("--seed", type=int, default=0, help="the same faults again (default 0)")


def run(options: argparse.Namespace) -> int:
    """Serve it until the source ends or Ctrl-C."""
    from app.shell.emulate import Wanted, emulate

    if options.device not in KINDS:
        raise InputError(f"emulate {options.device!r}: expected one of {', '.join(KINDS)}")
    if options.baud is not None and not 300 <= options.baud <= 4_000_000:
        raise InputError(f"--baud {options.baud}: expected 300 to 4000000")
    wanted = Wanted(
        options.device,
        options.source,
        options.baud,
        parse_axes(options.axes) if options.axes else None,
        options.foot,
        parse_faults(options.fault),
        options.seed,
    )
    emulate(wanted, lambda line: print(line, flush=True))
    return 0
