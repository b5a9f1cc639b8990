"""Heart: which way the toe points on a shoe whose sensor points elsewhere: as its first strides go.

Only what is drawn is turned by it, never the estimate. A stride tells how far its way lies from the sensor's
own x axis while the foot stands; sideways, backward and turning steps tell other things, so most of the
newest strides have to agree.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence

from app.blocks import Blocks
from app.estimator.strides import Step
from app.motion.basics import Quaternion
from app.motion.estimate import ATTITUDE, Toe
from app.rotation import conjugate, from_yaw, multiply

#: A stride shorter than this, m, or with more of a turn, rad, says nothing of the toe.
SHORTEST_M, MOST_TURN_RAD = 0.4, math.radians(25)
#: Of at most so many of the newest strides this share agrees, within this angle, rad.
NEWEST, SHARE, NEAR_RAD = 12, 0.7, math.radians(20)
#: So many strides have to; twice as many where the sensor would look backward: one may walk so, too.
STRIDES, BACKWARD_RAD = 5, math.radians(120)
#: Feet point outward a little; a sensor that is no further off than that looks along the toe.
ALONG_RAD = math.radians(8)


class Toes:
    """One foot's toe direction, found once, and anew only after a gap."""

    def __init__(self) -> None:
        self.toe: Toe | None = None
        self._seen = 0
        self._last: Step | None = None
        self._found = False  # since the last gap
        self._told: deque[tuple[float, Quaternion]] = deque(maxlen=NEWEST)

    def look(self, steps: Sequence[Step], rows: Blocks) -> Toe | None:
        """What is known after these strides, of which more come each time; their rows as estimated."""
        for step in steps[self._seen :]:
            self._add(step, rows)
        self._seen = len(steps)
        return self.toe

    def _add(self, step: Step, rows: Blocks) -> None:
        last, self._last = self._last, step
        if step.gap_s > 0.0:
            self._found = False
            self._told.clear()
        elif last is not None and not self._found and rows.start <= step.contact_row:
            angle_rad = _aside(last, step)
            if angle_rad is not None:
                block, place = rows.block(step.contact_row)
                w, x, y, z = block[place, ATTITUDE].tolist()
                self._told.append((angle_rad, (w, x, y, z)))
                self._decide()

    def _decide(self) -> None:
        groups = [[a for a in self._told if abs(_wrapped(a[0] - b[0])) < NEAR_RAD] for b in self._told]
        group = max(groups, key=len)
        middle = group[0][0]
        ordered = sorted((_wrapped(angle - middle), q_nb) for angle, q_nb in group)
        off_rad, q_nb = ordered[len(ordered) // 2]
        angle_rad = _wrapped(middle + off_rad)
        needed = STRIDES if abs(angle_rad) < BACKWARD_RAD else 2 * STRIDES
        if len(group) >= max(needed, SHARE * len(self._told)):
            self._found = True
            turn = from_yaw(angle_rad)
            q_bs = multiply(conjugate(q_nb), multiply(turn, q_nb))
            along = abs(angle_rad) < ALONG_RAD
            self.toe = None if along else Toe(angle_rad, len(group), q_bs)


def _aside(last: Step, step: Step) -> float | None:
    """How far clockwise of the sensor's x axis a stride went, rad; None where it says nothing."""
    turned_rad = _wrapped(step.heading_rad - last.heading_rad)
    if step.length_m < SHORTEST_M or abs(turned_rad) > MOST_TURN_RAD:
        return None
    north, east = step.place_n[0] - last.place_n[0], step.place_n[1] - last.place_n[1]
    return _wrapped(math.atan2(east, north) - last.heading_rad - 0.5 * turned_rad)


def _wrapped(angle_rad: float) -> float:
    return math.remainder(angle_rad, math.tau)
