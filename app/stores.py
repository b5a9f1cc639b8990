"""Heart: the samples of one sensor: what every track reads. Intake drops what cannot be used, and counts."""

from __future__ import annotations

import math

import numpy as np

from app.blocks import Blocks
from app.clocks import Clock, FixedClock
from app.estimator.feet import Worn
from app.motion.basics import Role, Vector
from app.motion.samples import BACKWARD, MOST_READ, NOT_FINITE, REPEATED, SAMPLE_WIDTH, Rows, Sample

NO_FIELD = (math.nan, math.nan, math.nan)


class SensorStore:
    """One sensor's samples in blocks, with its clock and its role."""

    def __init__(self, sensor: str, role: Role, clock: Clock | None = None) -> None:
        self.sensor = sensor
        self.role = role
        self.clock: Clock = clock or FixedClock()
        self.origin_ns: int | None = None  # of the walk, on the clock that all sensors share
        self.samples = Blocks(SAMPLE_WIDTH)
        self.clocks = Blocks(2)  # host_ns, saturation
        self.dropped: dict[str, int] = {}
        self.saturated = 0
        self._first_ns = 0
        self._last_ns = 0

    def take(self, sample: Sample) -> bool:
        """Keep a sample if it is finite and later than the last one; say whether."""
        force, rate, field = sample.specific_force_b, sample.angular_rate_b, sample.field_b
        if not (_plausible(force) and _plausible(rate)):
            return self._drop(NOT_FINITE)
        if not self.samples.end:
            self._first_ns = sample.device_ns
        elif sample.device_ns <= self._last_ns:
            same = sample.device_ns == self._last_ns
            return self._drop(REPEATED if same else BACKWARD)
        self._last_ns = sample.device_ns
        self.clock.add(sample.device_ns, sample.host_ns)
        self.samples.grow(1)
        block, place = self.samples.block(self.samples.end - 1)
        block[place] = (sample.device_ns - self._first_ns, *force, *rate, *_field_or_none(field))
        self.clocks.grow(1)
        block, place = self.clocks.block(self.clocks.end - 1)
        block[place] = (sample.host_ns, sample.saturation)
        self.saturated += sample.saturation != 0
        return True

    def take_rows(self, rows: Rows, host_ns: int) -> None:
        """Keep rows of a recording, later than all before: what ``take`` would keep of each."""
        samples, stretch = rows.samples, slice(rows.first, rows.last)
        table = samples.matrix[stretch].copy()
        if not self.samples.end:
            self._first_ns = samples.device_ns + int(table[0, 0])
        self._last_ns = samples.device_ns + int(table[-1, 0])
        table[:, 0] += samples.device_ns - self._first_ns
        flags = samples.saturation[stretch]
        self.samples.extend(table)
        self.clocks.extend(np.column_stack([np.full(len(table), float(host_ns)), flags]))
        self.saturated += int(np.count_nonzero(flags))

    def _drop(self, reason: str) -> bool:
        self.dropped[reason] = self.dropped.get(reason, 0) + 1
        return False

    @property
    def begin_s(self) -> float:
        """The device's own time of the first sample."""
        return self._first_ns * 1e-9

    @property
    def elapsed_s(self) -> float:
        """Seconds from the first sample to the last."""
        return (self._last_ns - self._first_ns) * 1e-9

    @property
    def worn(self) -> Worn:
        """Which foot, and its clock, as roughly as it is known live and in a replay alike."""
        return Worn(self.role, round(self.shared_s(0.0), 2), 1.0 + round(self.clock.line.slope, 5))

    def shared_s(self, elapsed_s: float) -> float:
        """Seconds since this sensor's first sample, in those of the clock that all sensors share."""
        origin_ns = self._first_ns if self.origin_ns is None else self.origin_ns
        line = self.clock.line
        return (line.host(self._first_ns) - origin_ns) * 1e-9 + elapsed_s * (1.0 + line.slope)

    def rate_hz(self, over: int = 100) -> float:
        """Samples a second over the last ``over`` samples; 0 with fewer than two."""
        last = self.samples.end - 1
        first = max(self.samples.start, last - over)
        if last <= first:
            return 0.0
        span_ns = self.time_ns(last) - self.time_ns(first)
        return (last - first) * 1e9 / span_ns

    def time_ns(self, row: int) -> float:
        """Nanoseconds from the first sample to this one."""
        block, place = self.samples.block(row)
        return float(block[place, 0])

    def row_at(self, elapsed_s: float) -> int:
        """The first row at or after this time (bisection, so it does not grow with the walk)."""
        low, high = self.samples.start, self.samples.end
        while low < high:
            middle = (low + high) // 2
            if self.time_ns(middle) < elapsed_s * 1e9:
                low = middle + 1
            else:
                high = middle
        return low


def _plausible(vector: Vector) -> bool:
    x, y, z = vector
    return abs(x) < MOST_READ and abs(y) < MOST_READ and abs(z) < MOST_READ  # False for NaN


def _field_or_none(field: Vector | None) -> Vector:
    return field if field is not None and _plausible(field) else NO_FIELD
