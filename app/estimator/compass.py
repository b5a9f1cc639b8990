"""Heart: whether a magnetometer may be believed: judged at footprints, by what iron cannot leave as it is.

Far from iron the earth's field is the same at every step: its strength, its dip below the horizon, and its
direction, which then agrees with the heading that the gyro kept. Indoors all three change from step to
step. Each footprint gives one look at the field; the last few of them are judged together.
"""

from __future__ import annotations

import math

import numpy as np

from app.compiled import kernel
from app.motion.basics import Floats
from app.motion.estimate import ATTITUDE, Compass
from app.motion.samples import Column

#: So many footprints are judged together, and they must span so many metres.
FOOTPRINTS, SPAN_M = 8, 4.0
#: A field strays whose strength, dip or direction scatters more: share of it, rad, rad (standard deviations).
STRENGTH, DIP_RAD, DIRECTION_RAD = 0.03, math.radians(2.5), math.radians(4.0)
#: A look: the field in *n*, and where that was, north and east, m.
LOOK_WIDTH = 5
#: Verdicts; and of a steady field: it is not that of where north was taken.
OPEN, STEADY, STRENGTH_STRAYS, DIP_STRAYS, DIRECTION_STRAYS, ELSEWHERE = 0, 1, 2, 3, 4, 5


@kernel
def field_of(x: float, y: float, z: float) -> tuple[float, float, float]:
    """Strength, dip below the horizon and direction (rad, clockwise from *n*'s x) of a field in *n*."""
    flat = math.hypot(x, y)
    return math.hypot(flat, z), math.atan2(z, flat), math.atan2(y, x)


@kernel
def apart(one_rad: float, other_rad: float) -> float:
    """From the other direction to the one, −π to π."""
    turn = one_rad - other_rad
    return math.atan2(math.sin(turn), math.cos(turn))


@kernel
def judge(looks: Floats) -> tuple[int, float]:
    """The verdict on ``looks`` [FOOTPRINTS, 5], and by how much what strays does: a share, or rad."""
    north, east = looks[:, 3], looks[:, 4]
    if math.hypot(north.max() - north.min(), east.max() - east.min()) < SPAN_M:
        return OPEN, 0.0
    strength, strength2, dip, dip2, turned2 = 0.0, 0.0, 0.0, 0.0, 0.0
    _, _, middle = middle_of(looks)
    for i in range(FOOTPRINTS):
        s, d, direction = field_of(looks[i, 0], looks[i, 1], looks[i, 2])
        strength, strength2, dip, dip2 = strength + s, strength2 + s * s, dip + d, dip2 + d * d
        turned2 += apart(direction, middle) ** 2
    strength, dip = strength / FOOTPRINTS, dip / FOOTPRINTS
    strays = math.sqrt(max(strength2 / FOOTPRINTS - strength * strength, 0.0))
    tilts = math.sqrt(max(dip2 / FOOTPRINTS - dip * dip, 0.0))
    turns = math.sqrt(turned2 / FOOTPRINTS)
    if strays > STRENGTH * strength or strength == 0.0:
        return STRENGTH_STRAYS, strays / max(strength, 1e-12)
    if tilts > DIP_RAD:
        return DIP_STRAYS, tilts
    return (DIRECTION_STRAYS if turns > DIRECTION_RAD else STEADY), turns


@kernel
def middle_of(looks: Floats) -> tuple[float, float, float]:
    """Strength, dip and direction of the looks' mean field; each counts for its direction alone alike."""
    x, y, z, east, north = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(looks.shape[0]):
        flat = max(math.hypot(looks[i, 0], looks[i, 1]), 1e-12)
        x, y, z = x + looks[i, 0], y + looks[i, 1], z + looks[i, 2]
        north, east = north + looks[i, 0] / flat, east + looks[i, 1] / flat
    strength, dip, _ = field_of(x, y, z)
    return strength / looks.shape[0], dip, math.atan2(east, north)


def told(verdict: int, amount: float, holds: bool = False) -> Compass | None:
    """A verdict in words; None where it is open. ``holds``: the heading is held by it."""
    if verdict == OPEN:
        return None
    why = {
        STEADY: "",
        STRENGTH_STRAYS: f"its strength strays by {100.0 * amount:.0f} %",
        DIP_STRAYS: f"its dip strays by {math.degrees(amount):.0f}°",
        DIRECTION_STRAYS: f"its direction and the gyro's heading part by {math.degrees(amount):.0f}°",
        ELSEWHERE: "it is steady, but another one than before",
    }[verdict]
    return Compass(verdict == STEADY, why, holds and verdict == STEADY)


class CompassWatch:
    """One foot's last looks at the field; ``view``: whether it may be believed, None where that is open."""

    def __init__(self) -> None:
        self.view: Compass | None = None
        self._looks = np.empty((0, LOOK_WIDTH))

    def add(self, samples: Floats, rows: Floats) -> None:
        """A stance: its samples [k, 10] and its rows [k, 13]."""
        field_b = samples[:, Column.MX :]
        if not len(rows) or not np.isfinite(field_b).all():
            return
        look = np.append(_rotated(rows[:, ATTITUDE], field_b).mean(axis=0), rows[-1, :2])
        self._looks = np.vstack([self._looks, look])[-FOOTPRINTS:]
        self.view = told(*judge(self._looks)) if len(self._looks) == FOOTPRINTS else None

    def forget(self) -> None:
        """A new segment: what the gyro kept before says nothing of after."""
        self._looks = self._looks[:0]
        self.view = None


def _rotated(q_nb: Floats, vectors: Floats) -> Floats:
    """Vectors [k, 3] of *b* in *n*, by quaternions [k, 4], wxyz."""
    w, u = q_nb[:, :1], q_nb[:, 1:]
    t = 2.0 * np.cross(u, vectors)
    turned: Floats = vectors + w * t + np.cross(u, t)
    return turned
