"""Heart: the covariance of the Kalman filter's errors: how it grows, and one scalar measurement.

The errors (true = exp(δθ) ⊗ q, v + δv, p + δp, b + δb) obey, with f the specific force in *n*:
δp′ = δv, δv′ = δθ × f − R δb_f, δθ′ = −R δb_ω (J. Farrell, *Aided Navigation*, 2008, ch. 11, in *n*).
Two parts more stand still: the floor's height, and the direction of magnetic north.
"""

from __future__ import annotations

from app.compiled import part
from app.estimator.kalman_state import PARTS
from app.motion.basics import Floats, Quaternion, Vector
from app.rotation import rotate


@part
def propagate(P: Floats, q_nb: Quaternion, force_n: Vector, dt_s: float) -> None:
    """P ← F P Fᵀ over ``dt_s``: first the rows, then, as P is symmetric, the columns."""
    x, y, z = (
        rotate(q_nb, (dt_s, 0.0, 0.0)),
        rotate(q_nb, (0.0, dt_s, 0.0)),
        rotate(q_nb, (0.0, 0.0, dt_s)),
    )
    fx, fy, fz = force_n[0] * dt_s, force_n[1] * dt_s, force_n[2] * dt_s
    for j in range(PARTS):
        for k in range(3):
            P[k, j] += dt_s * P[3 + k, j]
        P[3, j] += P[7, j] * fz - P[8, j] * fy
        P[4, j] += P[8, j] * fx - P[6, j] * fz
        P[5, j] += P[6, j] * fy - P[7, j] * fx
        for k in range(3):
            P[3 + k, j] -= x[k] * P[12, j] + y[k] * P[13, j] + z[k] * P[14, j]
            P[6 + k, j] -= x[k] * P[9, j] + y[k] * P[10, j] + z[k] * P[11, j]
    for j in range(PARTS):
        for k in range(3):
            P[j, k] += dt_s * P[j, 3 + k]
        P[j, 3] += P[j, 7] * fz - P[j, 8] * fy
        P[j, 4] += P[j, 8] * fx - P[j, 6] * fz
        P[j, 5] += P[j, 6] * fy - P[j, 7] * fx
        for k in range(3):
            P[j, 3 + k] -= x[k] * P[j, 12] + y[k] * P[j, 13] + z[k] * P[j, 14]
            P[j, 6 + k] -= x[k] * P[j, 9] + y[k] * P[j, 10] + z[k] * P[j, 11]


@part
def add_variance(P: Floats, first: int, variance: float) -> None:
    """Noise on three parts of the error state, the same on each."""
    for k in range(3):
        P[first + k, first + k] += variance


@part
def add_variance_along(P: Floats, first: int, axis_n: Vector, variance: float) -> None:
    """Noise on three parts of the error state, along one axis only (or about it)."""
    for i in range(3):
        for j in range(3):
            P[first + i, first + j] += variance * axis_n[i] * axis_n[j]


@part
def measure(
    P: Floats, shift: Floats, gain: Floats, part: int, less: int, away: float, variance: float
) -> tuple[float, float]:
    """One scalar measurement: by how much one part of the error state differs from another (``less``; −1:
    from nothing), is ``away``.

    ``shift`` [17] is what this update has found so far; ``gain`` [17] becomes the column of P it saw.
    Returns the total variance, and how far the measurement was away from what was found so far.
    One rank at a time P stays symmetric, and exactly so.
    """
    left = away - shift[part]
    for i in range(PARTS):
        gain[i] = P[i, part]
    if less >= 0:
        left += shift[less]
        for i in range(PARTS):
            gain[i] -= P[i, less]
    total = variance + gain[part] - (gain[less] if less >= 0 else 0.0)
    for i in range(PARTS):
        shift[i] += gain[i] / total * left
        for j in range(i + 1):
            P[i, j] -= gain[i] * gain[j] / total
            P[j, i] = P[i, j]
    return total, left


@part
def copy_part(P: Floats, part: int, into: int) -> None:
    """The error ``into`` is from here on what the error ``part`` is now."""
    for j in range(PARTS):
        P[into, j] = P[part, j]
    for i in range(PARTS):
        P[i, into] = P[i, part]
