"""Heart: an error-state Kalman filter with zero-velocity updates, one sample at a time. Read ``step``.

After E. Foxlin, "Pedestrian Tracking with Shoe-Mounted Inertial Sensors", IEEE CG&A 25(6), 2005, and
J.-O. Nilsson, I. Skog, P. Händel, K. Hari, "Foot-mounted INS for everybody", IEEE/ION PLANS 2012.
Other than there: the update is soft (its noise follows the detector's statistic), its place in time is
the middle of the detector's window, and the velocity of a standing foot is that of one that rolls.
"""

from __future__ import annotations

from app.compiled import part
from app.estimator import state as s
from app.estimator.attitude import fqa_tilt, fqa_yaw
from app.estimator.clipping import mind_clipping
from app.estimator.covariance import add_variance, measure, propagate
from app.estimator.detectors import (
    MOVES,
    NEARLY,
    STANDS,
    forget_gait,
    remember,
    remember_gait,
    stands,
    window_statistic,
)
from app.estimator.floor import begin_floor
from app.estimator.footfalls import end_footfalls, footfall, note_contact, stand
from app.estimator.gait import STANCE
from app.estimator.jolts import doubt_jolts, forget_jolts, mind_jolts
from app.estimator.kalman_state import (
    ATTITUDE_AT,
    FORCE_AT,
    GYRO_AT,
    HEIGHT_AT,
    PARTS,
    RING,
    RING_GAIN,
    RING_NS,
    RING_P,
    RING_Q,
    RING_ROLL,
    VELOCITY_AT,
    KalmanState,
)
from app.estimator.north import begin_look, forget_field, look_at_field
from app.estimator.papers import Reading
from app.estimator.standing import begin_bias, begin_window, find_level, keep_standing, learn_bias
from app.estimator.taking import begin_shift, forget_measurements, take_shift
from app.motion.basics import Vector
from app.rotation import exponential, from_yaw, multiply, normalise, rotate, yaw_of

#: Noise of the specific force and of the rate, as they are integrated: (m/s)/√s and rad/√s.
FORCE_NOISE, RATE_NOISE = 0.05, 5e-4
#: … and of a rate that is large: what scale and alignment leave wrong grows with it (a share of it, √s).
RATE_SHARE = 2e-4
#: What happens between two samples is not seen: σ of a velocity as a share of the force's jump times Δt.
JUMP_NOISE = 0.2
#: A foot does not roll just as it is thought to: σ of its height, m/√s for each rad/s of its rate.
PIVOT_NOISE = 0.01
#: How the biases wander: (m/s²)/√s and (rad/s)/√s.
FORCE_WANDER, RATE_WANDER = 1e-4, 1e-6
#: σ at the start: tilt and heading, rad, and the accelerometer's bias, m/s².
TILT_DOUBT, YAW_DOUBT, FORCE_DOUBT = 0.02, 1e-4, 0.05
#: σ² of a zero velocity is the first squared plus the second squared times the statistic, m/s.
STANCE_NOISE, STATISTIC_NOISE = 0.01, 0.008
#: A zero velocity holds in the middle of the window it was seen in, this long ago.
SEEN_LATE_NS = 20_100_000
#: Of a stance that is loud but may be one: the speed the foot may have by its own account, m/s.
NEARLY_AT_REST = 0.5
#: χ² of three parts up to which the best of the starved is believed, until it starved for too long, s.
MOST_MISFIT, GIVEN_UP_S = 30.0, 3.0
#: How much the newest swing says of how well swings and stances fit; one alone is not enough for "lost".
UNFIT_SHARE, WORST_MISFIT = 0.25, 60.0
#: After a gap the foot may be anywhere it could walk to, m/s.
GAP_SPEED = 1.0


@part
def step(state: KalmanState, reading: Reading) -> int:
    """One sample on. Returns what happened, a sum of the codes in ``state.py``. Time must go forward."""
    force_before, rate_before = (state.f0, state.f1, state.f2), (state.w0, state.w1, state.w2)
    happened, dt_s = receive(state, reading)
    forget_measurements(state)
    place = remember(state)
    state.statistic_before = state.statistic
    state.statistic, rate2 = window_statistic(state)
    energy, least = remember_gait(state)
    if state.told != 0.0:
        energy, least = state.told_energy, state.told_least
    if state.levelled == 0.0:
        happened |= find_level(state, reading.field_b)
        level(state)
        if happened & s.LEVEL_FOUND:
            begin_walk(state)
    if happened & s.RESTING:
        stand(state)
    else:
        predict(state, force_before, rate_before, dt_s)
        mind_clipping(state, rate_before, dt_s)
        mind_jolts(state, force_before, dt_s)
        note_motion(state, place)
        answer = stands(state, energy, least, rate2, dt_s)
        stood = answer != MOVES and is_confirmed(state, answer)
        if stood:
            if note_contact(state):
                doubt_swing(state)
                doubt_jolts(state)
                begin_look(state)
            zero_velocity(state)
            look_at_field(state, reading.field_b)
        happened |= footfall(state, stood)
        if state.standing != 0.0:
            keep_standing(state, energy, reading.field_b)
    note_corrections(state, place)
    state.row += 1.0
    return happened


@part
def receive(state: KalmanState, reading: Reading) -> tuple[int, float]:
    """The sample into the state; a gap in time ends the segment. Returns that, and seconds since the last."""
    happened = 0
    dt_s = (reading.elapsed_ns - state.elapsed_ns) * 1e-9
    if state.started == 0.0:
        state.started, dt_s = 1.0, 0.0
        state.elapsed_ns = reading.elapsed_ns
        begin_bias(state)
        add_variance(state.P, FORCE_AT, FORCE_DOUBT**2)
        state.P[8, 8] = YAW_DOUBT**2
        begin_segment(state)
    elif dt_s > s.GAP_S:
        happened = s.SEGMENT | end_footfalls(state)
        add_variance(state.P, 0, (GAP_SPEED * dt_s) ** 2)
        state.heading = yaw_of((state.q0, state.q1, state.q2, state.q3))
        state.elapsed_ns, dt_s = reading.elapsed_ns, 0.0
        begin_segment(state)
    state.elapsed_ns = reading.elapsed_ns
    state.f0, state.f1, state.f2 = reading.force_b
    state.w0, state.w1, state.w2 = reading.rate_b
    return happened, dt_s


@part
def begin_segment(state: KalmanState) -> None:
    """Level is unknown from here on and nothing is integrated; the foot stays where it was."""
    state.levelled, state.standing, state.phase = 0.0, 0.0, STANCE
    state.vx, state.vy, state.vz = 0.0, 0.0, 0.0
    state.contrary_s = 0.0
    forget_gait(state)
    forget_field(state)
    begin_window(state)
    for axis in range(3):
        state.clip[axis, 0] = 0.0
    forget_jolts(state)


@part
def level(state: KalmanState) -> None:
    """Tilt by FQA on the means of the still window so far, (3.17)–(3.22), and the heading there was."""
    if state.window_n == 0.0:
        return
    tilt = fqa_tilt((state.window_f0, state.window_f1, state.window_f2))
    yaw = from_yaw(state.heading)
    if state.magnetometer != 0.0:
        north = fqa_yaw(tilt, (state.window_m0, state.window_m1, state.window_m2), state.north_rad)
        if north[0] != 0.0 or north[3] != 0.0:
            yaw = north
    state.q0, state.q1, state.q2, state.q3 = multiply(yaw, tilt)


@part
def begin_walk(state: KalmanState) -> None:
    """Level is found: gravity, a first bias, and doubts by how still the window was."""
    restless = state.window_statistic / state.window_n
    state.gravity = state.gravity_mps2
    if state.gravity == 0.0:
        state.gravity = state.window_norm / state.window_n
    for i in range(PARTS):
        for j in range(PARTS):
            if i != j:
                state.P[i, j] = 0.0
    for k in range(3):
        state.P[VELOCITY_AT + k, VELOCITY_AT + k] = STANCE_NOISE**2 + STATISTIC_NOISE**2 * restless
    for k in range(2):  # what disturbed the window leans on its mean force
        state.P[6 + k, 6 + k] = TILT_DOUBT**2 + 0.01 * restless / state.gravity**2
    begin_floor(state)
    learn_bias(state)
    state.levelled, state.standing = 1.0, 1.0
    state.quiet_ns = state.elapsed_ns


@part
def predict(state: KalmanState, force_before_b: Vector, rate_before_b: Vector, dt_s: float) -> None:
    """Strapdown: the mean of both samples, turned at the half step; then P."""
    bias = state.gyro_bias
    before_b = (rate_before_b[0] - bias[0], rate_before_b[1] - bias[1], rate_before_b[2] - bias[2])
    after_b = (state.w0 - bias[0], state.w1 - bias[1], state.w2 - bias[2])
    force_b = (
        0.5 * (force_before_b[0] + state.f0) - state.force_bias[0],
        0.5 * (force_before_b[1] + state.f1) - state.force_bias[1],
        0.5 * (force_before_b[2] + state.f2) - state.force_bias[2],
    )
    half_turn = exponential(half_turn_between(before_b, after_b, dt_s))
    q_half = multiply((state.q0, state.q1, state.q2, state.q3), half_turn)
    state.q0, state.q1, state.q2, state.q3 = normalise(multiply(q_half, half_turn))
    force_n = rotate(q_half, force_b)
    gained = (force_n[0] * dt_s, force_n[1] * dt_s, (force_n[2] + state.gravity) * dt_s)
    state.px += (state.vx + 0.5 * gained[0]) * dt_s
    state.py += (state.vy + 0.5 * gained[1]) * dt_s
    state.pz += (state.vz + 0.5 * gained[2]) * dt_s
    state.vx, state.vy, state.vz = state.vx + gained[0], state.vy + gained[1], state.vz + gained[2]
    state.gained_x, state.gained_y = state.gained_x + gained[0], state.gained_y + gained[1]
    state.gained_z += gained[2]
    state.dt_s = dt_s
    state.half0, state.half1, state.half2, state.half3 = q_half
    state.push_x, state.push_y, state.push_z = force_n
    propagate(state.P, q_half, force_n, dt_s)
    jump2 = (state.f0 - force_before_b[0]) ** 2 + (state.f1 - force_before_b[1]) ** 2
    jump2 += (state.f2 - force_before_b[2]) ** 2
    add_variance(state.P, VELOCITY_AT, FORCE_NOISE**2 * dt_s + jump2 * (JUMP_NOISE * dt_s) ** 2)
    rate2 = state.w0 * state.w0 + state.w1 * state.w1 + state.w2 * state.w2
    add_variance(state.P, ATTITUDE_AT, (RATE_NOISE**2 + rate2 * RATE_SHARE**2) * dt_s)
    state.P[HEIGHT_AT, HEIGHT_AT] += rate2 * PIVOT_NOISE**2 * dt_s
    add_variance(state.P, GYRO_AT, RATE_WANDER**2 * dt_s)
    add_variance(state.P, FORCE_AT, FORCE_WANDER**2 * dt_s)


@part
def half_turn_between(before_b: Vector, after_b: Vector, dt_s: float) -> Vector:
    """Half of the turn between two samples, of a rate that changes evenly: its mean, and what comes of its
    axis turning meanwhile, Δt²/12 of ω × ω′ (W. Magnus' series, 1954; known as coning)."""
    x, y, z = before_b
    u, v, w = after_b
    mean, cone = 0.25 * dt_s, dt_s * dt_s / 24.0
    return (
        mean * (x + u) + cone * (y * w - z * v),
        mean * (y + v) + cone * (z * u - x * w),
        mean * (z + w) + cone * (x * v - y * u),
    )


@part
def note_motion(state: KalmanState, place: int) -> None:
    """What a zero velocity seen a little later will be held against: the velocity gained since, and the
    velocity a foot has that stands but rolls over its sole: ω × the sensor's height."""
    q = (state.q0, state.q1, state.q2, state.q3)
    rate = (state.w0 - state.gyro_bias[0], state.w1 - state.gyro_bias[1], state.w2 - state.gyro_bias[2])
    rate_n = rotate(q, rate)
    state.ring[place, RING_ROLL] = -state.sensor_height_m * rate_n[1]
    state.ring[place, RING_ROLL + 1] = state.sensor_height_m * rate_n[0]
    state.ring[place, RING_GAIN] = state.gained_x
    state.ring[place, RING_GAIN + 1] = state.gained_y
    state.ring[place, RING_GAIN + 2] = state.gained_z


@part
def seen_at(state: KalmanState) -> int:
    """The place in the ring of the oldest sample of this segment within ``SEEN_LATE_NS``."""
    newest = int(state.ring_at)
    place = newest
    for back in range(1, int(state.ring_n)):
        i = (newest - back) % RING
        if state.elapsed_ns - state.ring[i, RING_NS] > SEEN_LATE_NS:
            break
        place = i
    return place


@part
def is_confirmed(state: KalmanState, answer: int) -> bool:
    """How far the foot is from standing by its own account, into ``aways``; whether that fits the answer."""
    i = seen_at(state)
    variance = stance_variance(state)
    velocity = (state.vx - state.gained_x, state.vy - state.gained_y, state.vz - state.gained_z)
    speed2, state.misfit = 0.0, 0.0
    for k in range(3):
        roll = state.ring[i, RING_ROLL + k] if k < 2 else 0.0
        state.aways[k] = roll - velocity[k] - state.ring[i, RING_GAIN + k]
        away2 = state.aways[k] * state.aways[k]
        speed2 += away2
        state.misfit += away2 / (state.P[VELOCITY_AT + k, VELOCITY_AT + k] + variance)
    if answer == NEARLY:
        return speed2 < NEARLY_AT_REST**2
    hungry_s = (state.elapsed_ns - state.quiet_ns) * 1e-9
    return answer == STANDS or state.misfit < MOST_MISFIT or hungry_s > GIVEN_UP_S


@part
def doubt_swing(state: KalmanState) -> None:
    """At a contact: how well the swing before fits the stance, over some swings; what P leaves out."""
    state.unfit += UNFIT_SHARE * (min(state.misfit, WORST_MISFIT) - state.unfit)
    if state.misfit > MOST_MISFIT:
        away2 = state.aways[0] ** 2 + state.aways[1] ** 2
        state.unknown_m2 += away2 * (0.5e-9 * (state.elapsed_ns - state.lift_ns)) ** 2


@part
def stance_variance(state: KalmanState) -> float:
    """σ² of a zero velocity: a poor stance says little."""
    return STANCE_NOISE**2 + STATISTIC_NOISE**2 * state.statistic


@part
def zero_velocity(state: KalmanState) -> None:
    """The foot stood in the middle of the window: three scalar measurements of its velocity then."""
    variance = stance_variance(state)
    begin_shift(state)
    for k in range(3):
        state.totals[k], state.lefts[k] = measure(
            state.P, state.shift, state.gains[k], VELOCITY_AT + k, -1, state.aways[k], variance
        )
    take_shift(state)


@part
def note_corrections(state: KalmanState, place: int) -> None:
    """Corrections up to this row, so that those still to come can be given to it."""
    state.ring[place, RING_P] = state.corrected_x
    state.ring[place, RING_P + 1] = state.corrected_y
    state.ring[place, RING_P + 2] = state.corrected_z
    state.ring[place, RING_Q] = state.turned_x
    state.ring[place, RING_Q + 1] = state.turned_y
    state.ring[place, RING_Q + 2] = state.turned_z
