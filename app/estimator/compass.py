"""Heart: whether a magnetometer may be believed: judged at footprints, by what iron cannot leave as it is.

Far from iron the earth's field is the same at every step: its strength, its dip below the horizon, and its
direction, which then agrees with the heading that the gyro kept. Indoors all three change from step to
step. Each footprint gives one look at the field; the last few of them are judged together.
"""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats
from app.motion.estimate import ATTITUDE, Compass
from app.motion.samples import Column

#: So many footprints are judged together, and they must span so many metres.
FOOTPRINTS, SPAN_M = 8, 4.0
#: A field strays whose strength, dip or direction scatters more: share of it, rad, rad (standard deviations).
STRENGTH, DIP_RAD, DIRECTION_RAD = 0.03, math.radians(2.5), math.radians(4.0)


class Look(NamedTuple):
    """The field at one footprint: in *n*, and where that is, m."""

    field_n: tuple[float, float, float]
    north_m: float
    east_m: float


class CompassWatch:
    """One foot's last looks at the field; ``view``: whether it may be believed, None where that is open."""

    def __init__(self) -> None:
        self.view: Compass | None = None
        self._looks: deque[Look] = deque(maxlen=FOOTPRINTS)

    def add(self, samples: Floats, rows: Floats) -> None:
        """A stance: its samples [k, 10] and its rows [k, 13]."""
        field_b = samples[:, Column.MX :]
        if not len(rows) or not np.isfinite(field_b).all():
            return
        x, y, z = _rotated(rows[:, ATTITUDE], field_b).mean(axis=0).tolist()
        self._looks.append(Look((x, y, z), float(rows[-1, 0]), float(rows[-1, 1])))
        self.view = self._judge()

    def forget(self) -> None:
        """A new segment: what the gyro kept before says nothing of after."""
        self._looks.clear()
        self.view = None

    def _judge(self) -> Compass | None:
        if len(self._looks) < FOOTPRINTS:
            return None
        places = np.array([look[1:] for look in self._looks])
        if math.hypot(*np.ptp(places, axis=0)) < SPAN_M:
            return None
        return judged(np.array([look.field_n for look in self._looks]))


def judged(field_n: Floats) -> Compass:
    """The fields at some footprints [k, 3] in *n*, judged together."""
    flat = np.hypot(field_n[:, 0], field_n[:, 1])
    strength = np.hypot(flat, field_n[:, 2])
    dip = np.arctan2(field_n[:, 2], flat)
    unit = (field_n[:, 0] + 1j * field_n[:, 1]) / np.maximum(flat, 1e-12)
    direction = np.angle(unit / unit.mean()) if abs(unit.mean()) > 1e-6 else np.full(len(flat), math.pi)
    strays = float(strength.std() / max(strength.mean(), 1e-12))
    tilts, turns = float(dip.std()), float(np.sqrt(np.mean(direction**2)))
    if strays > STRENGTH:
        return Compass(False, f"its strength strays by {100.0 * strays:.0f} %")
    if tilts > DIP_RAD:
        return Compass(False, f"its dip strays by {math.degrees(tilts):.0f}°")
    if turns > DIRECTION_RAD:
        return Compass(False, f"its direction and the gyro's heading part by {math.degrees(turns):.0f}°")
    return Compass(True, "")


def _rotated(q_nb: Floats, vectors: Floats) -> Floats:
    """Vectors [k, 3] of *b* in *n*, by quaternions [k, 4], wxyz."""
    w, u = q_nb[:, :1], q_nb[:, 1:]
    t = 2.0 * np.cross(u, vectors)
    turned: Floats = vectors + w * t + np.cross(u, t)
    return turned
