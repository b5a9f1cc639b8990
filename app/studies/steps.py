"""Heart: the dissertation's four models of one step, their sampling grids, and four ways to integrate."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.special import erf

from app.motion.basics import Floats
from app.simulate.gait import SIGMA

#: One step: it stands until 0.5 s, swings for 0.4 s, and stands again until 1.0 s.
LIFT_S, SWING_S, END_S = 0.5, 0.4, 1.0

Profile = Callable[[Floats], Floats]
"""Seconds since the lift [n] → m/s² or m for a step of 1 m."""


def linear(t: Floats) -> Floats:
    """(4.5)."""
    return -12.0 * t / SWING_S**3 + 6.0 / SWING_S**2


def sinusoid(t: Floats) -> Floats:
    """(4.6) with the amplitude π²/(2τ²) that covers the step; the printed L/2 does not."""
    return np.pi**2 / (2.0 * SWING_S**2) * np.cos(np.pi * t / SWING_S)


def gaussian(t: Floats) -> Floats:
    """(4.8): the derivative of a bell, t from its middle."""
    x = t - 0.5 * SWING_S
    a: Floats = -x / (SIGMA**3 * np.sqrt(2.0 * np.pi)) * np.exp(-0.5 * (x / SIGMA) ** 2)
    return a


def bezier(t: Floats) -> Floats:
    """(4.10)."""
    u = t / SWING_S
    return (120.0 * u**3 - 180.0 * u**2 + 60.0 * u) / SWING_S**2


def lift(t: Floats) -> Floats:
    """(4.17): the vertical acceleration of a Gaussian lift of 1 m, as printed: up is positive."""
    x = (t - 0.5 * SWING_S) / SIGMA
    return np.exp(-0.5 * x**2) * (x**2 - 1.0) / SIGMA**2


def gaussian_position(t: Floats) -> Floats:
    """The integral of the bell (4.7), from 0."""
    x = np.clip(t, 0.0, SWING_S) - 0.5 * SWING_S
    edge = erf(0.5 * SWING_S / SIGMA / np.sqrt(2.0))
    position: Floats = 0.5 * (erf(x / SIGMA / np.sqrt(2.0)) + edge)
    return position


def bezier_position(t: Floats) -> Floats:
    """(4.9)."""
    u = np.clip(t, 0.0, SWING_S) / SWING_S
    return u**3 * (6.0 * u**2 - 15.0 * u + 10.0)


def stretched_grid(rate_hz: float, profile: Profile) -> tuple[Floats, Floats]:
    """Stamps and accelerations as the author sampled: τ·f_s samples over the swing *with both ends*.

    So the swing's spacing is τ/(N − 1), wider than the stances'. Tables 4, 6 and 7 need it.
    """
    step = 1.0 / rate_hz
    count = round(SWING_S * rate_hz)
    before = np.arange(round(LIFT_S * rate_hz)) * step
    swing = np.linspace(0.0, SWING_S, count)
    tail_s = END_S - LIFT_S - SWING_S
    after = LIFT_S + SWING_S + step * np.arange(1, round(tail_s * rate_hz) + 1)
    a = np.concatenate([np.zeros(len(before)), profile(swing), np.zeros(len(after))])
    return np.concatenate([before, LIFT_S + swing, after]), a


def even_grid(rate_hz: float, profile: Profile) -> tuple[Floats, Floats]:
    """Evenly spaced stamps, the swing's last instant already at rest: Table 5 needs it."""
    count = round(END_S * rate_hz) + 1
    first, last = round(LIFT_S * rate_hz), round((LIFT_S + SWING_S) * rate_hz)
    t = np.arange(count) / rate_hz
    a = np.zeros(count)
    a[first:last] = profile(t[first:last] - LIFT_S)
    return t, a


def trapezoid(t: Floats, y: Floats) -> tuple[Floats, Floats]:
    """(4.4): the stamps, and the integral up to each."""
    return t, np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(t))])


def euler(t: Floats, y: Floats) -> tuple[Floats, Floats]:
    """(4.3): each value is held until the next stamp."""
    return t, np.concatenate([[0.0], np.cumsum(y[:-1] * np.diff(t))])


def simpson(t: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Simpson's 1/3 rule: parabolas through three samples, so every second stamp is left."""
    return t[::2], np.concatenate([[0.0], np.cumsum(_parabolas(t, y))])


def modified_simpson(t: Floats, y: Floats) -> tuple[Floats, Floats]:
    """The author's: Simpson's rule to every second stamp, from there a trapezoid to the one between."""
    total = np.empty(len(t))
    total[::2] = simpson(t, y)[1][: len(t[::2])]
    between = total[1::2]
    between[:] = total[: 2 * len(between) : 2] + 0.5 * (y[1::2] + y[: 2 * len(between) : 2]) * np.diff(t)[::2]
    return t, total


def _parabolas(t: Floats, y: Floats) -> Floats:
    """The integral over each pair of intervals, which need not be equal."""
    h, k = np.diff(t)[0::2], np.diff(t)[1::2]
    h = h[: len(k)]
    a, b, c = y[0:-2:2], y[1:-1:2], y[2::2]
    over: Floats = (h + k) / 6.0 * ((2.0 - k / h) * a + (h + k) ** 2 / (h * k) * b + (2.0 - h / k) * c)
    return over


METHODS = {
    "Euler": euler,
    "trapezoid": trapezoid,
    "Simpson 1/3": simpson,
    "modified Simpson": modified_simpson,
}
