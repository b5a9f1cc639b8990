"""Heart: a stride's figures, in gaitmap's meanings."""

from __future__ import annotations

import math
from typing import NamedTuple

from app.compiled import kernel
from app.estimator.corrections import Event
from app.motion import Floats, Stride, Vector
from app.rotation import yaw_of

_START, _END = int(Event.START), int(Event.END)


class Contact(NamedTuple):
    """A footprint: when, where, and which way the toe points."""

    t_s: float
    position_n: Vector
    heading_rad: float


def contact_at(row: Floats, t_s: float) -> Contact:
    """The footprint at a row [12]."""
    north, east, down, *_ = row.tolist()
    return Contact(t_s, (north, east, down), yaw_of(tuple(row[6:10].tolist())))


def turned(contact: Contact, angle_rad: float) -> Contact:
    """The footprint after the whole walk was turned clockwise, seen from above, about its start."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    north, east, down = contact.position_n
    position_n = (c * north - s * east, s * north + c * east, down)
    return Contact(contact.t_s, position_n, contact.heading_rad + angle_rad)


def stride_between(before: Contact, now: Contact, event: Floats, number: int, lift_m: float) -> Stride:
    """The stride from one footprint to the next; ``event`` is the zero-velocity update that ended it.

    Where no contact precedes it in its segment, ``before`` is the lift itself.
    """
    swing_s = float(event[Event.SWING_S])
    north, east = now.position_n[0] - before.position_n[0], now.position_n[1] - before.position_n[1]
    duration_s = now.t_s - before.t_s
    return Stride(
        number=number,
        start_s=before.t_s,
        end_s=now.t_s,
        length_m=math.hypot(north, east),
        duration_s=duration_s,
        swing_s=swing_s,
        stance_s=max(0.0, duration_s - swing_s),
        lift_m=lift_m,
        turn_rad=math.remainder(before.heading_rad - now.heading_rad, math.tau),
        end_n=now.position_n,
        heading_rad=now.heading_rad,
    )


@kernel
def lift_above_line(rows: Floats, event: Floats) -> float:
    """How far the sensor rises above the straight line from lift to contact: rows [k, 12] of one swing.

    The line is taken over the horizontal way covered, so that a stair's own height is not lift.
    """
    start_n, end_n = event[_START : _START + 3], event[_END : _END + 3]
    north, east, climb = end_n[0] - start_n[0], end_n[1] - start_n[1], start_n[2] - end_n[2]
    squared = north * north + east * east
    best = 0.0
    for i in range(rows.shape[0]):
        along = 0.0
        if squared > 0.0:
            along = ((rows[i, 0] - start_n[0]) * north + (rows[i, 1] - start_n[1]) * east) / squared
        height = start_n[2] - rows[i, 2] - min(1.0, max(0.0, along)) * climb
        best = max(best, height)
    return best
