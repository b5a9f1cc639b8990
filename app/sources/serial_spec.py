"""Edge: SPEC of serial ports: ``serial:PORT?device=auto&baud=…``, and ``serial:LEFT,RIGHT?…`` for two feet.

With two ports an option is meant for both; ``left.axes=`` or ``right.device=`` is meant for one.
``columns=`` names those of a board whose lines have no header.
"""

from __future__ import annotations

from collections.abc import Mapping

from app.formats.mounting import parse_axes
from app.formats.options import FEET
from app.formats.wire.catalogue import KINDS
from app.formats.wire.lines import LinesDecoder
from app.motion.basics import InputError
from app.sources.serial_port import PortSpec, SerialPort
from app.sources.source import Source
from app.sources.spec import Spec
from app.sources.starting import Wish
from app.sources.together import Together

_KEYS = ("device", "baud", "foot", "axes", "rate", "columns")
_BAUDS = (300, 4_000_000)


def open_serial(spec: Spec) -> Source:
    """The live source of one port, or of two together; ``InputError`` names what is wrong."""
    specs = port_specs(spec)
    return SerialPort(specs[0]) if len(specs) == 1 else Together([SerialPort(each) for each in specs])


def port_specs(spec: Spec) -> list[PortSpec]:
    """What is said of each port."""
    paths = [path.strip() for path in spec.target.split(",")]
    if len(paths) > 2 or "" in paths or len(set(paths)) < len(paths):
        raise InputError(f"serial:{spec.target}: expected a port, or the left foot's and the right's")
    if len(paths) == 1:
        return [_port_spec(paths[0], spec.options)]
    if "foot" in spec.options:
        raise InputError(f"foot={spec.options['foot']!r}: of two ports the first is the left foot's")
    return [
        _port_spec(path, {**_options_of(spec.options, side), "foot": side})
        for path, side in zip(paths, ("left", "right"), strict=True)
    ]


def _options_of(options: Mapping[str, str], side: str) -> dict[str, str]:
    """What is said of both feet, and over it what is said of this one."""
    both = {key: value for key, value in options.items() if not key.startswith(("left.", "right."))}
    own = {key.partition(".")[2]: value for key, value in options.items() if key.startswith(f"{side}.")}
    return both | own


def _port_spec(path: str, options: Mapping[str, str]) -> PortSpec:
    for key in options:
        if key not in _KEYS:
            raise InputError(f"serial:{path}: unknown option {key!r}, expected one of {', '.join(_KEYS)}")
    foot = options.get("foot", "foot")
    if foot not in FEET:
        raise InputError(f"foot={foot!r}: expected one of {', '.join(FEET)}")
    device = _device(options.get("device", "auto"))
    return PortSpec(
        path,
        Wish(
            device,
            int(_number("baud", options["baud"], *_BAUDS)) if options.get("baud", "auto") != "auto" else None,
            _number("rate", options["rate"], 1.0, 4000.0) if "rate" in options else None,
        ),
        foot,
        parse_axes(options["axes"]) if "axes" in options else None,
        _columns(options["columns"], device) if "columns" in options else None,
    )


def _columns(text: str, device: str | None) -> str:
    if device != "csv":
        raise InputError(f"columns={text}: only a board that prints lines has columns: say device=csv too")
    LinesDecoder("foot", columns=text)
    return text


def _device(text: str) -> str | None:
    if text != "auto" and text not in KINDS:
        raise InputError(f"device={text!r}: expected auto or one of {', '.join(KINDS)}")
    return None if text == "auto" else text


def _number(key: str, text: str, least: float, most: float) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not least <= value <= most or (key == "baud" and value != int(value)):
        raise InputError(f"{key}={text!r}: expected {least:g} to {most:.7g}")
    return value
