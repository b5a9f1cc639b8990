"""Heart: the start of the Kalman filter's walk: level, gravity, and a gyro bias with its own doubt.

Level is found in the first window of half a second whose statistic stays low; a recording that starts
in mid-walk is levelled in its first short stance, and what counts as low loosens until there is one.
People sway, so a window's mean rate is not simply the bias: the scatter of its fifths says how far to
believe it, against what such sensors have at all. Each further still window before the first step
sharpens it.
"""

from __future__ import annotations

import math

from app.compiled import part
from app.estimator.detectors import WALKING
from app.estimator.kalman_state import GYRO_AT, PARTS, KalmanState
from app.estimator.state import LEVEL_FOUND, RESTING, SHORTEST_REST_S
from app.motion.basics import Vector

#: Still is a statistic below this; after so many seconds without level it doubles every second.
STILL, PATIENCE_S = 30.0, 2.0
#: σ of a gyro's bias before anything is known of it, and the least doubt left after a window, rad/s.
PRIOR_RADPS, LEAST_DOUBT_RADPS = 0.004, 3e-4
#: While walking the filter may turn the bias no faster than this doubt lets it: the errors of a swing
#: (scale, clipping) would else be taken for bias.
MOST_DOUBT_RADPS = 4e-4
FIFTHS = 5


@part
def begin_window(state: KalmanState) -> None:
    """The window is empty; the next sample is its first."""
    state.window_n, state.window_statistic, state.window_norm = 0.0, 0.0, 0.0
    state.window_f0, state.window_f1, state.window_f2 = 0.0, 0.0, 0.0
    state.window_m0, state.window_m1, state.window_m2 = 0.0, 0.0, 0.0
    state.fifth_n, state.fifths = 0.0, 0.0
    for k in range(3):
        state.fifth[k], state.fifth_sum[k], state.fifth_squares[k] = 0.0, 0.0, 0.0
        state.fifth_rate2[k], state.fifth_white[k] = 0.0, 0.0


@part
def begin_bias(state: KalmanState) -> None:
    """What is known of the gyro bias before any window: it is about zero, or what was remembered."""
    for k in range(3):
        state.bias_info[k] = 1.0 / PRIOR_RADPS**2 + state.known_info[k]
        state.bias_sum[k] = state.known_info[k] * state.known_bias[k]


@part
def add_to_window(state: KalmanState, field_b: Vector) -> float:
    """The newest sample into the window; returns how long it is, s."""
    if state.window_n == 0.0:
        state.window_ns = state.elapsed_ns
        state.fifth_ns = state.elapsed_ns
    if state.elapsed_ns - state.fifth_ns >= state.still_window_s / FIFTHS * 1e9 - 1e3:
        end_fifth(state)
    state.window_n += 1.0
    state.window_statistic += state.statistic
    state.window_norm += math.sqrt(state.f0**2 + state.f1**2 + state.f2**2)
    state.window_f0 += state.f0
    state.window_f1 += state.f1
    state.window_f2 += state.f2
    state.window_m0, state.window_m1, state.window_m2 = (
        state.window_m0 + field_b[0],
        state.window_m1 + field_b[1],
        state.window_m2 + field_b[2],
    )
    state.fifth_n += 1.0
    rates = (state.w0, state.w1, state.w2)
    for k in range(3):
        state.fifth[k] += rates[k]
        state.fifth_rate2[k] += rates[k] * rates[k]
    return (state.elapsed_ns - state.window_ns) * 1e-9


@part
def end_fifth(state: KalmanState) -> None:
    """One fifth's mean rate is known."""
    for k in range(3):
        mean = state.fifth[k] / state.fifth_n
        state.fifth_sum[k] += mean
        state.fifth_squares[k] += mean * mean
        state.fifth_white[k] += max(state.fifth_rate2[k] / state.fifth_n - mean * mean, 0.0) / state.fifth_n
        state.fifth[k], state.fifth_rate2[k] = 0.0, 0.0
    state.fifths += 1.0
    state.fifth_n = 0.0
    state.fifth_ns = state.elapsed_ns


@part
def find_level(state: KalmanState, field_b: Vector) -> int:
    """One sample of the search for level: ``RESTING`` goes on, ``LEVEL_FOUND`` ends it.

    Both at once: this sample completed the window. ``LEVEL_FOUND`` alone: this sample already moves,
    and the rest before it was long enough.
    """
    waited_s = (state.elapsed_ns - state.quiet_ns) * 1e-9 - PATIENCE_S
    if state.statistic > STILL * 2.0 ** min(max(waited_s, 0.0), 8.0):
        if state.window_n > 1.0 and (state.elapsed_ns - state.window_ns) * 1e-9 >= SHORTEST_REST_S:
            return LEVEL_FOUND
        begin_window(state)
        return RESTING
    whole = add_to_window(state, field_b) >= state.still_window_s - 1e-4
    return RESTING | LEVEL_FOUND if whole else RESTING


@part
def keep_standing(state: KalmanState, energy: float, field_b: Vector) -> None:
    """Before the first step each further still window sharpens the bias."""
    if energy > WALKING:
        state.standing = 0.0
    elif state.statistic > STILL:
        begin_window(state)
    elif add_to_window(state, field_b) >= state.still_window_s - 1e-4:
        learn_bias(state)


@part
def learn_bias(state: KalmanState) -> None:
    """A whole still window: its mean rate, with its doubt, beside what was known; then a new window."""
    if state.fifth_n > 0.0 and state.fifths < FIFTHS:
        end_fifth(state)
    whole = state.bias_from_rest != 0.0 and state.fifths >= FIFTHS
    for k in range(3):
        if whole:
            mean = state.fifth_sum[k] / state.fifths
            scatter = state.fifth_squares[k] / state.fifths - mean * mean
            white = state.fifth_white[k] / state.fifths  # independent noise averages out, swaying does not
            variance = white / state.fifths + max(scatter - 2.0 * white, 0.0)
            info = 1.0 / max(variance, LEAST_DOUBT_RADPS**2)
            state.bias_info[k] += info
            state.bias_sum[k] += info * mean
        state.gyro_bias[k] = state.bias_sum[k] / state.bias_info[k]
        doubt_bias(state, k, state.bias_info[k])
    state.learnt = 1.0
    begin_window(state)


@part
def doubt_bias(state: KalmanState, axis: int, info: float) -> None:
    """The bias' doubt into P, free of what it had to do with other errors."""
    part = GYRO_AT + axis
    for j in range(PARTS):
        state.P[part, j], state.P[j, part] = 0.0, 0.0
    state.P[part, part] = min(1.0 / info, MOST_DOUBT_RADPS**2)
