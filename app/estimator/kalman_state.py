"""Heart: the flat state of the Kalman filter's step: one record, so that a copy is a checkpoint.

As in ``state.py`` the classes only name the fields; here some are small arrays. The error state has
17 parts in the order of ``P``: position, velocity, attitude (a turn in *n*), gyro bias, accelerometer bias,
the floor's height, and the direction of magnetic north.
"""

from __future__ import annotations

import math
from enum import IntEnum

import numpy as np

from app.estimator.compass import FOOTPRINTS, LOOK_WIDTH
from app.estimator.state import Record, dtype_of, turn_about_down
from app.motion.basics import Floats
from app.motion.samples import GyroBias
from app.settings import Settings

#: Samples that the trailing windows may hold: 50 ms at 2560 Hz.
RING = 128
#: Columns of ``ring``: when; specific force; |ω|²; velocity gained so far; velocity of a rolling foot;
#: corrections so far of position and attitude.
RING_NS, RING_F, RING_W2, RING_GAIN, RING_ROLL, RING_P, RING_Q = 0, 1, 4, 5, 8, 10, 13
RING_WIDTH = 16
#: The gait's recent past is kept in bins of 50 ms: |ω|² summed, samples, least statistic.
BINS = 32
BIN_NS = 50_000_000
#: σ by which a gyro's bias differs from what it was when the sensor was last switched on, rad/s.
TURN_ON_RADPS = 1e-3
#: Parts of the error state.
PARTS = 17
HEIGHT_AT, VELOCITY_AT, ATTITUDE_AT, YAW_AT, GYRO_AT, FORCE_AT, FLOOR_AT, NORTH_AT = 2, 3, 6, 8, 9, 12, 15, 16
#: Measurements of one step: three of a zero velocity, one of the floor's height, one of north.
MEASURES, FLOOR_MEASURE, NORTH_MEASURE = 5, 3, 4


class Detector(IntEnum):
    """Which zero-velocity detector, as a number the compiled step reads."""

    ADAPTIVE = 0
    SHOE = 1
    ARED = 2
    RATE = 3


class Parameters:
    """The settings as the compiled step reads them (units as in ``Settings``)."""

    detector: float
    gait_factor: float
    still_statistic: float
    threshold_radps: float
    min_duration_s: float
    sensor_height_m: float
    same_floor_m: float
    steady_north: float  # 0 or 1
    gyro_range_radps: float  # 0: found
    gravity_mps2: float  # 0: as read at rest
    bias_from_rest: float  # 0 or 1
    still_window_s: float
    north_rad: float
    magnetometer: float


class Window:
    """A still window under way: its sums, and those of its fifths, whose scatter shows swaying."""

    window_ns: float  # its first sample
    window_n: float
    window_f0: float
    window_f1: float
    window_f2: float
    window_norm: float
    window_statistic: float
    window_m0: float
    window_m1: float
    window_m2: float
    fifth_ns: float
    fifth_n: float
    fifths: float


class KalmanState(Parameters, Window):
    """All of it, but for the arrays, which ``KALMAN`` adds."""

    row: float  # number of the next row
    elapsed_ns: float  # of the last sample
    started: float  # 0 before the first sample
    levelled: float  # 0 while level is still being sought
    standing: float  # 1 until the first walking: still windows sharpen the gyro bias
    heading: float  # yaw to start the next segment with, rad
    gravity: float
    phase: float
    contrary_s: float  # of the detector RATE
    statistic: float  # T
    statistic_before: float  # of the sample before
    threshold: float  # what T had to stay below
    q0: float
    q1: float
    q2: float
    q3: float
    px: float
    py: float
    pz: float
    vx: float
    vy: float
    vz: float
    w0: float  # last sample
    w1: float
    w2: float
    f0: float
    f1: float
    f2: float
    ring_at: float  # place of the newest sample in the ring
    ring_n: float
    bin_at: float
    bin_ns: float  # where the newest bin begins
    quiet_ns: float  # the last zero velocity
    sure_ns: float  # the last that needed no confirmation
    top_radps: float  # the largest rate read
    flat_radps: float  # … where two in a row read it alike, in a range of 250 or 300 °/s; 0: nowhere
    gained_x: float  # velocity gained from the specific force since the segment began
    gained_y: float
    gained_z: float
    corrected_x: float  # position corrections so far
    corrected_y: float
    corrected_z: float
    turned_x: float  # attitude corrections so far
    turned_y: float
    turned_z: float
    moving: float  # 1 from a lift to the stride's correction
    lift_row: float
    lift_ns: float
    from_x: float  # position at the lift
    from_y: float
    from_z: float
    contact_row: float  # −1: none yet
    contact_ns: float
    contact_mps: float  # speed by the filter's own account, before its first zero velocity
    at_x: float  # position at the contact, less the corrections so far
    at_y: float
    at_z: float
    before_x: float  # corrections of position before the contact's first
    before_y: float
    before_z: float
    unturned_x: float  # corrections of attitude before the contact's first
    unturned_y: float
    unturned_z: float
    slowed_x: float  # velocity corrections since the contact
    slowed_y: float
    slowed_z: float
    done_lift_row: float  # the swing that was finished last
    done_lift_ns: float
    done_contact_row: float
    done_swing_s: float
    start_x: float
    start_y: float
    start_z: float
    misfit: float  # how far the last stance was from the velocity there, in the doubts about both: χ² of 3
    unfit: float  # … at the contacts of the last swings, on average
    unknown_m2: float  # σ² of the position beside P: what swings that did not fit may have gone wrong
    missed_mps: float  # velocity that an accelerometer at the end of its range may have missed in this swing,
    missed_at: float  # that times when, s since the lift,
    missed_at2: float  # and times when squared
    missed_m: float  # how far that may have moved all contacts so far, each the same way
    told: float  # 1: the gait around the sample is told (in hindsight), not remembered
    told_energy: float
    told_least: float
    learnt: float  # 1: a still window has just set the gyro bias
    dt_s: float  # of the last prediction, and what it turned and pushed by: for the smoother
    half0: float
    half1: float
    half2: float
    half3: float
    push_x: float
    push_y: float
    push_z: float
    floor_z: float  # height of the floor the foot is on: where it first stood there
    slope: float  # how the strides of late fell, beside the way they went
    floor_began: float  # 1: the last step began a new floor
    field_x: float  # the magnetic field in n, summed over the footprint under way
    field_y: float
    field_z: float
    field_n: float
    looks_n: float  # footprints whose field was seen in this segment
    verdict: float  # on the field at the last of them, as in ``compass.py`` …
    strays: float  # … and by how much it strays
    north_known: float  # 1: north was taken, where the field was steady: …
    north_began: float  # … (1: in the last step)
    north_at_rad: float  # its direction in n, its strength and dip
    contrary_n: float  # steady footprints in a row whose direction was not believed …
    agreed_ns: float  # … and when one last was
    north_strength: float
    north_dip: float
    P: Floats  # [17, 17]
    gyro_bias: Floats  # [3], rad/s
    force_bias: Floats  # [3], m/s²
    bias_info: Floats  # [3]: 1 / σ² of what still windows say of the gyro bias …
    bias_sum: Floats  # [3]: … and that times the bias
    known_bias: Floats  # [3], rad/s: what was remembered of this sensor …
    known_info: Floats  # [3]: … and 1 / σ² of it (0: nothing was)
    ring: Floats  # [RING, RING_WIDTH]
    bins: Floats  # [BINS, 3]
    fifth: Floats  # [3]: sums of the rate in the fifth under way, and of its squares
    fifth_rate2: Floats
    fifth_sum: Floats  # [3]: of the fifths' means, and of their squares
    fifth_squares: Floats
    fifth_white: Floats  # [3]: of the variances that independent samples would give those means
    clip: Floats  # [3, 3]: for each gyro axis: clipped samples in a row, slope on the way in, their seconds
    jolts: Floats  # [3, 8]: for each accelerometer axis the columns of ``jolts.py``
    gains: Floats  # [5, 17]: what each measurement of the last step saw of P,
    totals: Floats  # [5]: its variance and P's (0: there was none),
    lefts: Floats  # [5]: and how far it was away
    aways: Floats  # [3]: how far each part of the velocity was away before any
    looks: Floats  # [FOOTPRINTS, 5]: the field at the last footprints, and where that was
    shift: Floats  # [17]: what an update found


SHAPES: dict[str, tuple[int, ...]] = {
    "P": (PARTS, PARTS),
    "gyro_bias": (3,),
    "force_bias": (3,),
    "bias_info": (3,),
    "bias_sum": (3,),
    "known_bias": (3,),
    "known_info": (3,),
    "ring": (RING, RING_WIDTH),
    "bins": (BINS, 3),
    "fifth": (3,),
    "fifth_sum": (3,),
    "fifth_squares": (3,),
    "fifth_rate2": (3,),
    "fifth_white": (3,),
    "clip": (3, 3),
    "jolts": (3, 8),
    "gains": (MEASURES, PARTS),
    "totals": (MEASURES,),
    "lefts": (MEASURES,),
    "aways": (3,),
    "looks": (FOOTPRINTS, LOOK_WIDTH),
    "shift": (PARTS,),
}
KALMAN = np.dtype([(name, np.float64, SHAPES.get(name, ())) for name in dtype_of(KalmanState).names or ()])


_VECTORS = (
    "p", "v", "gained_", "corrected_", "turned_", "from_", "at_", "before_", "unturned_", "slowed_", "start_",
    "push_", "field_",
)  # fmt: skip


def new_state(settings: Settings, known: GyroBias | None = None) -> Record:
    """The state before the first sample: a record array of one. ``known`` is a gyro bias from before."""
    state = np.zeros(1, KALMAN)
    state["q0"] = 1.0
    state["contact_row"] = -1.0
    state["heading"] = settings.start_heading_rad
    set_parameters(state, settings)
    if known is not None and settings.remembered_bias:
        state["known_bias"] = known.rate_b
        state["known_info"] = 1.0 / (np.square(known.doubt_radps) + TURN_ON_RADPS**2)
    return state


def set_parameters(state: Record, settings: Settings) -> None:
    """Write the settings into a state."""
    state["detector"] = Detector[settings.detector.upper()]
    state["magnetometer"], state["steady_north"] = settings.magnetometer, settings.steady_north
    for name in ("gait_factor", "still_statistic", "threshold_radps", "min_duration_s"):
        state[name] = getattr(settings, name)
    state["sensor_height_m"], state["same_floor_m"] = settings.sensor_height_m, settings.same_floor_m
    state["gyro_range_radps"] = settings.gyro_range_radps
    state["gravity_mps2"] = 0.0 if settings.gravity_from_rest else settings.gravity_mps2
    state["bias_from_rest"] = settings.bias_from_rest
    state["still_window_s"] = settings.still_window_s
    state["north_rad"] = settings.start_heading_rad


def resume(state: Record, settings: Settings) -> None:
    """Give a state other settings; the start heading turns the walk so far about the start."""
    angle_rad = settings.start_heading_rad - float(state["north_rad"][0])
    set_parameters(state, settings)
    if angle_rad:
        turn_walk(state[0], angle_rad)


def turn_walk(state: np.void, angle_rad: float) -> None:
    """Turn all that lies in *n* clockwise, seen from above, about the start."""
    turn_about_down(state, _VECTORS, angle_rad)
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    turn = np.eye(PARTS)
    for first in (0, VELOCITY_AT, ATTITUDE_AT):
        turn[first : first + 2, first : first + 2] = [[c, -s], [s, c]]
    state["P"] = turn @ state["P"] @ turn.T
    for name, pairs in (("ring", (RING_GAIN, RING_ROLL, RING_P, RING_Q)), ("looks", (0, 3))):
        for first in pairs:
            xy = state[name][:, first : first + 2]
            state[name][:, first : first + 2] = xy @ np.array([[c, s], [-s, c]])
    state["north_at_rad"] += angle_rad
