"""Heart: orientation: the factored quaternion algorithm and the complementary filter.

Equation numbers (3.x) are the dissertation's (Calusdian 2010), plain ones the 2012 paper's.
"""

from __future__ import annotations

import math

from app.compiled import part
from app.motion.basics import Quaternion, Vector
from app.rotation import conjugate, exponential, multiply, normalise, rotate

#: Below this cosine of the pitch roll is undefined; the toe points straight up or down.
VERTICAL = 1e-9


@part
def half_angle(sine: float, cosine: float) -> tuple[float, float]:
    """(cos, sin) of half an angle from the whole one's: (3.18), (3.21).

    sgn(0) is +1, or the roll quaternion would vanish at 180°; cosines are clamped to [−1, 1].
    """
    cosine = min(1.0, max(-1.0, cosine))
    half_sine = math.sqrt((1.0 - cosine) / 2.0)
    return math.sqrt((1.0 + cosine) / 2.0), (half_sine if sine >= 0.0 else -half_sine)


@part
def fqa_tilt(force_b: Vector) -> Quaternion:
    """Pitch ⊗ roll from the specific force at rest, (3.17)–(3.22). Zero force gives the identity."""
    norm = math.sqrt(force_b[0] ** 2 + force_b[1] ** 2 + force_b[2] ** 2)
    if norm == 0.0:
        return (1.0, 0.0, 0.0, 0.0)
    sin_pitch = min(1.0, max(-1.0, force_b[0] / norm))
    cos_pitch = math.sqrt(1.0 - sin_pitch * sin_pitch)
    c, s = half_angle(sin_pitch, cos_pitch)
    pitch = (c, 0.0, s, 0.0)
    if cos_pitch < VERTICAL:
        return pitch  # roll and yaw turn about the same axis here: roll is defined as 0
    c, s = half_angle(-force_b[1] / norm / cos_pitch, -force_b[2] / norm / cos_pitch)
    return multiply(pitch, (c, s, 0.0, 0.0))


@part
def fqa_yaw(tilt: Quaternion, field_b: Vector, north_rad: float) -> Quaternion:
    """Yaw from the magnetic field, (3.23)–(3.25), north lying at ``north_rad`` in *n*.

    The zero quaternion where there is no field or it has no horizontal part.
    """
    m = rotate(tilt, field_b)
    horizontal = math.sqrt(m[0] * m[0] + m[1] * m[1])
    if not horizontal > 0.0:  # also where the field is NaN: no magnetometer
        return (0.0, 0.0, 0.0, 0.0)
    mx, my = m[0] / horizontal, m[1] / horizontal
    nx, ny = math.cos(north_rad), math.sin(north_rad)
    c, s = half_angle(-my * nx + mx * ny, mx * nx + my * ny)
    return (c, 0.0, 0.0, s)


@part
def own_yaw(tilt: Quaternion, q_nb: Quaternion) -> Quaternion:
    """The yaw that brings ``tilt`` nearest to the estimate: the twist about down of q ⊗ tilt*.

    Without a magnetometer the static quaternion takes the estimate's own heading, so that gravity
    corrects roll and pitch and turns nothing about the vertical.
    """
    r = multiply(q_nb, conjugate(tilt))
    norm = math.sqrt(r[0] * r[0] + r[3] * r[3])
    if norm == 0.0:
        return (1.0, 0.0, 0.0, 0.0)
    return (r[0] / norm, 0.0, 0.0, r[3] / norm)


@part
def static_quaternion(tilt: Quaternion, yaw: Quaternion, q_nb: Quaternion) -> Quaternion:
    """±q_s of the FQA: yaw ⊗ pitch ⊗ roll with the sign nearer the estimate.

    A ``yaw`` of zero norm (no usable field) stands for the estimate's own.
    """
    if yaw[0] == 0.0 and yaw[3] == 0.0:
        yaw = own_yaw(tilt, q_nb)
    q = multiply(yaw, tilt)
    if q[0] * q_nb[0] + q[1] * q_nb[1] + q[2] * q_nb[2] + q[3] * q_nb[3] < 0.0:
        return (-q[0], -q[1], -q[2], -q[3])
    return q


@part
def turn_between(rate_before_b: Vector, rate_b: Vector, dt_s: float) -> Quaternion:
    """The turn from one sample to the next: the mean of both rates, held, integrated exactly.

    Which of the two rates to use the papers do not say; on their foot model, whose rate jumps, the
    choice moves the height by metres, on real feet the mean is best.
    """
    half = 0.5 * dt_s
    return exponential(
        (
            (rate_before_b[0] + rate_b[0]) * half,
            (rate_before_b[1] + rate_b[1]) * half,
            (rate_before_b[2] + rate_b[2]) * half,
        )
    )


@part
def share_of(gain: float, dt_s: float) -> float:
    """How much of the error a gain removes in ``dt_s``: 1 − e^(−k·dt), exact and stable for any gain."""
    return 1.0 - math.exp(-gain * dt_s)


@part
def complementary(
    q_nb: Quaternion, turn: Quaternion, tilt: Quaternion, yaw: Quaternion, share: float
) -> Quaternion:
    """q̇ = ½ q ⊗ ω + k (±q_s − q̂), (2) and (3.26), over one sample; then normalised.

    ``turn`` integrates the first term, ``share`` = 1 − e^(−k·dt) the second.
    """
    q = multiply(q_nb, turn)
    if share > 0.0:
        q_s = static_quaternion(tilt, yaw, q)
        q = (
            q[0] + share * (q_s[0] - q[0]),
            q[1] + share * (q_s[1] - q[1]),
            q[2] + share * (q_s[2] - q[2]),
            q[3] + share * (q_s[3] - q[3]),
        )
    return normalise(q)
