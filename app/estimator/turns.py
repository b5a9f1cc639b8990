"""Heart: how one foot's walk is turned and shifted from stride to stride, beside what its own estimate says.

A turn holds from a stride's contact on, about that footprint. In the swing before it the one before goes over
into it, so a standing foot never slides.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats, Ints
from app.motion.estimate import ATTITUDE, RowColumn, Stride

_NORTH, _EAST, _VNORTH = int(RowColumn.NORTH), int(RowColumn.EAST), int(RowColumn.VN)
_ROOM = 64


class Turn(NamedTuple):
    """What holds from a contact on: columns of the table that ``Turns`` keeps."""

    lift_row: float  # behind it the swing
    contact_row: float
    swing_s: float
    yaw_rad: float  # clockwise, seen from above
    north_m: float  # how far the footprint is shifted
    east_m: float
    at_north_m: float  # the footprint by the foot's own estimate
    at_east_m: float


class Turns:
    """One foot's turns, in order. Without any the rows stay what they are, to the bit."""

    def __init__(self) -> None:
        self._table = np.empty((_ROOM, len(Turn._fields)))
        self._count = 0

    def __len__(self) -> int:
        return self._count

    def add(self, turn: Turn) -> None:
        """One more stride's; as long as nothing had to move, nothing is kept."""
        if not (self._count or turn.yaw_rad or turn.north_m or turn.east_m):
            return
        if self._count == len(self._table):
            self._table = np.concatenate([self._table, np.empty_like(self._table)])
        self._table[self._count] = turn
        self._count += 1

    def from_row(self, first: int, rows: Floats) -> Floats:
        """Rows [k, 13] that follow each other, turned: a copy where there is anything to turn."""
        return self.of(rows, np.arange(first, first + len(rows))) if self._count else rows

    def of(self, rows: Floats, numbers: Ints) -> Floats:
        """Rows [k, 13] with these numbers [k], turned: a copy where there is anything to turn."""
        if not self._count:
            return rows
        lift, contact, swing_s, yaw, *_ = columns = self._table[: self._count].T
        now = np.searchsorted(contact, numbers, side="right") - 1
        to = np.minimum(now + 1, self._count - 1)
        length = np.maximum(contact[to] - lift[to], 1.0)
        u = np.where(to > now, np.clip((numbers - lift[to]) / length, 0.0, 1.0), 0.0)
        rise, rise_rate = u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / np.maximum(swing_s[to], 1e-3)
        moves = _moves(columns, now, rows)
        further = _moves(columns, to, rows) - moves
        angle = np.where(now < 0, 0.0, yaw[now])
        angle = angle + rise * (yaw[to] - angle)
        made = rows.copy()
        made[:, :2] += moves + rise[:, None] * further
        made[:, _VNORTH : _VNORTH + 2] = turned(rows[:, _VNORTH:], angle) + rise_rate[:, None] * further
        made[:, ATTITUDE] = turned_attitude(rows[:, ATTITUDE], angle)
        return made

    def of_stride(self, stride: Stride, contact_row: int) -> Stride:
        """A stride whose contact was at this row: where it ends, and which way the toe points."""
        columns = self._table[: self._count].T
        now = np.searchsorted(columns[1], [contact_row], side="right") - 1
        if not self._count or now[0] < 0:
            return stride
        north, east, down = stride.end_n
        moved = _moves(columns, now, np.array([[north, east]]))[0]
        heading = stride.heading_rad + float(columns[3][now[0]])
        return stride._replace(
            end_n=(north + float(moved[0]), east + float(moved[1]), down), heading_rad=heading
        )


def _moves(columns: Floats, now: Ints, rows: Floats) -> Floats:
    """How far each row is moved north and east [k, 2] by the turn at its place in ``now``; −1 is none."""
    _, _, _, yaw, north, east, at_north, at_east = columns
    from_it = np.column_stack([rows[:, _NORTH] - at_north[now], rows[:, _EAST] - at_east[now]])
    moves: Floats = turned(from_it, yaw[now]) - from_it
    moves[:, 0] += north[now]
    moves[:, 1] += east[now]
    moves[now < 0] = 0.0
    return moves


def turned(vectors: Floats, yaw_rad: Floats) -> Floats:
    """Vectors [k, ≥2], north and east first, each turned clockwise by its angle [k]: [k, 2]."""
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    north, east = vectors[:, 0], vectors[:, 1]
    found: Floats = np.column_stack([c * north - s * east, s * north + c * east])
    return found


def turned_attitude(q_nb: Floats, yaw_rad: Floats) -> Floats:
    """Attitudes [k, 4], turned likewise."""
    w, z = np.cos(0.5 * yaw_rad), np.sin(0.5 * yaw_rad)
    return np.column_stack([
        w * q_nb[:, 0] - z * q_nb[:, 3], w * q_nb[:, 1] - z * q_nb[:, 2],
        w * q_nb[:, 2] + z * q_nb[:, 1], w * q_nb[:, 3] + z * q_nb[:, 0],
    ])  # fmt: skip
