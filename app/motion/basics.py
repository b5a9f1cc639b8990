"""Heart: the words every room uses: kinds of numbers, a sensor's role, a foot's phase, a user's error.

Frames: *b* is the shoe (x toe, y right, z down), *n* is north–east–down. A quaternion ``q_nb`` is
a unit Hamilton quaternion, wxyz, and takes body vectors into *n*. Everything is SI and radians; the
magnetic field is in µT. Degrees live in ``scene/`` only.
"""

from __future__ import annotations

from enum import IntEnum, StrEnum

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
#: Standard gravity, m/s²: what "1 g" is.
G_MPS2 = 9.80665


class InputError(ValueError):
    """The user's input is wrong. The message is one line: the thing, what came, what was expected."""


class Role(StrEnum):
    """Where a sensor sits. ``FOOT`` is one foot of which nobody said left or right."""

    LEFT = "left"
    RIGHT = "right"
    FOOT = "foot"
    OTHER = "other"


def role_of(sensor: str) -> Role:
    """The role a sensor's bare name stands for: ``left`` is the left foot, an unknown name a foot."""
    return Role(sensor) if sensor in set(Role) else Role.FOOT


class GaitPhase(IntEnum):
    """The two states of the gait-phase machine (2012 paper, Fig. 5)."""

    STANCE = 0
    SWING = 1


class MotionId(IntEnum):
    """What the feet ask for (dissertation, Table 14); 8 on are the project's own. Sent over UDP as it is."""

    NONE = 0
    FORWARD = 1
    FORWARD_RIGHT = 2
    FORWARD_LEFT = 3
    SIDE_RIGHT = 4
    SIDE_LEFT = 5
    TURN_CW = 6
    TURN_CCW = 7
    BACKWARD = 8
