"""Edge: SPEC, where samples come from: ``PATH``, ``replay:PATH?speed=2``, ``sim:walk``, ``serial:PORT``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from urllib.parse import unquote

from app.formats.options import KEYS
from app.motion.basics import InputError

LIVE = ("serial", "ws", "udp", "phone", "lsl")
KINDS = ("replay", "sim", *LIVE)
SLOWEST, FASTEST = 0.1, 8.0

_PACE = ("speed", "loop", "changes")
_EXPECTED = {"replay": "path", "sim": "simulator", "serial": "port", "ws": "port", "udp": "port"}
_TRUE = {
    "1": True,
    "true": True,
    "on": True,
    "yes": True,
    "0": False,
    "false": False,
    "off": False,
    "no": False,
}


@dataclass(frozen=True)
class Spec:
    """A parsed SPEC: ``kind``, and ``target``: the path, the simulator's name or the port.

    ``options`` are what the file does not say, or the simulator's or the link's own.
    """

    kind: str
    target: str
    options: Mapping[str, str] = field(default_factory=dict)
    speed: float = 1.0
    loop: bool = False
    changes: bool = True  # repeat the changes that a recording of ours holds


def parse_spec(text: str) -> Spec:
    """The SPEC as typed; ``InputError`` names what is wrong: form, option or number."""
    kind, rest = _kind(text)
    target, _, query = rest.partition("?")
    if not target and kind not in ("phone", "lsl"):
        raise InputError(f"{text!r}: no {_EXPECTED[kind]}, expected e.g. sim:walk")
    options = _options(text, query)
    if kind in LIVE:
        return Spec(kind, unquote(target), options)
    pace = {key: options.pop(key) for key in _PACE if key in options}
    if kind == "replay":
        _check_keys(text, options)
    return Spec(
        kind,
        unquote(target) if kind == "sim" else target,
        options,
        speed=parse_speed(pace.get("speed", "1")),
        loop=_switch("loop", pace.get("loop", "0")),
        changes=_switch("changes", pace.get("changes", "1")),
    )


def parse_speed(text: str) -> float:
    """A pace as typed: 0.1 to 8 times the recorded one, or 0 for as fast as possible."""
    try:
        speed = float(text)
    except ValueError:
        speed = math.nan
    if speed != 0.0 and not SLOWEST <= speed <= FASTEST:
        raise InputError(f"speed={text!r}: expected {SLOWEST:g} to {FASTEST:g}, or 0 for as fast as possible")
    return speed


def _kind(text: str) -> tuple[str, str]:
    """The kind before the first colon, if it is one; anything else is a path."""
    kind, colon, rest = text.partition(":")
    return (kind, rest) if colon and kind in KINDS else ("replay", text)


def _options(text: str, query: str) -> dict[str, str]:
    options: dict[str, str] = {}
    for part in query.split("&") if query else ():
        key, equals, value = part.partition("=")
        if not key or not equals:
            raise InputError(f"{text!r}: option {part!r}, expected key=value")
        if key in options:
            raise InputError(f"{text!r}: option {key!r} is given twice, expected once")
        options[key] = unquote(value)
    return options


def _check_keys(text: str, options: Mapping[str, str]) -> None:
    for key in options:
        if key not in KEYS:
            raise InputError(
                f"{text!r}: unknown option {key!r}, expected one of {', '.join((*_PACE, *KEYS))}"
            )


def _switch(key: str, text: str) -> bool:
    if text.lower() not in _TRUE:
        raise InputError(f"{key}={text!r}: expected 1 or 0")
    return _TRUE[text.lower()]
