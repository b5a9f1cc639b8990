"""Heart: `sim:pendulum`, a sensor that hangs on a rod: held still at an angle, then let go."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats, InputError, Role
from app.motion.recording import Recording
from app.motion.samples import Samples
from app.motion.source import Truth
from app.simulate.pendulum import Pendulum, Swinging, read, swing

SENSOR = "pendulum"
#: Held still before it is let go, so that level can be found.
HELD_S = 1.0


class Known(NamedTuple):
    """An option of the SPEC."""

    usual: float
    low: float
    high: float
    sentence: str


OPTIONS = {
    "start_deg": Known(30.0, -80.0, 80.0, "the angle it is let go from"),
    "length_m": Known(1.0, 0.1, 10.0, "the rod"),
    "damping": Known(0.05, 0.0, 10.0, "of a bob of 1 kg, N·s/m on 1 m"),
    "rate_hz": Known(100.0, 20.0, 1000.0, "samples a second"),
    "duration_s": Known(120.0, 2.0, 3600.0, "length of the recording"),
}


class HangingSensor(NamedTuple):
    """What it delivers, and what really happened. The truth's origin is the pivot."""

    recording: Recording
    truth: Truth


def make_pendulum(texts: Mapping[str, str]) -> HangingSensor:
    """The pendulum a SPEC's query asks for; ``InputError`` says what is wrong with it."""
    unknown = sorted(set(texts) - set(OPTIONS))
    if unknown:
        raise InputError(f"sim:pendulum: unknown option {unknown[0]!r}: expected one of {', '.join(OPTIONS)}")
    values = {key: _read(key, texts.get(key), known) for key, known in OPTIONS.items()}
    pendulum = Pendulum(values["length_m"], damping=values["damping"], start_deg=values["start_deg"])
    swings = swing(pendulum, values["duration_s"])

    def motion(t_s: Floats) -> Swinging:
        free = t_s >= HELD_S
        moved = swings(np.maximum(t_s - HELD_S, 0.0))
        return Swinging(moved.angle, np.where(free, moved.rate, 0.0), np.where(free, moved.acceleration, 0.0))

    def truth(sensor: str, t_s: Floats) -> tuple[Floats, Floats]:
        angle = motion(t_s).angle
        nothing = np.zeros_like(angle)
        position_n = pendulum.length_m * np.stack([np.sin(angle), nothing, np.cos(angle)], axis=1)
        return position_n, np.stack([np.cos(angle / 2), nothing, np.sin(angle / 2), nothing], axis=1)

    t_s = np.arange(int(values["duration_s"] * values["rate_hz"])) / values["rate_hz"]
    matrix = read(pendulum, motion, t_s)
    samples = Samples(SENSOR, Role.OTHER, 0, matrix, np.zeros(len(matrix), np.uint16))
    spec = "sim:pendulum?" + "&".join(f"{key}={value:g}" for key, value in values.items())
    recording = Recording("sim:pendulum", "simulator", (samples,), spec=spec, rod_m=pendulum.length_m)
    return HangingSensor(recording, truth)


def _read(key: str, text: str | None, known: Known) -> float:
    if text is None:
        return known.usual
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not known.low <= value <= known.high:
        raise InputError(
            f"sim:pendulum: {key}={text!r}: expected {known.low:g} to {known.high:g} ({known.sentence})"
        )
    return value
