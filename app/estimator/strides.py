"""Heart: a stride's figures, in gaitmap's meanings."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from app.compiled import kernel, part
from app.estimator import events as e
from app.motion.basics import Floats, Vector
from app.motion.estimate import Stride
from app.rotation import yaw_of


class Contact(NamedTuple):
    """A footprint: when, where, and which way the toe points."""

    t_s: float
    position_n: Vector
    heading_rad: float


class Step(NamedTuple):
    """What the other foot is told of a stride."""

    start_s: float
    end_s: float  # the contact, by the sensor's own time from its first sample
    swing_s: float
    length_m: float
    place_n: tuple[float, float]  # the footprint, north and east
    lift_row: int
    contact_row: int
    heading_rad: float  # of the toe there
    gap_s: float  # without samples since the stride before
    doubt_m2: float  # σ² that all swings so far add to the position because they did not fit
    bias_doubt_radps: float  # how well the gyro's bias is known by its rests
    bias_moved_radps: float  # … and how far it has moved since, about an axis


def step_of(stride: Stride, event: Floats, gap_s: float, doubts: tuple[float, float, float]) -> Step:
    """A stride that ``event`` ended; ``gap_s`` and ``doubts`` as in ``Step``."""
    rows = (int(event[e.LIFT_ROW]), int(event[e.CONTACT_ROW]))
    north, east, _ = stride.end_n
    figures = (stride.start_s, stride.end_s, stride.swing_s, stride.length_m)
    return Step(*figures, (north, east), *rows, stride.heading_rad, gap_s, *doubts)


def turned(contact: Contact, angle_rad: float) -> Contact:
    """The footprint after the whole walk was turned clockwise, seen from above, about its start."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    north, east, down = contact.position_n
    position_n = (c * north - s * east, s * north + c * east, down)
    return Contact(contact.t_s, position_n, contact.heading_rad + angle_rad)


def stride_to(before: Contact, rows: Floats, event: Floats, number: int, risen_m: float) -> Stride:
    """The stride from the footprint ``before`` to the contact, the last of ``rows`` [k, 13].

    ``event`` is the zero-velocity update that ended it. ``rows`` begin at the lift, or where their block
    does; ``risen_m`` is the lift of the rows before them. Where no contact precedes it in its segment,
    ``before`` is the lift itself.
    """
    return Stride(number, *figures(before.t_s, before.position_n, before.heading_rad, rows, event, risen_m))


@kernel
def figures(
    start_s: float, start_n: Vector, start_rad: float, rows: Floats, event: Floats, risen_m: float
) -> tuple[float, float, float, float, float, float, float, float, Vector, float]:
    """A stride's figures, in the order of ``Stride``, without its number."""
    row = rows[-1]
    end_n = (row[0], row[1], row[2])
    heading_rad = yaw_of((row[6], row[7], row[8], row[9]))
    swing_s = event[e.SWING_S]
    end_s = event[e.LIFT_NS] * 1e-9 + swing_s
    duration_s = end_s - start_s
    return (
        start_s,
        end_s,
        math.hypot(end_n[0] - start_n[0], end_n[1] - start_n[1]),
        duration_s,
        swing_s,
        max(0.0, duration_s - swing_s),
        max(risen_m, lift_above_line(rows, event)),
        wrapped(start_rad - heading_rad),
        end_n,
        heading_rad,
    )


@part
def wrapped(angle_rad: float) -> float:
    """The same angle between −π and π."""
    return angle_rad - math.tau * float(np.rint(angle_rad / math.tau))


@kernel
def lift_above_line(rows: Floats, event: Floats) -> float:
    """How far the sensor rises above the straight line from lift to contact: rows [k, 13] of one swing.

    The line is taken over the horizontal way covered, so that a stair's own height is not lift.
    """
    start_n = (event[e.START], event[e.START + 1], event[e.START + 2])
    north, east, climb = (
        event[e.END] - start_n[0],
        event[e.END + 1] - start_n[1],
        start_n[2] - event[e.END + 2],
    )
    squared = north * north + east * east
    best = 0.0
    for i in range(rows.shape[0]):
        along = 0.0
        if squared > 0.0:
            along = ((rows[i, 0] - start_n[0]) * north + (rows[i, 1] - start_n[1]) * east) / squared
        height = start_n[2] - rows[i, 2] - min(1.0, max(0.0, along)) * climb
        best = max(best, height)
    return best
