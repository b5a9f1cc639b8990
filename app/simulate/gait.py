"""Heart: one gait cycle of the foot as scalar profiles with closed forms: the papers' and a smooth one.

A cycle is timed from heel-off: preswing, swing, initial contact, then foot flat until the next.
Table I of the 2012 paper (Table 8 of the dissertation) is one second long; other cadences stretch
it, angles and lengths unchanged.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.special import erf

from app.motion.basics import Floats

#: Where preswing, swing and initial contact end, and how long the foot stands flat: shares of a cycle.
TOE_OFF, HEEL_STRIKE, FOOT_FLAT, FLAT_SHARE = 0.1, 0.5, 0.6, 0.4
#: ω_y of the three moving phases, rad per cycle (rad/s in a cycle of 1 s).
PRESWING_RATE, SWING_RATE, CONTACT_RATE = -7.5, 3.5, -6.5
#: σ of the Gaussian (eq. 14) and half the swing, shares of a cycle.
SIGMA, HALF_SWING = 0.05, 0.2
#: The smooth model rounds the papers' corners in pitch over ± this share of a cycle, has lifted the foot
#: by ``RISEN`` and lowers it from ``FALLING``.
ROUNDING, RISEN, FALLING = 0.04, 0.16, 0.4


class Profile(NamedTuple):
    """A foot within its cycle, arrays [n]. Rates and accelerations are per second and second².

    ``advance`` is the share of a stride travelled, ``turn`` the share of its heading change,
    ``lift_m`` the height above the line from footprint to footprint.
    """

    pitch_rad: Floats
    pitch_radps: Floats
    advance: Floats
    advance_rate: Floats
    advance_acceleration: Floats
    lift_m: Floats
    lift_mps: Floats
    lift_mps2: Floats
    turn: Floats
    turn_rate: Floats


Gait = Callable[[Floats, float, float], Profile]
"""(seconds since heel-off [n], cycle s, lift m) → profile."""


def papers_gait(since_heel_off_s: Floats, cycle_s: float, lift_m: float) -> Profile:
    """The papers' foot: constant rates, a truncated Gaussian in the sagittal plane (eqs. 14–15, 4.14–4.17).

    The accelerations are theirs to the letter, but not quite those of a foot that rests on level
    ground before and after: the Gaussian jumps at the edges of the swing, and no accelerometer
    shows a jump. Truth here integrates the accelerations and adds what rest needs, by the smallest
    jumps (least squares):

    - Forward the acceleration sums to 0, so there are none: v = v(14) − v(14 at the edge), and a
      stride is ``papers_reach()`` of its nominal length, 0.11 % short.
    - Upward it sums to 2 ṡ(0.2 s), −13 mm/s for a lift of 0.25 m: half of it is lost at each edge,
      which is eq. 15 itself less its 84 µm at the edge, and the only split that keeps the floor level.
    """
    u = since_heel_off_s / cycle_s
    pitch, pitch_radps, flying = _papers_pitch(since_heel_off_s, cycle_s)
    x = np.clip(u - 0.5 * (TOE_OFF + HEEL_STRIKE), -HALF_SWING, HALF_SWING)
    bell = np.exp(-0.5 * (x / SIGMA) ** 2)
    slope = -flying * bell * x / SIGMA**2
    edge = np.exp(-0.5 * (HALF_SWING / SIGMA) ** 2)
    peak = 1.0 / (SIGMA * np.sqrt(2.0 * np.pi))
    travelled = 0.5 * (erf(x / SIGMA / np.sqrt(2.0)) + erf(HALF_SWING / SIGMA / np.sqrt(2.0)))
    return Profile(
        pitch_rad=pitch,
        pitch_radps=pitch_radps,
        advance=travelled - peak * edge * (x + HALF_SWING),
        advance_rate=peak * (bell - edge) / cycle_s,
        advance_acceleration=peak * slope / cycle_s**2,
        lift_m=lift_m * (bell - edge),
        lift_mps=lift_m * slope / cycle_s,
        lift_mps2=lift_m * flying * bell * ((x / SIGMA) ** 2 - 1.0) / SIGMA**2 / cycle_s**2,
        turn=np.zeros_like(u),
        turn_rate=np.zeros_like(u),
    )


def _papers_pitch(since_heel_off_s: Floats, cycle_s: float) -> tuple[Floats, Floats, Floats]:
    """Pitch, its rate, and 1 in the swing. What jumps reads the middle on the jump itself.

    A walk is often sampled on the grid of its phases. Were such a sample to read one side of the
    jump, the trapezoid rule would tilt every stride: at 50 Hz, 4 m of height over 120 m.
    """
    # whole nanoseconds, so that rounding in the last bit cannot move a sample across a jump
    jumps_ns = np.rint(np.array([0.0, TOE_OFF, HEEL_STRIKE, FOOT_FLAT]) * cycle_s * 1e9)
    t_ns = np.rint(since_heel_off_s * 1e9)
    before, after = (
        np.searchsorted(jumps_ns, t_ns, side="left"),
        np.searchsorted(jumps_ns, t_ns, side="right"),
    )
    rates = np.array([0.0, PRESWING_RATE, SWING_RATE, CONTACT_RATE, 0.0]) / cycle_s
    starts = np.array([0.0, 0.0, TOE_OFF, HEEL_STRIKE, FOOT_FLAT]) * cycle_s
    angles = np.array([0.0, 0.0, PRESWING_RATE * TOE_OFF, CONTACT_RATE * (HEEL_STRIKE - FOOT_FLAT), 0.0])
    pitch = angles[after] + rates[after] * (since_heel_off_s - starts[after])
    return pitch, 0.5 * (rates[before] + rates[after]), 0.5 * (before == 2) + 0.5 * (after == 2)


def papers_reach() -> float:
    """The share of its nominal stride that the papers' foot travels: 0.99887."""
    half = HALF_SWING / SIGMA
    return float(erf(half / np.sqrt(2.0)) - 2.0 * half * np.exp(-0.5 * half**2) / np.sqrt(2.0 * np.pi))


def smooth_gait(since_heel_off_s: Floats, cycle_s: float, lift_m: float) -> Profile:
    """The same phases and angles without jumps: pitch, travel, lift and turn are twice differentiable.

    Pitch is the papers' with rounded corners; travel and turn are a minimum-jerk step over the
    swing. The lift begins at heel-off and ends at foot-flat: a shoe that tips about its toe raises
    the instep, and would dig into the floor if it did not. While flat, the foot stands exactly still.
    """
    u = since_heel_off_s / cycle_s
    pitch, pitch_rate = _rounded_pitch(u)
    travel = _step_between(u, TOE_OFF, HEEL_STRIKE)
    rise, fall = _step_between(u, 0.0, RISEN), _step_between(u, FALLING, FOOT_FLAT)
    return Profile(
        pitch_rad=pitch,
        pitch_radps=pitch_rate / cycle_s,
        advance=travel[0],
        advance_rate=travel[1] / cycle_s,
        advance_acceleration=travel[2] / cycle_s**2,
        lift_m=lift_m * (rise[0] - fall[0]),
        lift_mps=lift_m * (rise[1] - fall[1]) / cycle_s,
        lift_mps2=lift_m * (rise[2] - fall[2]) / cycle_s**2,
        turn=travel[0],
        turn_rate=travel[1] / cycle_s,
    )


def _rounded_pitch(u: Floats) -> tuple[Floats, Floats]:
    """The papers' pitch, piecewise linear, averaged over ± ``ROUNDING``: a sum of rounded ramps."""
    rates = (PRESWING_RATE, SWING_RATE, CONTACT_RATE)
    bends = np.diff(rates, prepend=0.0, append=0.0)
    pitch, rate = np.zeros_like(u), np.zeros_like(u)
    for corner, bend in zip((0.0, TOE_OFF, HEEL_STRIKE, FOOT_FLAT), bends, strict=True):
        ramp, ramp_rate = rounded_ramp((u - corner) / ROUNDING)
        pitch += bend * ROUNDING * ramp
        rate += bend * ramp_rate
    flat = (u <= -ROUNDING) | (u >= FOOT_FLAT + ROUNDING)  # here the ramps cancel but for the last bit
    return np.where(flat, 0.0, pitch), np.where(flat, 0.0, rate)


def _step_between(u: Floats, start: float, end: float) -> tuple[Floats, Floats, Floats]:
    """A minimum-jerk step from ``start`` to ``end``, and its derivatives by u."""
    width = end - start
    value, slope, bend = minimum_jerk((u - start) / width)
    return value, slope / width, bend / width**2


def minimum_jerk(x: Floats) -> tuple[Floats, Floats, Floats]:
    """From 0 to 1 over 0 ≤ x ≤ 1 with rest at both ends, and its two derivatives."""
    x = np.clip(x, 0.0, 1.0)
    rest = x * (1.0 - x)
    return x**3 * (10.0 + x * (6.0 * x - 15.0)), 30.0 * rest**2, 60.0 * rest * (1.0 - 2.0 * x)


def rounded_ramp(x: Floats) -> tuple[Floats, Floats]:
    """max(0, x) averaged with the weight 15/16 (1 − x²)² over ±1, and its derivative; exact beyond ±1."""
    y = np.clip(x, -1.0, 1.0)
    even = 15.0 / 16.0 * y**2 * (0.5 + y**2 * (y**2 / 30.0 - 1.0 / 6.0))
    rate = 0.5 + 15.0 / 16.0 * y * (1.0 + y**2 * (y**2 / 5.0 - 2.0 / 3.0))
    return np.where(x >= 1.0, x, 0.5 * y + 5.0 / 32.0 + even), rate
