"""Heart: unit quaternions, wxyz, as plain tuples: the same code compiled and in Python.

``q_nb`` takes a body vector into the navigation frame: ``v_n = rotate(q_nb, v_b)``. Products are
Hamilton's (dissertation, footnote to eq. 2.6); yaw, pitch and roll are NED's, z–y–x.
"""

from __future__ import annotations

import math

from app.compiled import kernel, part
from app.motion.basics import Quaternion, Vector


@kernel
def multiply(p: Quaternion, q: Quaternion) -> Quaternion:
    """Hamilton product p ⊗ q."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


@kernel
def conjugate(q: Quaternion) -> Quaternion:
    """The inverse of a unit quaternion."""
    return (q[0], -q[1], -q[2], -q[3])


@part
def normalise(q: Quaternion) -> Quaternion:
    """q / |q|; the identity where |q| is 0."""
    norm = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    if norm == 0.0:
        return (1.0, 0.0, 0.0, 0.0)
    return (q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm)


@kernel
def rotate(q: Quaternion, v: Vector) -> Vector:
    """q ⊗ v ⊗ q* (2012 paper, eq. 5), by the 30-operation form."""
    tx = 2.0 * (q[2] * v[2] - q[3] * v[1])
    ty = 2.0 * (q[3] * v[0] - q[1] * v[2])
    tz = 2.0 * (q[1] * v[1] - q[2] * v[0])
    return (
        v[0] + q[0] * tx + q[2] * tz - q[3] * ty,
        v[1] + q[0] * ty + q[3] * tx - q[1] * tz,
        v[2] + q[0] * tz + q[1] * ty - q[2] * tx,
    )


@part
def exponential(rotation_vector: Vector) -> Quaternion:
    """The quaternion of a rotation vector (rad).

    Up to 0.2 rad, which is nearly every turn between two samples, by series that are exact to the
    last bit or two there; sin(x)/x needs one at 0 anyway.
    """
    x, y, z = rotation_vector
    u = 0.25 * (x * x + y * y + z * z)  # half the angle, squared
    if u < 0.01:
        scale = 0.5 * (1.0 - u / 6.0 * (1.0 - u / 20.0 * (1.0 - u / 42.0 * (1.0 - u / 72.0))))
        w = 1.0 - u / 2.0 * (1.0 - u / 12.0 * (1.0 - u / 30.0 * (1.0 - u / 56.0 * (1.0 - u / 90.0))))
        return (w, scale * x, scale * y, scale * z)
    half = math.sqrt(u)
    scale = 0.5 * math.sin(half) / half
    return (math.cos(half), scale * x, scale * y, scale * z)


@kernel
def from_yaw(yaw_rad: float) -> Quaternion:
    """A turn about down."""
    return (math.cos(0.5 * yaw_rad), 0.0, 0.0, math.sin(0.5 * yaw_rad))


@kernel
def from_yaw_pitch_roll(yaw_rad: float, pitch_rad: float, roll_rad: float) -> Quaternion:
    """Yaw about z, then pitch about the new y, then roll about the new x."""
    yaw = from_yaw(yaw_rad)
    pitch = (math.cos(0.5 * pitch_rad), 0.0, math.sin(0.5 * pitch_rad), 0.0)
    roll = (math.cos(0.5 * roll_rad), math.sin(0.5 * roll_rad), 0.0, 0.0)
    return multiply(multiply(yaw, pitch), roll)


@kernel
def yaw_of(q: Quaternion) -> float:
    """Heading of body x over the horizontal plane, rad, clockwise from north seen from above."""
    return math.atan2(2.0 * (q[1] * q[2] + q[0] * q[3]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]))


@kernel
def pitch_of(q: Quaternion) -> float:
    """Elevation of body x above the horizontal plane, rad."""
    return math.asin(min(1.0, max(-1.0, 2.0 * (q[0] * q[2] - q[1] * q[3]))))


@kernel
def roll_of(q: Quaternion) -> float:
    """Turn about body x, rad."""
    return math.atan2(2.0 * (q[2] * q[3] + q[0] * q[1]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]))
