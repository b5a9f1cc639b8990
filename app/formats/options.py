"""Heart: what a person says of a recording that the file does not: rate, axes, foot, device."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from app.formats.mounting import Axes, parse_axes
from app.formats.saturation import RANGES
from app.motion.basics import InputError

FEET = ("left", "right", "foot")
KEYS = ("rate", "axes", "foot", "device")


@dataclass(frozen=True)
class Options:
    """``rate_hz`` replaces the file's times, ``axes`` the mounting found from gravity.

    ``foot`` picks one foot of two, or names a single one. ``device`` tells the sensor's ranges.
    """

    rate_hz: float | None = None
    axes: Axes | None = None
    foot: str | None = None
    device: str | None = None


def parse_options(texts: Mapping[str, str]) -> Options:
    """Options as typed: ``rate``, ``axes``, ``foot``, ``device``; ``InputError`` on any other."""
    for key in texts:
        if key not in KEYS:
            raise InputError(f"option {key!r}: expected one of {', '.join(KEYS)}")
    return Options(
        rate_hz=_rate(texts["rate"]) if "rate" in texts else None,
        axes=parse_axes(texts["axes"]) if "axes" in texts else None,
        foot=_one_of("foot", texts["foot"], FEET) if "foot" in texts else None,
        device=_device(texts["device"]) if "device" in texts else None,
    )


def _rate(text: str) -> float:
    try:
        rate_hz = float(text)
    except ValueError:
        rate_hz = math.nan
    if not 1.0 <= rate_hz <= 100_000.0:
        raise InputError(f"rate={text!r}: expected samples a second, 1 to 100000")
    return rate_hz


def _one_of(key: str, text: str, choices: tuple[str, ...]) -> str:
    if text not in choices:
        raise InputError(f"{key}={text!r}: expected one of {', '.join(choices)}")
    return text


def _device(text: str) -> str | None:
    return None if text == "auto" else _one_of("device", text, ("auto", *RANGES))
