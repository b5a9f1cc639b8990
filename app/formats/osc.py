"""Heart, formats: Open Sound Control 1.0 messages with float arguments, and VRChat's three input axes."""

from __future__ import annotations

import math
import struct

#: VRChat listens here for a game's inputs; each axis is −1 to 1 and keeps its last value.
FORWARD, RIGHT, TURN = "/input/Vertical", "/input/Horizontal", "/input/LookHorizontal"


def message(address: str, *values: float) -> bytes:
    """One message; ``ValueError`` for an address that is none or a value that is no number."""
    if not address.startswith("/") or not address.isascii() or not address.isprintable() or " " in address:
        raise ValueError(f"{address!r} is no OSC address")
    if not all(map(math.isfinite, values)):
        raise ValueError(f"{address}: a value is not finite")
    return _text(address) + _text("," + "f" * len(values)) + struct.pack(f">{len(values)}f", *values)


def axes(ahead: float, right: float, turn: float) -> dict[str, float]:
    """The three axes by address, each held to −1…1; what is no number is 0."""
    return {FORWARD: _axis(ahead), RIGHT: _axis(right), TURN: _axis(turn)}


def _axis(value: float) -> float:
    return round(min(max(value, -1.0), 1.0), 3) if math.isfinite(value) else 0.0


def _text(text: str) -> bytes:
    """ASCII with a zero, filled up to a multiple of four."""
    data = text.encode("ascii") + b"\0"
    return data + b"\0" * (-len(data) % 4)
