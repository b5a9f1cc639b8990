"""Heart: strapdown integration and the zero-velocity update (2012 paper, II-B)."""

from __future__ import annotations

from app.compiled import kernel, part
from app.motion.basics import Quaternion, Vector
from app.rotation import rotate


@part
def motion_acceleration(q_nb: Quaternion, force_b: Vector, gravity_mps2: float) -> Vector:
    """(5) and (6): a_m = q ⊗ f ⊗ q* − g, where g is the at-rest *reading* (0, 0, −g)."""
    a = rotate(q_nb, force_b)
    return (a[0], a[1], a[2] + gravity_mps2)


@part
def trapezoid(total: Vector, before: Vector, now: Vector, dt_s: float) -> Vector:
    """∫ by the trapezoidal rule, one sample on: (7) for the velocity, then for the position."""
    half = 0.5 * dt_s
    return (
        total[0] + half * (before[0] + now[0]),
        total[1] + half * (before[1] + now[1]),
        total[2] + half * (before[2] + now[2]),
    )


@kernel
def bias_of_swing(end_velocity_n: Vector, swing_s: float) -> Vector:
    """(10): ε = v(T) / T: the acceleration error that explains why the foot did not come to rest."""
    return (end_velocity_n[0] / swing_s, end_velocity_n[1] / swing_s, end_velocity_n[2] / swing_s)


@part
def without_bias(raw_n: Vector, bias_n: Vector, since_lift_s: float) -> Vector:
    """Position from (9) solved for the true velocity: its integral with ε left in, less ½ ε t²."""
    w = 0.5 * since_lift_s * since_lift_s
    return (raw_n[0] - w * bias_n[0], raw_n[1] - w * bias_n[1], raw_n[2] - w * bias_n[2])
