"""Heart: the default decoder's state: flat records of float64, so that a copy is a checkpoint.

The classes only name the fields; compiled code reads them as attributes. Feet: 0 left, 1 right.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

# --- what a foot does in one action
UNKNOWN, STEP, TWIST, BACK, TOE_UP = 0.0, 1.0, 2.0, 3.0, 4.0
# --- why
STILL, MISSING, SILENT, RUBBISH, TAPS, TWISTS, MIXED, LONE_BACK, UNCLEAR, FIRST, CLASS = range(11)


class Foot:
    """One foot: level and bias at rest, the action under way, and those before it."""

    seen: float  # 0 until the first sample
    t_s: float  # of the last sample, on the shared clock
    fault_s: float  # when it last sent rubbish or was unplugged
    levelled: float
    dx: float  # unit vector down, in the sensor's axes
    dy: float
    dz: float
    gravity: float
    bx: float  # gyro bias, rad/s
    by: float
    bz: float
    moving: float  # an action, or what may become one, is under way
    sure: float  # it is large enough to be one
    below_s: float
    begin_s: float  # onset of the action under way
    yaw: float  # turned since the onset, rad: about down, toe up, right edge down
    pitch: float
    roll: float
    rate_most: float  # rad/s
    rate_peak: float  # the same of the last sure action
    yaw_peak: float
    pitch_peak: float
    pitch_least: float
    pitch_most: float
    yaw_energy: float
    tilt_energy: float
    now: float  # kind of the action under way
    margin: float  # 0 to 1: how clearly it is that
    kind: float  # kind for the pair: of this action where clear, else of the last
    energy: float  # of the last action
    on_s: float  # onset of the last sure action
    previous_on_s: float
    end_s: float  # of the last sure action
    duration_s: float
    size: float  # |yaw| or |pitch| of the last action, rad
    actions: float  # sure ones in this bout


class Pair:
    """Both feet together: the pace, and what is decided."""

    cycle_s: float  # mean time from one action of a foot to its next; 0 unknown
    intervals: float  # how many it is the mean of
    odd: float  # 1 if the last interval was not like the others
    stopped: float  # 1 once the gesture has ended, until a foot begins again
    motion: float  # motion id
    certain: float
    confidence: float
    speed: float  # m/s
    turn: float  # rad/s, clockwise
    pace: float  # whole cycles a second, as the speed was made of; 0 not known yet
    reason: float  # ten times a reason's number, plus 0 left, 1 right, 2 both


class Tuning:
    """Thresholds and scales, SI."""

    on_radps: float
    off_radps: float
    sure_rad: float
    forward_m: float  # metres of way for each whole cycle
    back_m: float
    side_m: float
    turn_share: float  # turn for each cycle, in multiples of the foot's own twist
    gentle_mps: float
    gentle_radps: float
    silence_s: float


Record = NDArray[Any]


def dtype_of(kind: type) -> np.dtype[Any]:
    """The record of a class's annotated fields, all float64."""
    return np.dtype([(name, np.float64) for name in kind.__annotations__])


FOOT, PAIR, TUNING = dtype_of(Foot), dtype_of(Pair), dtype_of(Tuning)
