"""Shell: the serial ports there are, with what answers on each."""

from __future__ import annotations

import argparse
import asyncio
import json

from app.commands.shared import Commands, add_json


def add(commands: Commands) -> None:
    """Its options."""
    devices = commands.add_parser("devices", help="the serial ports, with what answers on each")
    devices.description = (
        "Listen on every serial port at the usual speeds, then ask, as harmlessly as can be, what is there. "
        "Ports that another program has open are named and left alone."
    )
    devices.add_argument("ports", metavar="PORT", nargs="*", help="only these (default: all there are)")
    devices.add_argument("--listen", action="store_true", help="only listen, send nothing")
    add_json(devices)


def run(options: argparse.Namespace) -> int:
    """Print a line for each port."""
    from app.sources.devices import look

    found = asyncio.run(look(options.ports, not options.listen))
    if options.json:
        print(json.dumps({"devices": [{**vars(device), "spec": device.spec} for device in found]}))
        return 0
    if not found:
        print("No serial port: plug a sensor in, or try one without hardware: stridescope emulate --help")
    for device in found:
        print(f"{device.port}  {device.words}" + (f"  [{device.hardware}]" if device.hardware else ""))
        if device.spec is not None:
            print(f"    --source '{device.spec}'")
    return 0
