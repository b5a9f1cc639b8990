"""Heart: the Kalman filter's heading, held by magnetic north where the field is steady, and only there.

At each footprint the field's direction in *n* is a look at the heading; the direction of north itself is
a part of the error state, which begins as the heading's own error (stochastic cloning), so that a heading
is never set, only kept. What a magnetometer's calibration leaves wrong is the same at neighbouring
footprints: each counts for little.
"""

from __future__ import annotations

from app.compiled import part
from app.estimator.compass import (
    DIP_RAD,
    DIRECTION_STRAYS,
    ELSEWHERE,
    FOOTPRINTS,
    OPEN,
    STEADY,
    STRENGTH,
    apart,
    field_of,
    judge,
    middle_of,
    told,
)
from app.estimator.covariance import add_variance_along, copy_part, measure
from app.estimator.kalman_state import GYRO_AT, NORTH_AT, NORTH_MEASURE, YAW_AT, KalmanState
from app.estimator.state import Record
from app.estimator.taking import begin_shift, take_shift
from app.motion.basics import Vector
from app.motion.estimate import Compass
from app.rotation import conjugate, rotate

#: σ of one footprint's look at north, rad: 4° that eight of them have in common.
LOOK_NOISE = 0.2
#: A look so many σ away is not believed …
MOST_SIGMAS = 2.0
#: … until so many in a row were: no iron bends a field alike for so long and leaves its strength and dip.
CONTRARY = 100


@part
def look_at_field(state: KalmanState, field_b: Vector) -> None:
    """The foot stands: the field of this sample, in *n*, to those of the footprint."""
    if field_b[0] != field_b[0]:  # NaN: no magnetometer
        return
    x, y, z = rotate((state.q0, state.q1, state.q2, state.q3), field_b)
    state.field_x, state.field_y, state.field_z = state.field_x + x, state.field_y + y, state.field_z + z
    state.field_n += 1.0


@part
def forget_field(state: KalmanState) -> None:
    """A new segment: what the gyro kept before says nothing of after."""
    state.looks_n, state.north_known, state.verdict = 0.0, 0.0, OPEN
    begin_look(state)


@part
def begin_look(state: KalmanState) -> None:
    """A new footprint."""
    state.field_x, state.field_y, state.field_z, state.field_n = 0.0, 0.0, 0.0, 0.0


@part
def hold_heading(state: KalmanState) -> None:
    """A swing is over: this footprint's look beside the last ones; the heading by it, if all is steady."""
    if state.field_n == 0.0:
        return
    x, y, z = state.field_x / state.field_n, state.field_y / state.field_n, state.field_z / state.field_n
    place = int(state.looks_n) % FOOTPRINTS
    state.looks[place, 0], state.looks[place, 1], state.looks[place, 2] = x, y, z
    state.looks[place, 3], state.looks[place, 4] = state.px, state.py
    state.looks_n += 1.0
    if state.looks_n < FOOTPRINTS:
        return
    state.verdict, state.strays = judge(state.looks)
    if state.verdict != STEADY or state.steady_north == 0.0:
        state.contrary_n = 0.0
        return
    if state.north_known == 0.0:
        begin_north(state)
    else:
        keep_north(state, field_of(x, y, z))


@part
def begin_north(state: KalmanState) -> None:
    """North is where the steady field of the last footprints points."""
    state.north_strength, state.north_dip, state.north_at_rad = middle_of(state.looks)
    state.north_known = 1.0
    state.contrary_n, state.agreed_ns = 0.0, state.elapsed_ns
    state.north_began = 1.0
    copy_part(state.P, YAW_AT, NORTH_AT)
    state.P[NORTH_AT, NORTH_AT] += LOOK_NOISE * LOOK_NOISE / FOOTPRINTS


@part
def keep_north(state: KalmanState, field: Vector) -> None:
    """One look: the heading's error less north's, if this is the field it was and its direction is likely."""
    strength, dip, direction = field
    if abs(strength / state.north_strength - 1.0) > STRENGTH or abs(dip - state.north_dip) > DIP_RAD:
        state.verdict = ELSEWHERE
        return
    away = apart(state.north_at_rad, direction)
    P, variance = state.P, LOOK_NOISE * LOOK_NOISE
    total = P[YAW_AT, YAW_AT] - 2.0 * P[YAW_AT, NORTH_AT] + P[NORTH_AT, NORTH_AT] + variance / FOOTPRINTS
    if away * away > MOST_SIGMAS * MOST_SIGMAS * total:
        state.contrary_n += 1.0
        if state.contrary_n < CONTRARY:
            state.verdict, state.strays = DIRECTION_STRAYS, abs(away)
            return
        doubt_heading(state, away)
    state.contrary_n, state.agreed_ns = 0.0, state.elapsed_ns
    begin_shift(state)
    state.totals[NORTH_MEASURE], state.lefts[NORTH_MEASURE] = measure(
        P, state.shift, state.gains[NORTH_MEASURE], YAW_AT, NORTH_AT, away, variance
    )
    take_shift(state)


@part
def doubt_heading(state: KalmanState, away: float) -> None:
    """The gyro has drifted beyond its account: so far, and as fast, since the field last agreed."""
    state.P[YAW_AT, YAW_AT] += away * away
    fast = away / max(1e-9 * (state.elapsed_ns - state.agreed_ns), 1.0)
    down_b = rotate(conjugate((state.q0, state.q1, state.q2, state.q3)), (0.0, 0.0, 1.0))
    add_variance_along(state.P, GYRO_AT, down_b, fast * fast)


def compass_of(record: Record) -> Compass | None:
    """Whether the field could be believed at the last footprint, and whether the heading is held by it."""
    state = record[0]
    holds = bool(state["steady_north"]) and bool(state["north_known"])
    return told(int(state["verdict"]), float(state["strays"]), holds)
