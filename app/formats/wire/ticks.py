"""Heart: device clocks: counters that wrap, restart or have a tick of unknown length, and none at all."""

from __future__ import annotations

from itertools import combinations
from statistics import median
from typing import NamedTuple

from app.motion.samples import GAP_NS

_LEAP_NS = 100_000_000  # a device step may exceed the host's by this (and a usual step) before it is suspect
_SLACK_NS = 1_000_000_000  # and by this before it is a restart: what was held up came at once
_IN_A_ROW = 8  # stamps a little in the past: late datagrams, unless so many follow each other


class _Reading(NamedTuple):
    """A counter, when it arrived, and the time that it was taken for."""

    ticks: int
    host_ns: int
    device_ns: int


class DeviceClock:
    """A counter of ``bits`` bits and ``tick_ns`` a tick as nanoseconds that only ever increase.

    A step that contradicts the host's clock is believed when the next stamp follows it: then the
    device restarted, and its time goes on at the host's pace, over a gap that no one integrates
    across. Until then, and for repeated or late stamps, the reading is refused. Where a stamp contradicts
    the newest but follows the one before, the newest was damaged: the time goes on from the one before.
    """

    def __init__(self, tick_ns: int, bits: int) -> None:
        self.restarts = 0
        self._tick_ns = tick_ns
        self._wrap = 1 << bits
        self._newest: _Reading | None = None
        self._before: _Reading | None = None
        self._given_ns = -1
        self._usual_ns = _SLACK_NS  # the last step, or nobody knows
        self._odd_ticks = -1
        self._odd_in_a_row = 0

    def stamp(self, ticks: int, host_ns: int) -> int | None:
        """Device time of a counter that arrived at ``host_ns``; None: refuse the reading."""
        newest, before = self._newest, self._before
        if newest is None:
            return self._take(_Reading(ticks, host_ns, ticks * self._tick_ns))
        host_step_ns = max(host_ns - newest.host_ns, 0)
        step_ns = self._step_ns(ticks, newest.ticks, host_step_ns)
        if 0 < step_ns <= host_step_ns + _LEAP_NS + self._usual_ns:
            self._usual_ns = min(step_ns, _SLACK_NS)
            return self._take(_Reading(ticks, host_ns, newest.device_ns + step_ns))
        if step_ns == 0:
            return None
        if before is not None:
            since_ns = self._step_ns(ticks, before.ticks, max(host_ns - before.host_ns, 0))
            if 0 < since_ns <= host_ns - before.host_ns + _LEAP_NS:
                self._newest, self._odd_ticks = before, -1
                return self._take(_Reading(ticks, host_ns, before.device_ns + since_ns))
        if not self._believed(ticks, step_ns):
            return None
        if 0 < step_ns and (host_step_ns == 0 or step_ns <= host_step_ns + _SLACK_NS):
            return self._take(_Reading(ticks, host_ns, newest.device_ns + step_ns))  # much came at once
        self.restarts += 1
        return self._take(_Reading(ticks, host_ns, newest.device_ns + max(host_step_ns, GAP_NS + 1)))

    def _take(self, reading: _Reading) -> int | None:
        self._newest, self._before = reading, self._newest
        self._odd_ticks, self._odd_in_a_row = -1, 0
        if reading.device_ns <= self._given_ns:
            return None
        self._given_ns = reading.device_ns
        return reading.device_ns

    def _step_ns(self, ticks: int, before: int, host_step_ns: int) -> int:
        """The signed step nearest to what the host saw pass: silence may last longer than a wrap."""
        step = (ticks - before) % self._wrap
        expected = host_step_ns // self._tick_ns
        return (step + (expected - step + self._wrap // 2) // self._wrap * self._wrap) * self._tick_ns

    def _believed(self, ticks: int, step_ns: int) -> bool:
        follows = (
            self._odd_ticks >= 0 and 0 < (ticks - self._odd_ticks) % self._wrap * self._tick_ns < _SLACK_NS
        )
        self._odd_in_a_row = self._odd_in_a_row + 1 if follows else 0
        self._odd_ticks = ticks
        return self._odd_in_a_row >= (_IN_A_ROW if -_SLACK_NS < step_ns < 0 else 1)


class TickLength:
    """How long a tick is, told by the host's clock: a line through five seconds, snapped to what is known.

    Bursts and a backlog at the start only delay: of each tenth the least delayed reading counts, and
    the line is the median of all slopes between tenths (Theil and Sen).
    """

    SPAN_NS = 5_000_000_000
    NEAR = 0.02
    MOST = 8192  # so many readings without five seconds: a stream fed at once, by no clock

    def __init__(self, known_ns: tuple[int, ...], bits: int) -> None:
        self.snapped = False  # whether the length found is one of the known
        self._known_ns = known_ns
        self._wrap = 1 << bits
        self._points: list[tuple[int, int]] = []  # ticks, made to run on, and host time

    def add(self, ticks: int, host_ns: int) -> int | None:
        """The length of a tick in ns once five seconds have passed (ten, if it fits no known), else None.

        The first known length, not snapped, where the host's clock does not tell.
        """
        points = self._points
        if points:
            ticks = points[-1][0] + (ticks - points[-1][0]) % self._wrap
        points.append((ticks, host_ns))
        passed_ns = host_ns - points[0][1]
        if len(points) >= self.MOST and passed_ns < self.SPAN_NS:
            return self._known_ns[0]
        if (
            passed_ns < self.SPAN_NS
            or len(points) < 20
            or (passed_ns < 2 * self.SPAN_NS and len(points) % 50)
        ):
            return None
        measured_ns, nearest_ns = self._measure()
        self.snapped = abs(nearest_ns - measured_ns) <= self.NEAR * nearest_ns
        if self.snapped:
            return nearest_ns
        return max(round(measured_ns), 1) if passed_ns >= 2 * self.SPAN_NS else None

    def _measure(self) -> tuple[float, int]:
        """Nanoseconds a tick as measured, and the known length nearest to it."""
        measured_ns = self._slope(self._points[:: max(len(self._points) // 10, 1)])
        for _ in range(2):  # the least delayed readings are seen better once the slope is
            measured_ns = self._slope(self._least_delayed(measured_ns))
        return measured_ns, min(self._known_ns, key=lambda known: abs(known - measured_ns))

    def _least_delayed(self, tick_ns: float) -> list[tuple[int, int]]:
        tenth = max(len(self._points) // 10, 1)
        tenths = (self._points[at : at + tenth] for at in range(0, len(self._points), tenth))
        return [min(part, key=lambda point: point[1] - point[0] * tick_ns) for part in tenths]

    @staticmethod
    def _slope(points: list[tuple[int, int]]) -> float:
        pairs = combinations(points, 2)
        slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairs if b[0] > a[0]]
        return median(slopes) if slopes else 0.0


class ArrivalClock:
    """Stamps for a device without a clock: its samples counted, the count held to the host's time.

    A phase-locked loop: bursts and jitter of arrival are smoothed to a 64th, and so is a lost sample.
    Without ``rate_hz`` the rate is learnt; for the first half second stamps are then arrival times.
    """

    _LEARN_NS = 500_000_000
    _PHASE, _RATE = 64, 8192

    def __init__(self, rate_hz: float | None = None) -> None:
        self._period_ns = 1e9 / rate_hz if rate_hz else 0.0
        self._first_ns = 0
        self._count = 0
        self._exact_ns = 0.0
        self._stamp_ns = 0

    def stamp(self, host_ns: int) -> int:
        """The next sample's time; increases strictly."""
        if self._count == 0:
            self._first_ns, self._exact_ns = host_ns, 0.0
        elapsed_ns = float(host_ns - self._first_ns)
        late_ns = elapsed_ns - self._exact_ns - self._period_ns
        if self._count and self._period_ns and abs(late_ns) <= GAP_NS:
            self._exact_ns += max(self._period_ns + late_ns / self._PHASE, 0.5 * self._period_ns)
            self._period_ns = max(self._period_ns + late_ns / self._RATE, 1.0)
        elif self._count:
            self._exact_ns = elapsed_ns
            if not self._period_ns and elapsed_ns >= self._LEARN_NS:
                self._period_ns = elapsed_ns / self._count
        self._count += 1
        stamp_ns = self._first_ns + round(self._exact_ns)
        self._stamp_ns = max(stamp_ns, self._stamp_ns + 1) if self._count > 1 else stamp_ns
        return self._stamp_ns
