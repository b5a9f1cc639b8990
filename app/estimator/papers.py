"""Heart: the foot-motion algorithm of the papers, one sample at a time. Read ``step``: it is the method.

Yun, Calusdian, Bachmann, McGhee, "Estimation of Human Foot Motion During Normal Walking Using
Inertial and Magnetic Sensor Measurements", IEEE TIM 61(7), 2012; its Fig. 2 is the block diagram.
``observe`` is all that the gains do not touch (level, gait phase), ``navigate`` all that they do: so
a sweep over gains does the first once and the second side by side, in the very same arithmetic.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from app.compiled import part
from app.estimator import state as s
from app.estimator.attitude import complementary, fqa_tilt, fqa_yaw, share_of, turn_between
from app.estimator.gait import STANCE, SWING, gait_phase
from app.estimator.rest import begin_rest, rest
from app.estimator.state import Nav, State
from app.estimator.strapdown import bias_of_swing, motion_acceleration, trapezoid, without_bias
from app.motion.basics import Floats, Quaternion, Vector
from app.rotation import from_yaw, multiply, yaw_of


class Reading(NamedTuple):
    """One sample as the step reads it."""

    elapsed_ns: float
    force_b: Vector  # m/s²
    rate_b: Vector  # rad/s
    field_b: Vector  # NaN: no magnetometer


@part
def reading_at(samples: Floats, i: int) -> Reading:
    """Row ``i`` of a sample table [n, 10]."""
    return Reading(
        samples[i, 0],
        (samples[i, 1], samples[i, 2], samples[i, 3]),
        (samples[i, 4], samples[i, 5], samples[i, 6]),
        (samples[i, 7], samples[i, 8], samples[i, 9]),
    )


class Aiding(NamedTuple):
    """What one sample brings to the orientation, the same for every gain."""

    turn: Quaternion  # from the angular rate
    tilt: Quaternion  # from the specific force
    yaw: Quaternion  # from the magnetic field; zero: none


@part
def step(state: State, reading: Reading) -> int:
    """One sample on. Returns what happened, a sum of the codes in ``state.py``. Time must go forward."""
    force_before, rate_before = (state.fx, state.fy, state.fz), (state.wx, state.wy, state.wz)
    happened, dt_s = observe(state, reading)  # level; gait phase, Figs. 5 and 6
    if happened & s.SEGMENT:
        leave_segment(state, state, happened)
    if happened & (s.RESTING | s.LEVEL_FOUND):
        level(state, state)
    if not happened & s.RESTING:
        aiding = aid(state, reading, rate_before, dt_s)
        gain = state.gain_stance if state.phase == STANCE else state.gain_swing
        navigate(state, state, happened, aiding, share_of(gain, dt_s), force_before, dt_s)
    state.row += 1.0
    return happened


@part
def observe(state: State, reading: Reading) -> tuple[int, float]:
    """What the gains do not touch: time, level, and the gait phase with its edges.

    Returns what happened and the seconds since the last sample.
    """
    happened = 0
    dt_s = (reading.elapsed_ns - state.elapsed_ns) * 1e-9
    if state.row == 0.0:
        dt_s = 0.0
    elif dt_s > s.GAP_S:
        happened = end_segment(state)
        dt_s = 0.0  # the first sample of a segment, as of the walk: the gap is no time of rest
    state.elapsed_ns = reading.elapsed_ns
    state.fx, state.fy, state.fz = reading.force_b
    state.wx = reading.rate_b[0] - state.bias_x
    state.wy = reading.rate_b[1] - state.bias_y
    state.wz = reading.rate_b[2] - state.bias_z
    state.statistic = math.sqrt(state.wx * state.wx + state.wy * state.wy + state.wz * state.wz)
    if state.levelled == 0.0:
        happened |= rest(state, reading, dt_s)
    if not happened & s.RESTING:
        happened |= find_edges(state, dt_s)
    return happened, dt_s


@part
def find_edges(state: State, dt_s: float) -> int:
    """The gait machine, and where a swing began and ends.

    The machine sees a transition Γ late. So integration starts, on trial, at the last quiet sample
    before any contrary one, and the first quiet sample of a swing is remembered as its possible
    end: the papers' two FIFOs (2012 paper, II-D) without guessing their lengths.
    """
    was, was_contrary = state.phase, state.contrary_s > 0.0
    state.phase, state.contrary_s = gait_phase(
        was, state.contrary_s, state.statistic, state.stance_radps, state.min_duration_s, dt_s
    )
    turned = state.phase != was
    contrary = turned or state.contrary_s > 0.0
    happened = 0
    if was == STANCE and contrary and not was_contrary:
        happened |= s.LIFT
        state.lift_row = state.row - 1.0
        state.lift_ns = state.elapsed_ns - round(dt_s * 1e9)
        state.swing_s = 0.0
    if was == STANCE and was_contrary and not contrary:
        happened |= s.FLICKER
    if was == STANCE and turned:
        happened |= s.SWING_FOUND
    if was == SWING or contrary:
        happened |= s.MOVING
        state.swing_s += dt_s
    if was == SWING and contrary and not was_contrary:
        happened |= s.MAYBE_END
        state.end_row = state.row
        state.end_swing_s = state.swing_s
    if was == SWING and turned:
        happened |= s.STRIDE
    return happened


@part
def aid(state: State, reading: Reading, rate_before_b: Vector, dt_s: float) -> Aiding:
    """The static quaternion's parts by FQA, and the turn since the last sample."""
    turn = turn_between(rate_before_b, (state.wx, state.wy, state.wz), dt_s)
    tilt = fqa_tilt(reading.force_b)
    return Aiding(turn, tilt, measured_yaw(state, tilt, reading.field_b))


@part
def navigate(
    nav: Nav, state: State, happened: int, aiding: Aiding, share: float, force_before_b: Vector, dt_s: float
) -> None:
    """What the gains change: orientation, (2); motion acceleration, (5), (6); velocity, (7); position."""
    q_before = (nav.q0, nav.q1, nav.q2, nav.q3)
    q = complementary(q_before, aiding.turn, aiding.tilt, aiding.yaw, share)
    nav.q0, nav.q1, nav.q2, nav.q3 = q
    if happened & s.LIFT:
        nav.ax, nav.ay, nav.az = motion_acceleration(q_before, force_before_b, state.gravity)
    if happened & s.MOVING:
        before = (nav.ax, nav.ay, nav.az)
        velocity_before = (nav.vx, nav.vy, nav.vz)
        acceleration = motion_acceleration(q, (state.fx, state.fy, state.fz), state.gravity)
        velocity = trapezoid(velocity_before, before, acceleration, dt_s)
        nav.ax, nav.ay, nav.az = acceleration
        nav.vx, nav.vy, nav.vz = velocity
        nav.sx, nav.sy, nav.sz = trapezoid((nav.sx, nav.sy, nav.sz), velocity_before, velocity, dt_s)
    if happened & s.MAYBE_END:
        nav.end_vx, nav.end_vy, nav.end_vz = nav.vx, nav.vy, nav.vz
        nav.end_sx, nav.end_sy, nav.end_sz = nav.sx, nav.sy, nav.sz
    if happened & s.STRIDE:
        zero_velocity_update(nav, state)
    if happened & (s.FLICKER | s.STRIDE):
        stand(nav)


@part
def zero_velocity_update(nav: Nav, state: State) -> None:
    """(8)–(10): the velocity left at the end of a swing is ε·T; take ε out of the whole swing."""
    nav.from_x, nav.from_y, nav.from_z = nav.px, nav.py, nav.pz
    raw = (nav.px + nav.end_sx, nav.py + nav.end_sy, nav.pz + nav.end_sz)
    bias = bias_of_swing((nav.end_vx, nav.end_vy, nav.end_vz), state.end_swing_s)
    nav.px, nav.py, nav.pz = without_bias(raw, bias, state.end_swing_s)


@part
def stand(nav: Nav) -> None:
    """The foot stands: no velocity, no travel."""
    nav.vx, nav.vy, nav.vz = 0.0, 0.0, 0.0
    nav.sx, nav.sy, nav.sz = 0.0, 0.0, 0.0


@part
def end_segment(state: State) -> int:
    """A gap in time: what was under way ends here, and level is sought anew."""
    happened = s.SEGMENT
    if state.contrary_s > 0.0:
        happened |= s.FLICKER if state.phase == STANCE else s.STRIDE
    begin_rest(state)
    return happened


@part
def leave_segment(nav: Nav, state: State, happened: int) -> None:
    """Position stays where the segment left it (a swing cut short keeps its travel), heading too."""
    if happened & s.STRIDE:
        zero_velocity_update(nav, state)
    elif not happened & s.FLICKER:
        nav.px, nav.py, nav.pz = nav.px + nav.sx, nav.py + nav.sy, nav.pz + nav.sz
    stand(nav)
    nav.heading = yaw_of((nav.q0, nav.q1, nav.q2, nav.q3))


@part
def level(nav: Nav, state: State) -> None:
    """FQA on the means of the still window so far; nothing before its first sample."""
    if state.rest_n == 0.0:
        return
    tilt = fqa_tilt((state.rest_fx, state.rest_fy, state.rest_fz))
    yaw = measured_yaw(state, tilt, (state.rest_mx, state.rest_my, state.rest_mz))
    if yaw[0] == 0.0 and yaw[3] == 0.0:
        yaw = from_yaw(nav.heading)
    nav.q0, nav.q1, nav.q2, nav.q3 = multiply(yaw, tilt)


@part
def measured_yaw(state: State, tilt: Quaternion, field_b: Vector) -> Quaternion:
    """The FQA's yaw, or the zero quaternion where the magnetometer is off or missing."""
    if state.magnetometer == 0.0:
        return (0.0, 0.0, 0.0, 0.0)
    return fqa_yaw(tilt, field_b, state.north_rad)
