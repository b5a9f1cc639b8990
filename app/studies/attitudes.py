"""Heart: four ways to an attitude from readings: TRIAD, QUEST, FQA, and the Gauss–Newton filter of 2001.

Each takes a table of samples [n, 10] to orientations q_nb [n, 4]. Equations (3.x) are the dissertation's,
plain ones the 2001 report's (Bachmann et al.).
"""

from __future__ import annotations

import math

import numpy as np

from app.compiled import kernel
from app.estimator.attitude import fqa_tilt, fqa_yaw
from app.motion.basics import Floats, Quaternion, Vector
from app.rotation import conjugate, multiply, normalise, rotate

#: Gravity's reading in n: an accelerometer at rest points up.
UP: Vector = (0.0, 0.0, -1.0)


@kernel
def cross(a: Vector, b: Vector) -> Vector:
    """a × b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@kernel
def unit(a: Vector) -> Vector:
    """a / |a|; zero stays zero."""
    norm = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    if norm == 0.0:
        return (0.0, 0.0, 0.0)
    return (a[0] / norm, a[1] / norm, a[2] / norm)


@kernel
def quaternion_of(c: Floats) -> Quaternion:
    """The quaternion of a rotation matrix [3, 3], by its largest component."""
    trace = c[0, 0] + c[1, 1] + c[2, 2]
    squares = (1.0 + trace, 1.0 + 2 * c[0, 0] - trace, 1.0 + 2 * c[1, 1] - trace, 1.0 + 2 * c[2, 2] - trace)
    if squares[0] >= max(squares[1], squares[2], squares[3]):
        q = (squares[0], c[2, 1] - c[1, 2], c[0, 2] - c[2, 0], c[1, 0] - c[0, 1])
    elif squares[1] >= max(squares[2], squares[3]):
        q = (c[2, 1] - c[1, 2], squares[1], c[0, 1] + c[1, 0], c[0, 2] + c[2, 0])
    elif squares[2] >= squares[3]:
        q = (c[0, 2] - c[2, 0], c[0, 1] + c[1, 0], squares[2], c[1, 2] + c[2, 1])
    else:
        q = (c[1, 0] - c[0, 1], c[0, 2] + c[2, 0], c[1, 2] + c[2, 1], squares[3])
    return normalise(q)


@kernel
def triad(samples: Floats, field_n: Vector, out: Floats) -> None:
    """(3.11)–(3.14): gravity is kept whole, the field only turns about it."""
    r1 = UP
    r2 = unit(cross(UP, field_n))
    r3 = cross(r1, r2)
    c = np.empty((3, 3))
    for i in range(samples.shape[0]):
        s1 = unit((samples[i, 1], samples[i, 2], samples[i, 3]))
        s2 = unit(cross(s1, (samples[i, 7], samples[i, 8], samples[i, 9])))
        s3 = cross(s1, s2)
        for j in range(3):
            for k in range(3):
                c[j, k] = r1[j] * s1[k] + r2[j] * s2[k] + r3[j] * s3[k]
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = quaternion_of(c)


@kernel
def quest(samples: Floats, field_n: Vector, out: Floats) -> None:
    """(3.15), steps a–f: the eigenvector of K's largest eigenvalue; both directions weigh the same."""
    north = unit(field_n)
    K = np.empty((4, 4))
    for i in range(samples.shape[0]):
        a = unit((samples[i, 1], samples[i, 2], samples[i, 3]))
        m = unit((samples[i, 7], samples[i, 8], samples[i, 9]))
        trace = 0.0
        for j in range(3):
            trace += a[j] * UP[j] + m[j] * north[j]
        for j in range(3):
            for k in range(3):
                d = a[j] * UP[k] + m[j] * north[k]
                K[j, k] = d + a[k] * UP[j] + m[k] * north[j] - (trace if j == k else 0.0)
        z = cross_sum(a, m, north)
        for j in range(3):
            K[j, 3], K[3, j] = z[j], z[j]
        K[3, 3] = trace
        _, vectors = np.linalg.eigh(K)
        # the scalar comes last; the matrix of Shuster's quaternion is the transpose of Hamilton's
        out[i, 0] = vectors[3, 3]
        out[i, 1], out[i, 2], out[i, 3] = vectors[0, 3], vectors[1, 3], vectors[2, 3]


@kernel
def cross_sum(a: Vector, m: Vector, north: Vector) -> Vector:
    """z of step d: the antisymmetric part of D."""
    p, q = cross(a, UP), cross(m, north)
    return (p[0] + q[0], p[1] + q[1], p[2] + q[2])


@kernel
def fqa(samples: Floats, out: Floats) -> None:
    """(3.16)–(3.25): the field turns only about the vertical."""
    for i in range(samples.shape[0]):
        tilt = fqa_tilt((samples[i, 1], samples[i, 2], samples[i, 3]))
        yaw = fqa_yaw(tilt, (samples[i, 7], samples[i, 8], samples[i, 9]), 0.0)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = multiply(yaw, tilt)


@kernel
def full_step(q: Quaternion, force_b: Vector, field_b: Vector, field_n: Vector, weight: float) -> Vector:
    """Δv_full of (23): the Gauss–Newton step, half a rotation vector in b.

    To first order a turn v of q moves a predicted direction d̂ by 2 d̂ × v, which is X_v of (22) written
    out; the field's error and derivative are weighted by ρ, (17).
    """
    h, b = unit(force_b), unit(field_b)
    h_hat, b_hat = rotate(conjugate(q), UP), rotate(conjugate(q), unit(field_n))
    normal = np.zeros((3, 3))
    right = np.zeros(3)
    for measured, predicted, rho in ((h, h_hat, 1.0), (b, b_hat, weight)):
        e = (measured[0] - predicted[0], measured[1] - predicted[1], measured[2] - predicted[2])
        # XᵀX = 4ρ²(I − d̂d̂ᵀ) and Xᵀε = 2ρ² e × d̂ for X = 2ρ[d̂×]
        side = cross(e, predicted)
        for j in range(3):
            for k in range(3):
                normal[j, k] += 4.0 * rho * rho * ((1.0 if j == k else 0.0) - predicted[j] * predicted[k])
            right[j] += 2.0 * rho * rho * side[j]
    v = np.linalg.solve(normal, right)
    return (v[0], v[1], v[2])


@kernel
def criterion(q: Quaternion, force_b: Vector, field_b: Vector, field_n: Vector) -> float:
    """φ(q̂) of (19)."""
    h, b = unit(force_b), unit(field_b)
    h_hat, b_hat = rotate(conjugate(q), UP), rotate(conjugate(q), unit(field_n))
    total = 0.0
    for j in range(3):
        total += (h[j] - h_hat[j]) ** 2 + (b[j] - b_hat[j]) ** 2
    return total


@kernel
def gauss_newton(
    samples: Floats, field_n: Vector, start: Quaternion, gain: float, weight: float, every: int, out: Floats
) -> None:
    """The reduced-order filter, (13)–(27), by Euler's method; corrected at every ``every``-th sample.

    A correction that comes more seldom stands for all samples until the next: k·Δt of the whole time.
    """
    q = start
    out[0, 0], out[0, 1], out[0, 2], out[0, 3] = q
    for i in range(1, samples.shape[0]):
        before = samples[i - 1]
        dt_s = (samples[i, 0] - before[0]) * 1e-9
        rate = multiply(q, (0.0, before[4], before[5], before[6]))
        pull = (0.0, 0.0, 0.0, 0.0)
        if (i - 1) % every == 0:
            force_b, field_b = (before[1], before[2], before[3]), (before[7], before[8], before[9])
            v = full_step(q, force_b, field_b, field_n, weight)
            pull = multiply(q, (0.0, v[0], v[1], v[2]))
        share = min(gain * dt_s * every, 1.0)
        q = normalise(
            (
                q[0] + 0.5 * dt_s * rate[0] + share * pull[0],
                q[1] + 0.5 * dt_s * rate[1] + share * pull[1],
                q[2] + 0.5 * dt_s * rate[2] + share * pull[2],
                q[3] + 0.5 * dt_s * rate[3] + share * pull[3],
            )
        )
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = q
