"""Heart: the still start: level, gravity and gyro bias from the mean of a window, not from one sample.

A recording may start in mid-walk. Then the first stance serves, if it lasts at least
``SHORTEST_REST_S``, for level and gravity; the gyro's bias is taken only from a window that is
truly still, because a false bias costs more than none.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from app.compiled import part
from app.estimator import state as s
from app.estimator.gait import STANCE
from app.estimator.state import State

if TYPE_CHECKING:
    from app.estimator.papers import Reading


@part
def begin_rest(state: State) -> None:
    """Level is unknown from here on; the window is empty."""
    state.levelled = 0.0
    state.phase = STANCE
    state.contrary_s = 0.0
    state.rest_s, state.rest_n, state.rest_norm = 0.0, 0.0, 0.0
    state.rest_fx, state.rest_fy, state.rest_fz = 0.0, 0.0, 0.0
    state.rest_wx, state.rest_wy, state.rest_wz = 0.0, 0.0, 0.0
    state.rest_wx2, state.rest_wy2, state.rest_wz2 = 0.0, 0.0, 0.0
    state.rest_mx, state.rest_my, state.rest_mz = 0.0, 0.0, 0.0


@part
def rest(state: State, reading: Reading, dt_s: float) -> int:
    """One sample of the search for level: ``RESTING`` goes on, ``LEVEL_FOUND`` ends it.

    Both at once: this sample completed the window. ``LEVEL_FOUND`` alone: this sample already moves,
    and the rest before it was long enough.
    """
    if state.statistic >= state.threshold_radps:
        if state.rest_s >= s.SHORTEST_REST_S:
            find_gravity(state)
            return s.LEVEL_FOUND
        begin_rest(state)
        return s.RESTING
    if state.rest_n > 0.0:
        state.rest_s += dt_s
    add(state, reading)
    if state.rest_s < state.still_window_s - 0.5 * dt_s:
        return s.RESTING
    find_gravity(state)
    if state.bias_from_rest != 0.0 and truly_still(state):
        n, w = state.rest_n, reading.rate_b
        state.bias_x, state.bias_y, state.bias_z = state.rest_wx / n, state.rest_wy / n, state.rest_wz / n
        state.wx, state.wy, state.wz = w[0] - state.bias_x, w[1] - state.bias_y, w[2] - state.bias_z
    return s.RESTING | s.LEVEL_FOUND


@part
def add(state: State, reading: Reading) -> None:
    """One more sample in the window's sums."""
    f, w, m = reading.force_b, reading.rate_b, reading.field_b
    state.rest_n += 1.0
    state.rest_norm += math.sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2])
    state.rest_fx, state.rest_fy, state.rest_fz = (
        state.rest_fx + f[0],
        state.rest_fy + f[1],
        state.rest_fz + f[2],
    )
    state.rest_wx, state.rest_wy, state.rest_wz = (
        state.rest_wx + w[0],
        state.rest_wy + w[1],
        state.rest_wz + w[2],
    )
    state.rest_wx2 += w[0] * w[0]
    state.rest_wy2 += w[1] * w[1]
    state.rest_wz2 += w[2] * w[2]
    if not math.isnan(m[0] + m[1] + m[2]):
        state.rest_mx, state.rest_my, state.rest_mz = (
            state.rest_mx + m[0],
            state.rest_my + m[1],
            state.rest_mz + m[2],
        )


@part
def find_gravity(state: State) -> None:
    """Gravity is the mean |f| of the window, or what the person set."""
    state.levelled = 1.0
    state.gravity = state.gravity_mps2
    if state.gravity == 0.0:
        state.gravity = state.rest_norm / state.rest_n


@part
def truly_still(state: State) -> bool:
    """Whether each axis' rate hardly scatters and hardly differs from zero."""
    return (
        still_axis(state.rest_wx, state.rest_wx2, state.rest_n)
        and still_axis(state.rest_wy, state.rest_wy2, state.rest_n)
        and still_axis(state.rest_wz, state.rest_wz2, state.rest_n)
    )


@part
def still_axis(total: float, squares: float, count: float) -> bool:
    """One axis of it, from its sums."""
    mean = total / count
    return abs(mean) <= s.STILL_MEAN and squares / count - mean * mean <= s.STILL_STD**2
