"""Heart: the floor under the Kalman filter: footprints at nearly the same height are on the same one.

A soft belief, not a level world: people mostly walk on even floors, and a swing's height is off by a
centimetre or two where the floor is not. A footprint that is higher or lower by more than that, or at the
end of strides that all rose or fell, begins a floor of its own, as high as the filter has it (its error is
copied: stochastic cloning, S. Roumeliotis and J. Burdick, ICRA 2002). So stairs and ramps stay free, and
each landing is even again.
"""

from __future__ import annotations

import math

from app.compiled import part
from app.estimator.covariance import copy_part, measure
from app.estimator.kalman_state import FLOOR_AT, FLOOR_MEASURE, HEIGHT_AT, KalmanState
from app.estimator.taking import begin_shift, take_shift

#: How footprints on one floor differ in height: the foot never stands twice the same (σ, m).
FLOOR_NOISE = 0.01
#: A floor that falls by more of the way, on average over some strides, is no level one; the newest's share.
LEVEL_SLOPE, SLOPE_SHARE = 0.025, 0.2
#: Strides shorter than this tell no slope, m.
SHORTEST_M = 0.3


@part
def stand_on_floor(state: KalmanState) -> None:
    """A swing is over: the foot is on the floor it was on, or on another one."""
    if state.same_floor_m == 0.0:
        return
    sunk = state.pz - state.floor_z
    note_slope(state)
    if abs(sunk) > state.same_floor_m or abs(state.slope) > LEVEL_SLOPE:
        begin_floor(state)
        state.floor_began = 1.0
        return
    begin_shift(state)
    state.totals[FLOOR_MEASURE], state.lefts[FLOOR_MEASURE] = measure(
        state.P, state.shift, state.gains[FLOOR_MEASURE], HEIGHT_AT, FLOOR_AT, -sunk, FLOOR_NOISE**2
    )
    take_shift(state)


@part
def begin_floor(state: KalmanState) -> None:
    """The floor is where the foot stands."""
    state.floor_z = state.pz
    copy_part(state.P, HEIGHT_AT, FLOOR_AT)


@part
def note_slope(state: KalmanState) -> None:
    """How the strides of late fell, beside the way they went; a step up or down is no slope."""
    way = math.hypot(state.px - state.from_x, state.py - state.from_y)
    fell = state.pz - state.from_z
    if way > SHORTEST_M and abs(fell) < state.same_floor_m:
        state.slope += SLOPE_SHARE * (fell / way - state.slope)
