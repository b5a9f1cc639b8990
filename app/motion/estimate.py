"""Heart: what an estimator says of a foot: rows, strides, how sure it is, and what is kept of it."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import Floats, Quaternion, Vector
from app.settings import Settings


class RowColumn(IntEnum):
    """Columns of a track's rows, float64 [n, 13]: one row per sample."""

    NORTH = 0
    EAST = 1
    DOWN = 2
    VN = 3
    VE = 4
    VD = 5
    QW = 6
    QX = 7
    QY = 8
    QZ = 9
    PHASE = 10
    STATISTIC = 11
    THRESHOLD = 12  # what the statistic is held against, in its unit


ROW_WIDTH = len(RowColumn)
POSITION = slice(0, 3)
VELOCITY = slice(3, 6)
ATTITUDE = slice(6, 10)


class Stride(NamedTuple):
    """From one initial contact to the next of the same foot (so: a stance, then a swing).

    The first stride of a segment has no contact before it: it starts where its swing starts and
    its ``stance_s`` is 0. ``length_m`` is horizontal, start to end. ``turn_rad`` is positive to
    the left (opposite to NED yaw). ``lift_m`` is the highest point of the sensor above the line
    from start to end; it is not toe clearance. ``end_n`` is the footprint.
    """

    number: int
    start_s: float
    end_s: float
    length_m: float
    duration_s: float
    swing_s: float
    stance_s: float
    lift_m: float
    turn_rad: float
    end_n: Vector
    heading_rad: float  # NED yaw of the toe at the footprint


class Trust(NamedTuple):
    """How sure an estimator is of where a foot is: the ellipse that holds it 95 times of 100, and a word."""

    major_m: float  # half axes of the ellipse on the floor
    minor_m: float
    angle_rad: float  # of the major axis, clockwise from north
    word: str  # "good" | "drifting" | "lost"
    why: str  # empty where it is good


class Compass(NamedTuple):
    """Whether the magnetic field was the same at the last footprints, and if not, what of it changed."""

    steady: bool
    why: str  # empty where it is steady
    holds: bool = False  # the heading is held by it


class Toe(NamedTuple):
    """Where a shoe's toe points beside its sensor's x axis, as its strides told."""

    angle_rad: float  # clockwise from above
    strides: int  # that told it
    q_bs: Quaternion  # takes the shoe's vectors into the sensor's


class Saved(NamedTuple):
    """One foot's estimate between two swings: all that it takes to go on from there."""

    settings: Settings
    row: int  # samples before it
    state: bytes  # of the estimator's own record
    newest: tuple[float, ...]  # the last row
    strides: int
    distance_m: float
    contact: tuple[float, Vector, float] | None  # the last footprint: seconds, where, heading in rad


class Way(NamedTuple):
    """A foot's trail over rows ``first`` to ``last`` (exclusive), decimated for drawing."""

    first: int
    last: int
    segments: NDArray[np.float32]  # [k, 2, 3] in n


class Sweep(NamedTuple):
    """What "find gains" found: closure in metres over a grid of gains."""

    gains_stance: Floats  # [a]
    gains_swing: Floats  # [b]
    closure_m: Floats  # [a, b]
    best: tuple[float, float]
