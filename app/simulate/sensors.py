"""Heart: what sensors on a simulated foot read: the ideal, then bias, noise, clipping and loss.

The numbers are those of the 3DM-GX1 in Table II of the 2012 paper; "0.1 % of full scale" is of the
span, ±5 g or ±1.2 gauss.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import G_MPS2, Floats, Vector, role_of
from app.motion.samples import Samples
from app.simulate.foot import Motion, rotate_to_body
from app.simulate.options import WalkOptions

MICROTESLA_PER_GAUSS = 100.0
#: The field of dissertation eq. 4.12 and III-G: 0.486 gauss, dipping 60.483°.
FIELD_UT, DIP_RAD = 48.6, math.radians(60.483)
FIELD_N_UT: Vector = (FIELD_UT * math.cos(DIP_RAD), 0.0, FIELD_UT * math.sin(DIP_RAD))
#: Table II: noise σ and bias μ of accelerometer m/s², gyro rad/s and magnetometer µT.
TABLE_II_NOISE = (0.033, 0.0076, 0.082)
TABLE_II_BIAS = (0.0981, 7.25e-6, 0.24)


class Iron(NamedTuple):
    """A small magnet on the ground, its north pole to the east; ``strength`` is in µT m³."""

    position_n: Floats  # [3] m, from the foot's own start
    strength: float


@dataclass(frozen=True)
class SensorErrors:
    """One sensor's errors for force, rate and field, in SI and µT; a range of infinity clips nothing."""

    noise: tuple[float, float, float]
    bias: tuple[Vector, Vector, Vector]
    full_scale: tuple[float, float, float]
    decimals: int | None  # of m/s², rad/s and gauss; None: not rounded
    lost_fraction: float


def errors_of(options: WalkOptions) -> SensorErrors:
    """The options' errors; a sensor's own value goes before the multiple of Table II."""
    o, gauss = options, MICROTESLA_PER_GAUSS
    noise = (o.accelerometer_noise_mps2, o.gyro_noise_radps, _times(o.magnetometer_noise_gauss, gauss))
    field_bias = o.magnetometer_bias_gauss
    bias = (
        o.accelerometer_bias_mps2,
        o.gyro_bias_radps,
        None if field_bias is None else (field_bias[0] * gauss, field_bias[1] * gauss, field_bias[2] * gauss),
    )
    ranges = (
        _times(o.accelerometer_range_g, G_MPS2),
        _times(o.gyro_range_dps, math.radians(1.0)),
        _times(o.magnetometer_range_gauss, gauss),
    )
    force, rate, field = (
        (o.bias * usual,) * 3 if own is None else own for own, usual in zip(bias, TABLE_II_BIAS, strict=True)
    )
    return SensorErrors(
        _or_else(noise, tuple(o.noise * usual for usual in TABLE_II_NOISE)),
        (force, rate, field),
        _or_else(ranges, (math.inf,) * 3),
        o.decimals,
        o.lost_fraction,
    )


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor


def _or_else(
    own: tuple[float | None, float | None, float | None], usual: tuple[float, ...]
) -> tuple[float, float, float]:
    a, b, c = (u if o is None else o for o, u in zip(own, usual, strict=True))
    return a, b, c


def ideal_readings(motion: Motion, gravity_mps2: float, iron: Iron | None) -> Floats:
    """Specific force, angular rate and field, [n, 9] in body axes: f = Rᵀ(a − g) (eq. 17)."""
    gravity_n = np.array([0.0, 0.0, gravity_mps2])
    field_n = np.array(FIELD_N_UT) + (0.0 if iron is None else field_of(iron, motion.position_n))
    force_b = rotate_to_body(motion.q_nb, motion.acceleration_n - gravity_n)
    return np.hstack([force_b, motion.angular_rate_b, rotate_to_body(motion.q_nb, field_n)])


def field_of(iron: Iron, position_n: Floats) -> Floats:
    """The magnet's field [n, 3] µT: a dipole's, k (3 (m·r̂) r̂ − m) / r³; within 5 cm it stays as at 5 cm."""
    away = position_n - iron.position_n
    distance = np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 0.05)
    moment = np.array([0.0, 1.0, 0.0])
    along = away @ moment / distance[:, 0] ** 2
    field: Floats = iron.strength * (3.0 * along[:, np.newaxis] * away - moment) / distance**3
    return field


def read(sensor: str, elapsed_ns: Floats, ideal: Floats, errors: SensorErrors, seed: int) -> Samples:
    """What the sensor delivers: the ideal readings [n, 9] with its errors, the lost samples gone.

    Every sensor and every kind of error draws from its own stream, so that one more error leaves
    the others as they were. The first sample always arrives: times are counted from it.
    """
    *streams, loss = np.random.SeedSequence([seed, *sensor.encode()]).spawn(4)
    noise = [np.random.default_rng(s).standard_normal((len(ideal), 3)) for s in streams]
    full_scale = np.repeat(errors.full_scale, 3)
    raw = ideal + np.ravel(errors.bias) + np.hstack(noise) * np.repeat(errors.noise, 3)
    kept = np.random.default_rng(loss).random(len(ideal)) >= errors.lost_fraction
    kept[:1] = True
    readings = rounded(np.clip(raw, -full_scale, full_scale), errors.decimals)
    matrix = np.column_stack([elapsed_ns, readings])[kept]
    return Samples(sensor, role_of(sensor), 0, matrix, saturation_bits(raw, full_scale)[kept])


def rounded(readings: Floats, decimals: int | None) -> Floats:
    """Readings [n, 9] with so many decimals in m/s², rad/s and gauss, which is µT / 100."""
    if decimals is None:
        return readings
    return np.hstack([readings[:, :6].round(decimals), readings[:, 6:].round(decimals - 2)])


def saturation_bits(raw: Floats, full_scale: Floats) -> NDArray[np.uint16]:
    """Bit i of each row [n] is set where channel i of 9 is at or past its range (see ``Sample``)."""
    bits: NDArray[np.uint16] = ((np.abs(raw) >= full_scale) @ (1 << np.arange(9))).astype(np.uint16)
    return bits
