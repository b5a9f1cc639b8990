"""Heart: when a sensor lies still, and what it reads meanwhile."""

from __future__ import annotations

import math
from typing import NamedTuple

from app.motion.basics import Vector
from app.motion.samples import GAP_NS, Sample

#: Further from the mean so far than this, it moves: ten times the noise of the papers' sensor.
FORCE_MPS2, RATE_RADPS = 0.35, 0.08
#: A null is smaller than this; a slow turn is not stillness.
NULL_RADPS = 0.2
#: The first moments after a hand lets go are left out.
SETTLE_NS = 300_000_000


class Pose(NamedTuple):
    """The means of a still time."""

    force: Vector  # m/s²
    rate: Vector  # rad/s
    field: Vector | None  # µT
    seconds: float
    samples: int
    doubt_mps2: float  # standard error of the force's noisiest axis

    @property
    def down(self) -> tuple[int, int]:
        """The axis nearest to the vertical, and 1 if it points down, −1 if up."""
        axis = max(range(3), key=lambda i: abs(self.force[i]))
        return axis, 1 if self.force[axis] < 0.0 else -1

    @property
    def upright(self) -> float:
        """Cosine of the angle between that axis and the vertical."""
        length: float = sum(c * c for c in self.force) ** 0.5
        return float(max(map(abs, self.force)) / length) if length > 0.0 else 0.0


class Stillness:
    """Follows one sensor; O(1) a sample."""

    def __init__(self) -> None:
        self._settled = False
        self._begin_ns = self._last_ns = 0
        self._clear()

    def _clear(self) -> None:
        self._sums, self._count, self._fields = [0.0] * 9, 0, 0
        self._first = [0.0] * 3  # of the force; its spread is told from there
        self._off, self._squares = [0.0] * 3, [0.0] * 3

    def add(self, sample: Sample) -> Pose | None:
        """The still time so far, without its first moments; None while it moves."""
        gap = not 0 < sample.device_ns - self._last_ns <= GAP_NS
        self._last_ns = sample.device_ns
        readings = (*sample.specific_force_b, *sample.angular_rate_b, *(sample.field_b or (0.0, 0.0, 0.0)))
        if gap or not self._count or self._moves(readings):
            self._clear()
            self._begin_ns, self._settled = sample.device_ns, False
        elif not self._settled and sample.device_ns - self._begin_ns >= SETTLE_NS:
            self._clear()
            self._begin_ns, self._settled = sample.device_ns, True
        if not self._count:
            self._first = list(sample.specific_force_b)
        for i, value in enumerate(readings):
            self._sums[i] += value
        for i, first in enumerate(self._first):
            off = readings[i] - first
            self._off[i] += off
            self._squares[i] += off * off
        self._count += 1
        self._fields += sample.field_b is not None
        return self._pose() if self._settled else None

    def _moves(self, readings: tuple[float, ...]) -> bool:
        means = [value / self._count for value in self._sums]
        away = [abs(value - mean) for value, mean in zip(readings, means, strict=True)]
        steady = max(away[:3]) < FORCE_MPS2 and max(away[3:6]) < RATE_RADPS
        return not steady or max(map(abs, readings[3:6])) > NULL_RADPS

    def _pose(self) -> Pose:
        f, w, m = ([value / self._count for value in self._sums[i : i + 3]] for i in (0, 3, 6))
        return Pose(
            (f[0], f[1], f[2]),
            (w[0], w[1], w[2]),
            (m[0], m[1], m[2]) if self._fields == self._count else None,
            (self._last_ns - self._begin_ns) * 1e-9,
            self._count,
            self._doubt(),
        )

    def _doubt(self) -> float:
        n = self._count
        spread = max(square - off * off / n for square, off in zip(self._squares, self._off, strict=True))
        return math.sqrt(max(spread, 0.0) / max(n - 1, 1) / n)
