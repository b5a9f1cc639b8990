"""Heart: whether a magnetometer may be believed: judged at footprints, by what iron cannot leave as it is.

Far from iron the earth's field is the same at every step: its strength, its dip below the horizon, and its
direction, which then agrees with the heading that the gyro kept. Indoors all three change from step to
step. Each footprint gives one look at the field; the last few of them are judged together.
"""

from __future__ import annotations

import math

import numpy as np

from app.compiled import kernel, part
from app.motion.basics import Floats
from app.motion.estimate import Compass
from app.rotation import rotate

#: So many footprints are judged together, and they must span so many metres.
FOOTPRINTS, SPAN_M = 8, 4.0
#: A field strays whose strength, dip or direction scatters more: share of it, rad, rad (standard deviations).
STRENGTH, DIP_RAD, DIRECTION_RAD = 0.03, math.radians(2.5), math.radians(4.0)
#: A look: the field in *n*, and where that was, north and east, m.
LOOK_WIDTH = 5
#: Verdicts; and of a steady field: it is not that of where north was taken.
OPEN, STEADY, STRENGTH_STRAYS, DIP_STRAYS, DIRECTION_STRAYS, ELSEWHERE = 0, 1, 2, 3, 4, 5


@part
def field_of(x: float, y: float, z: float) -> tuple[float, float, float]:
    """Strength, dip below the horizon and direction (rad, clockwise from *n*'s x) of a field in *n*."""
    flat = math.hypot(x, y)
    return math.hypot(flat, z), math.atan2(z, flat), math.atan2(y, x)


@part
def apart(one_rad: float, other_rad: float) -> float:
    """From the other direction to the one, −π to π."""
    turn = one_rad - other_rad
    return math.atan2(math.sin(turn), math.cos(turn))


@part
def reach(looks: Floats, column: int) -> float:
    """From the least to the largest of a column."""
    least, most = looks[0, column], looks[0, column]
    for i in range(1, FOOTPRINTS):
        least, most = min(least, looks[i, column]), max(most, looks[i, column])
    return float(most - least)


@kernel
def judge(looks: Floats) -> tuple[int, float]:
    """The verdict on ``looks`` [FOOTPRINTS, 5], and by how much what strays does: a share, or rad."""
    if math.hypot(reach(looks, 3), reach(looks, 4)) < SPAN_M:
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


@part
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


@kernel
def add_look(looks: Floats, samples: Floats, rows: Floats) -> bool:
    """The newest look goes last: the mean field while these rows [k, 13] of a stance were made.

    False, and nothing changed, where one of the samples [k, 10] has no field.
    """
    x, y, z, count = 0.0, 0.0, 0.0, rows.shape[0]
    for i in range(count):
        q_nb = (rows[i, 6], rows[i, 7], rows[i, 8], rows[i, 9])
        turned = rotate(q_nb, (samples[i, 7], samples[i, 8], samples[i, 9]))
        x, y, z = x + turned[0], y + turned[1], z + turned[2]
    if count == 0 or not math.isfinite(x + y + z):
        return False
    for i in range(FOOTPRINTS - 1):
        for k in range(LOOK_WIDTH):
            looks[i, k] = looks[i + 1, k]
    look = looks[FOOTPRINTS - 1]
    look[0], look[1], look[2] = x / count, y / count, z / count
    look[3], look[4] = rows[-1, 0], rows[-1, 1]
    return True


class CompassWatch:
    """One foot's last looks at the field, for an estimator that does not watch it in its step."""

    def __init__(self) -> None:
        self._looks = np.zeros((FOOTPRINTS, LOOK_WIDTH))
        self._count = 0

    def add(self, samples: Floats, rows: Floats) -> None:
        """A stance: its samples [k, 10] and its rows [k, 13]."""
        self._count += add_look(self._looks, samples, rows)

    def forget(self) -> None:
        """A new segment: what the gyro kept before says nothing of after."""
        self._count = 0

    @property
    def view(self) -> Compass | None:
        """Whether the field may be believed; None where that is open."""
        return told(*judge(self._looks)) if self._count >= FOOTPRINTS else None
