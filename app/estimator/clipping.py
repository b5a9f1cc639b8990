"""Heart: a gyro at the end of its range: what it reads is no belief, and what it missed is guessed.

Gyros are sold for 500, 1000, 2000 °/s (8.7, 17.5, 35 rad/s) and read at most some per cent more. The
range is taken as 500 °/s until a rate well beyond it was read, unless a person says it. Others end at
250 or 300 °/s: that is a top that two samples in a row read alike, and nothing goes beyond.
"""

from __future__ import annotations

from app.compiled import part
from app.estimator.covariance import add_variance_along
from app.estimator.kalman_state import ATTITUDE_AT, KalmanState
from app.motion.basics import Vector
from app.rotation import exponential, multiply, normalise, rotate

FIRST_RANGE_RADPS = 8.727
#: A rate of this share of the range is clipped; one this far beyond it shows a larger range.
AT_RANGE, BEYOND = 0.965, 1.15
#: A flat top between these, rad/s, is a range of 250 or 300 °/s.
OLD_RANGES_RADPS = (4.2, 5.8)
#: Rate that a clipped sample may have missed, rad/s (σ).
MISSED_RADPS = 6.0
#: A clipped run lasts at least so many samples to be mended; slopes and lost angle are capped.
SHORTEST_RUN = 3
MOST_SLOPE, MOST_ANGLE = 600.0, 0.3


@part
def gyro_range(state: KalmanState, before: Vector) -> float:
    """The range by the rates read so far, rad/s; ``before`` is the sample before."""
    rates = (state.w0, state.w1, state.w2)
    state.top_radps = max(state.top_radps, max(abs(state.w0), max(abs(state.w1), abs(state.w2))))
    if state.gyro_range_radps > 0.0:
        return state.gyro_range_radps
    if OLD_RANGES_RADPS[0] < state.top_radps < OLD_RANGES_RADPS[1]:
        for axis in range(3):
            if rates[axis] == before[axis] and abs(rates[axis]) == state.top_radps:
                state.flat_radps = state.top_radps
    if state.flat_radps > 0.0 and state.flat_radps == state.top_radps:
        return state.flat_radps
    full = FIRST_RANGE_RADPS
    while state.top_radps > BEYOND * full:
        full *= 2.0
    return full


@part
def mind_clipping(state: KalmanState, before: Vector, dt_s: float) -> None:
    """For each gyro axis: doubt about it while it clips, the angle it lost when it stops.

    ``before`` is the sample before, its bias still in it.
    """
    limit = AT_RANGE * gyro_range(state, before)
    rates = (state.w0, state.w1, state.w2)
    for axis in range(3):
        rate, clipped_n = rates[axis], state.clip[axis, 0]
        slope = abs(rate - before[axis]) / dt_s
        if abs(rate) >= limit:
            state.clip[axis, 2] = 0.0 if clipped_n == 0.0 else state.clip[axis, 2] + dt_s
            state.clip[axis, 0] = clipped_n + 1.0
            add_variance_along(state.P, ATTITUDE_AT, axis_in_n(state, axis), (MISSED_RADPS * dt_s) ** 2)
            continue
        if clipped_n >= SHORTEST_RUN:
            mean_slope = min(0.5 * (state.clip[axis, 1] + slope), MOST_SLOPE)
            mend(state, axis, mean_slope, state.clip[axis, 2] + dt_s, before[axis])
        state.clip[axis, 0] = 0.0
        state.clip[axis, 1] = slope


@part
def mend(state: KalmanState, axis: int, slope: float, lasted_s: float, rate: float) -> None:
    """A parabola over the gap with these slopes at its ends would have turned s·D²/6 more."""
    angle = min(slope * lasted_s * lasted_s / 6.0, MOST_ANGLE)
    x, y, z = axis_in_n(state, axis)
    angle = angle if rate > 0.0 else -angle
    turn = exponential((angle * x, angle * y, angle * z))
    state.q0, state.q1, state.q2, state.q3 = normalise(
        multiply(turn, (state.q0, state.q1, state.q2, state.q3))
    )


@part
def axis_in_n(state: KalmanState, axis: int) -> Vector:
    """A body axis in *n*."""
    q = (state.q0, state.q1, state.q2, state.q3)
    return rotate(q, (1.0 if axis == 0 else 0.0, 1.0 if axis == 1 else 0.0, 1.0 if axis == 2 else 0.0))
