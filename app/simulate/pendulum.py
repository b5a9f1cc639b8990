"""Heart: a damped pendulum with a sensor at its end (dissertation III-G), its motion solved by SciPy.

The sensor hangs at A: x along the swing, z down the rod, y the axis of rotation, the plane of motion north.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from app.motion.basics import Floats, Vector
from app.motion.samples import SAMPLE_WIDTH
from app.simulate.sensors import DIP_RAD, FIELD_UT

_EXACT = 1e-12


@dataclass(frozen=True)
class Pendulum:
    """(3.62) and its parameters; released at rest."""

    length_m: float = 1.0
    gravity_mps2: float = 9.81
    mass_kg: float = 1.0
    damping: float = 0.313  # N·s
    start_deg: float = 10.0


class Swinging(NamedTuple):
    """The pendulum at n instants: rad, rad/s, rad/s²; arrays [n]."""

    angle: Floats
    rate: Floats
    acceleration: Floats


Truth = Callable[[Floats], Swinging]


def swing(pendulum: Pendulum, duration_s: float) -> Truth:
    """The motion at any instants from 0 to ``duration_s``: m L θ̈ = −m g sin θ − c θ̇, (3.62)."""
    p = pendulum

    def acceleration(angle: Floats, rate: Floats) -> Floats:
        pull = p.mass_kg * p.gravity_mps2 * np.sin(angle) + p.damping * rate
        return -pull / (p.mass_kg * p.length_m)

    def slope(_: float, y: Floats) -> Floats:
        return np.array([y[1], acceleration(y[0], y[1])])

    start = [math.radians(p.start_deg), 0.0]
    solved = solve_ivp(
        slope, (0.0, duration_s), start, "DOP853", dense_output=True, rtol=_EXACT, atol=_EXACT
    ).sol
    assert solved is not None  # asked for by dense_output

    def at(t_s: Floats) -> Swinging:
        angle, rate = solved(t_s)
        return Swinging(angle, rate, acceleration(angle, rate))

    return at


def read(
    pendulum: Pendulum,
    truth: Truth,
    t_s: Floats,
    *,
    gyro_bias_radps: Vector = (0.0, 0.0, 0.0),
    force_bias_mps2: Vector = (0.0, 0.0, 0.0),
    motion: bool = True,
) -> Floats:
    """What the sensor reads at these seconds [n, 10], columns as ``Column``: (3.73)–(3.75).

    ``motion`` off leaves out what the swing itself adds to the specific force (Fig. 42).
    """
    angle, rate, acceleration = truth(t_s)
    g, moved = pendulum.gravity_mps2, pendulum.length_m * float(motion)
    samples = np.zeros((len(t_s), SAMPLE_WIDTH))
    samples[:, 0] = np.rint(t_s * 1e9)
    samples[:, 1] = moved * acceleration + g * np.sin(angle)
    samples[:, 3] = -moved * rate**2 - g * np.cos(angle)
    samples[:, 5] = rate
    samples[:, 7] = FIELD_UT * np.cos(DIP_RAD + angle)
    samples[:, 9] = FIELD_UT * np.sin(DIP_RAD + angle)
    samples[:, 1:4] += force_bias_mps2
    samples[:, 4:7] += gyro_bias_radps
    return samples
