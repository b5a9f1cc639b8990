"""Heart: an accelerometer at the end of its range: what it missed is guessed, and told as a doubt.

Its range is known by a flat top: two samples in a row that read alike, and nothing read more on that axis
and side. A parabola over the gap, with the slopes at its ends, gives the velocity that was missed. A foot is
first pushed and then stopped: what both guesses have in common moves the contact and leaves the velocity
there as it is, so that no zero velocity finds it, and in each stride it goes the same way.
"""

from __future__ import annotations

import math

from app.compiled import part
from app.estimator.clipping import axis_in_n
from app.estimator.covariance import add_variance_along
from app.estimator.kalman_state import VELOCITY_AT, KalmanState
from app.motion.basics import Vector

#: A top is that of a range from here on, m/s²: the smallest range is 2 g.
LEAST_TOP = 18.0
#: What a clipped sample may have missed, as a share of the top (σ); the samples of a run miss alike.
MISSED_SHARE = 0.5
#: A clipped run lasts at least so many samples to be mended; the slope, m/s³, and the velocity are capped.
SHORTEST_RUN, MOST_SLOPE, MOST_MPS = 3, 3000.0, 3.0
#: What is left of a guess, as a share of what may have been missed.
LEFT_SHARE = 0.2
#: Columns of ``jolts``: the tops read to either side, and where they are flat (0: nowhere); samples in a row
#: at the top, how long that is, s; the slope before the last sample, and before them, m/s³.
_TOP, _FLAT, _RUN, _LASTED, _SLOPE, _BEGAN = 0, 2, 4, 5, 6, 7


@part
def mind_jolts(state: KalmanState, before: Vector, dt_s: float) -> None:
    """For each accelerometer axis: doubt while it clips, the velocity it missed when it stops."""
    forces, jolts = (state.f0, state.f1, state.f2), state.jolts
    for axis in range(3):
        force = forces[axis]
        slope = abs(force - before[axis]) / dt_s
        if abs(force) >= max(jolts[axis, _TOP + (force < 0.0)], LEAST_TOP):
            clip(state, axis, force, dt_s)
        else:
            if jolts[axis, _RUN] >= SHORTEST_RUN:
                mend(state, axis, before[axis], slope, dt_s)
            jolts[axis, _RUN] = 0.0
        jolts[axis, _SLOPE] = slope


@part
def clip(state: KalmanState, axis: int, force: float, dt_s: float) -> None:
    """One sample at the top, or a new one."""
    jolts, side, top = state.jolts, int(force < 0.0), abs(force)
    if top > jolts[axis, _TOP + side]:
        jolts[axis, _TOP + side], jolts[axis, _FLAT + side], jolts[axis, _RUN] = top, 0.0, 0.0
    elif jolts[axis, _RUN] > 0.0:
        jolts[axis, _FLAT + side] = 1.0
    if jolts[axis, _RUN] == 0.0:
        jolts[axis, _BEGAN], jolts[axis, _LASTED] = jolts[axis, _SLOPE], 0.0
    else:
        jolts[axis, _LASTED] += dt_s
    if jolts[axis, _FLAT + side] != 0.0:
        missed = MISSED_SHARE * top * dt_s
        variance = missed * missed * (2.0 * jolts[axis, _RUN] + 1.0)
        add_variance_along(state.P, VELOCITY_AT, axis_in_n(state, axis), variance)
        note_missed(state, missed)
    jolts[axis, _RUN] += 1.0


@part
def mend(state: KalmanState, axis: int, force: float, slope: float, dt_s: float) -> None:
    """A parabola over the gap would have gained s·D²/6 more; half of the gap ago, on average."""
    lasted_s = state.jolts[axis, _LASTED] + dt_s
    mean_slope = min(0.5 * (state.jolts[axis, _BEGAN] + slope), MOST_SLOPE)
    gained = min(mean_slope * lasted_s * lasted_s / 6.0, MOST_MPS)
    note_missed(state, max(gained - MISSED_SHARE * abs(force) * lasted_s, 0.0))
    gained = gained if force > 0.0 else -gained
    axis_n = axis_in_n(state, axis)
    x, y, z = gained * axis_n[0], gained * axis_n[1], gained * axis_n[2]
    state.vx, state.vy, state.vz = state.vx + x, state.vy + y, state.vz + z
    state.gained_x, state.gained_y = state.gained_x + x, state.gained_y + y
    state.gained_z += z
    half_s = 0.5 * lasted_s
    state.px, state.py, state.pz = state.px + half_s * x, state.py + half_s * y, state.pz + half_s * z


@part
def note_missed(state: KalmanState, missed_mps: float) -> None:
    """How much was missed in this swing, and when: its moments about the lift."""
    since_s = 1e-9 * (state.elapsed_ns - state.lift_ns)
    state.missed_mps += missed_mps
    state.missed_at += missed_mps * since_s
    state.missed_at2 += missed_mps * since_s * since_s


@part
def doubt_jolts(state: KalmanState) -> None:
    """At a contact: how far off it may be because the swing was pushed and stopped beyond the range.

    What the velocity of the stance leaves open: all that was missed times how far in time it spreads.
    """
    spread2 = state.missed_mps * state.missed_at2 - state.missed_at * state.missed_at
    state.missed_m += LEFT_SHARE * math.sqrt(max(spread2, 0.0))
    state.missed_mps, state.missed_at, state.missed_at2 = 0.0, 0.0, 0.0


@part
def forget_jolts(state: KalmanState) -> None:
    """A new segment: no gap goes on into it."""
    state.missed_mps, state.missed_at, state.missed_at2 = 0.0, 0.0, 0.0
    for axis in range(3):
        state.jolts[axis, _RUN] = 0.0
