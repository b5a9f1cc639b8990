"""Heart: the foot at rest: where gravity is, and whether the units can be what the file claims."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.formats.units import FORCE
from app.motion.basics import G_MPS2, Floats, InputError
from app.motion.samples import Samples

_WINDOW_S = 0.1  # even a shuffling patient stands this long
_EARLY_S = 60.0
_STILL = 0.1  # spread of the force over its mean: above, the foot never rested
_REST_MPS2 = (8.5, 11.2)
_TOLERANCE = 0.15
_FASTEST_RADPS = 60.0  # no foot and hardly a sensor turns faster; deg/s in a rad/s column do
_FASTEST_SHARE = 0.005


@dataclass(frozen=True)
class Rest:
    """The stillest short window of the first minute: mean force [3] m/s², and whether it is still at all."""

    force: Floats
    still: bool

    @property
    def magnitude_mps2(self) -> float:
        """|f| at rest."""
        return float(np.linalg.norm(self.force))


def find_rest(samples: Samples) -> Rest:
    """The window with the least spread of force and the least rate, each in units of its own mean."""
    early = samples.matrix[samples.matrix[:, 0] <= _EARLY_S * 1e9]
    force, rate = early[:, 1:4], early[:, 4:7]
    rows = min(max(int(_WINDOW_S * samples.rate_hz), 2), len(early))
    mean = _moving_mean(force, rows)
    centred = force - force.mean(axis=0)
    spread = _moving_mean(centred**2, rows).sum(axis=1) - (_moving_mean(centred, rows) ** 2).sum(axis=1)
    spread = np.maximum(spread, 0.0)
    turning = _moving_mean(rate**2, rows).sum(axis=1)
    score = spread / _or_one(float((force**2).sum(axis=1).mean())) + turning / _or_one(float(turning.mean()))
    best = int(np.argmin(score))
    magnitude = float(np.linalg.norm(mean[best]))
    return Rest(mean[best], bool(np.sqrt(spread[best]) <= _STILL * magnitude))


def _or_one(scale: float) -> float:
    return scale if scale > 0.0 else 1.0


def _moving_mean(values: Floats, rows: int) -> Floats:
    total = np.cumsum(np.vstack([np.zeros((1, values.shape[1])), values]), axis=0)
    mean: Floats = (total[rows:] - total[:-rows]) / rows
    return mean


def check_units(name: str, samples: Samples, rest: Rest, force_unit: str) -> None:
    """Raise ``InputError`` when rest or turning contradicts the units the file claims."""
    if rest.still and not _REST_MPS2[0] <= rest.magnitude_mps2 <= _REST_MPS2[1]:
        raise InputError(f"{name}: {_rest_sentence(samples.sensor, rest.magnitude_mps2, force_unit)}")
    speed = np.linalg.norm(samples.matrix[:, 4:7], axis=1)
    if np.mean(speed > _FASTEST_RADPS) > _FASTEST_SHARE:
        raise InputError(
            f"{name}: the gyroscope of {samples.sensor} reads {speed.max():.0f} rad/s: this looks like deg/s,"
            " expected at most 35 rad/s; correct the unit"
        )


def _rest_sentence(sensor: str, rest_mps2: float, unit: str) -> str:
    scale = FORCE[unit]
    value = rest_mps2 / scale
    in_g = f" ({rest_mps2 / G_MPS2:.2g} g)" if unit != "g" else ""
    seen = f"the accelerometer of {sensor} rests at {value:.2f}{in_g}"
    expected = f"expected {G_MPS2 / scale:.4g} {unit}"
    for looks, other in (("g", 1.0), ("m/s²", G_MPS2), ("mg", 1000.0)):
        if abs(value / other - 1.0) <= _TOLERANCE and looks != unit:
            return f"{seen}: this looks like {looks}, {expected}; correct the unit"
    return f"{seen} {unit}: {expected}; check the sensor's scale and the unit"
