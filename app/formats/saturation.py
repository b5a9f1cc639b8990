"""Heart: which samples touch the range of their sensor.

A range is known from the device, or evident: a large extreme that the channel reads again and
again, to the digit, twice in a row at least. A sensor that clips before it is calibrated leaves no
such plateau and stays unflagged.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import G_MPS2, Floats
from app.motion.samples import SAMPLE_WIDTH, Column

_NEAR = 0.98  # of the range: flagged from here on
_REPEATS = 3
_LARGE = (20.0, 2.0)  # m/s², rad/s: below this a repeated extreme is only a coarse sensor at rest


@dataclass(frozen=True)
class Range:
    """Full scale of force (m/s²), rate (rad/s) and field (µT); infinite where unknown."""

    force: float = math.inf
    rate: float = math.inf
    field: float = math.inf


#: Standard ranges by device; a ``mip`` sensor is sold in many.
RANGES: dict[str, Range] = {
    "gx1": Range(5 * G_MPS2, math.radians(300), 120.0),
    "mip": Range(),
    "ximu": Range(8 * G_MPS2, math.radians(2000)),
    "ngimu": Range(16 * G_MPS2, math.radians(2000), 1300.0),
    "ximu3": Range(24 * G_MPS2, math.radians(2000)),
    "xsens": Range(16 * G_MPS2, math.radians(2000)),
    "witmotion": Range(16 * G_MPS2, math.radians(2000)),
    "csv": Range(),
}


def saturation(matrix: Floats, known: Range) -> NDArray[np.uint16]:
    """Bits [n] of the channels at their range; ``matrix`` as ``Samples.matrix``."""
    bits = np.zeros(len(matrix), np.uint16)
    groups = ((Column.FX, known.force, _LARGE[0]), (Column.WX, known.rate, _LARGE[1]))
    for first, full_scale, large in groups:
        values = np.abs(matrix[:, first : first + 3])
        limit = min(full_scale, _evident_range(values, large))
        bits |= _flags(values, limit, int(first) - 1)
    field = np.nan_to_num(np.abs(matrix[:, Column.MX : SAMPLE_WIDTH]))
    return bits | _flags(field, known.field, int(Column.MX) - 1)


def _flags(values: Floats, limit: float, first_bit: int) -> NDArray[np.uint16]:
    if math.isinf(limit):
        return np.zeros(len(values), np.uint16)
    weights = np.array([1 << (first_bit + i) for i in range(3)], np.uint16)
    bits: NDArray[np.uint16] = ((values >= _NEAR * limit) * weights).sum(axis=1).astype(np.uint16)
    return bits


def _evident_range(values: Floats, large: float) -> float:
    """The smallest repeated extreme among three channels' magnitudes [n, 3]; infinite if none."""
    return min((_repeated_extreme(column, large) for column in values.T), default=math.inf)


def _repeated_extreme(values: Floats, large: float) -> float:
    top = float(values.max(initial=0.0))
    at_top = values == top
    in_a_row = bool(np.any(at_top[1:] & at_top[:-1]))
    return top if top >= large and at_top.sum() >= _REPEATS and in_a_row else math.inf
