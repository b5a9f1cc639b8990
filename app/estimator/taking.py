"""Heart: what a measurement found goes into the Kalman filter's estimate."""

from __future__ import annotations

from app.compiled import part
from app.estimator.kalman_state import FLOOR_AT, FORCE_AT, GYRO_AT, MEASURES, NORTH_AT, PARTS, KalmanState
from app.rotation import exponential, multiply, normalise


@part
def forget_measurements(state: KalmanState) -> None:
    """A new step: it has measured nothing yet, and begun no floor and no north."""
    state.floor_began, state.north_began = 0.0, 0.0
    for k in range(MEASURES):
        state.totals[k] = 0.0


@part
def begin_shift(state: KalmanState) -> None:
    """An update begins: nothing is found yet."""
    for i in range(PARTS):
        state.shift[i] = 0.0


@part
def take_shift(state: KalmanState) -> None:
    """What an update found goes into the estimate, and into the sums for the rows behind."""
    d = state.shift
    state.px, state.py, state.pz = state.px + d[0], state.py + d[1], state.pz + d[2]
    state.vx, state.vy, state.vz = state.vx + d[3], state.vy + d[4], state.vz + d[5]
    turn = exponential((d[6], d[7], d[8]))
    q = (state.q0, state.q1, state.q2, state.q3)
    state.q0, state.q1, state.q2, state.q3 = normalise(multiply(turn, q))
    for k in range(3):
        state.gyro_bias[k] += d[GYRO_AT + k]
        state.force_bias[k] += d[FORCE_AT + k]
    state.floor_z += d[FLOOR_AT]
    state.north_at_rad += d[NORTH_AT]
    state.corrected_x, state.corrected_y = state.corrected_x + d[0], state.corrected_y + d[1]
    state.corrected_z += d[2]
    state.slowed_x, state.slowed_y = state.slowed_x + d[3], state.slowed_y + d[4]
    state.slowed_z += d[5]
    state.turned_x, state.turned_y = state.turned_x + d[6], state.turned_y + d[7]
    state.turned_z += d[8]
