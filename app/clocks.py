"""Heart: a sensor's clock against the host's: offset and drift, told from delays that only ever add.

A sample arrives late, never early: bursts, a backlog and a slow network all lift ``host − device``, none
lowers it. So the line under all of them is the clock. Of each half second the least delayed sample is kept;
the line is the edge of their lower convex hull that passes under their middle, which is the line of least
total delay (Moon, Skelly, Towsley 1999). With a line for each sensor all of them share the host's clock.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import NamedTuple, Protocol

from app.motion import GAP_NS, Ints

BIN_NS = 500_000_000
#: Half seconds kept: a crystal's drift is steady for minutes, not for hours.
BINS = 600
#: A drift is told from this span on; before it, what was known is kept.
SETTLED_NS = 20_000_000_000
#: After a gap so many bins decide whether it is still the same clock.
TRIAL_BINS = 4
SAME_NS = 1_500_000
#: So far below the line no clock drifts in half a second: the host slept, or the device began anew.
JUMP_NS = 50_000_000


class Line(NamedTuple):
    """Where the device's clock showed ``device_ns`` the host's showed ``host_ns``, and how they part."""

    device_ns: int
    host_ns: int
    slope: float = 0.0  # host seconds gained on each device second

    def host(self, device_ns: int) -> int:
        """A device stamp on the host's clock, as if nothing had been delayed more than the least."""
        passed = device_ns - self.device_ns
        return self.host_ns + passed + round(passed * self.slope)

    @property
    def drift_ppm(self) -> float:
        """How much too fast the device's clock runs; negative: too slow."""
        return (1.0 / (1.0 + self.slope) - 1.0) * 1e6


SAME = Line(0, 0)


class Clock(Protocol):
    """What a sensor's store needs of its clock."""

    line: Line
    settled: bool  # whether the drift is known

    def add(self, device_ns: int, host_ns: int) -> None:
        """A sample and when it arrived."""


class KnownClock:
    """A recording's clock: its line is known, arrivals of a replay say nothing."""

    def __init__(self, line: Line = SAME) -> None:
        self.line = line
        self.settled = line != SAME

    def add(self, device_ns: int, host_ns: int) -> None:
        """Nothing to learn."""


class LiveClock:
    """A live sensor's clock, told from arrivals; O(1) a sample, at most ``BINS`` points in memory."""

    def __init__(self) -> None:
        self.line = SAME
        self.segments = 0  # times the clock began anew
        self._bins: deque[tuple[int, int]] = deque(maxlen=BINS)  # device, host − device
        self._before: deque[tuple[int, int]] | None = None  # on trial after a gap
        self._least: tuple[int, int] | None = None  # of the bin under way
        self._end_ns = 0  # of that bin
        self._last_ns = 0

    @property
    def settled(self) -> bool:
        """Whether the drift is told from the samples and not merely assumed."""
        bins = self._bins if self._before is None else self._before
        return len(bins) > 1 and bins[-1][0] - bins[0][0] >= SETTLED_NS

    def add(self, device_ns: int, host_ns: int) -> None:
        """A sample and when it arrived."""
        step_ns, self._last_ns = device_ns - self._last_ns, device_ns
        below_ns = self.line.host(device_ns) - host_ns
        if self._least is None:
            self._begin(device_ns, host_ns, drift=0.0)
        elif not 0 <= step_ns <= GAP_NS or below_ns > JUMP_NS:
            self._interrupt(device_ns, host_ns)
        elif below_ns > 0:
            self.line = Line(device_ns, host_ns, self.line.slope)
        if device_ns >= self._end_ns:
            self._close(device_ns)
        delay_ns = host_ns - device_ns
        if self._least is None or delay_ns < self._least[1]:
            self._least = (device_ns, delay_ns)

    def _begin(self, device_ns: int, host_ns: int, drift: float) -> None:
        self.line = Line(device_ns, host_ns, drift)
        self._bins.clear()
        self._least, self._end_ns = None, device_ns + BIN_NS

    def _interrupt(self, device_ns: int, host_ns: int) -> None:
        """A gap: the same clock goes on, or a device that began anew; some bins will tell."""
        if self._least is not None:
            self._bins.append(self._least)
        if self._before is None and self._bins:
            self._before = self._bins.copy()
        near = abs(self.line.host(device_ns) - host_ns) <= JUMP_NS
        line = self.line
        self._begin(device_ns, host_ns, self.line.slope)
        if near:
            self.line = line

    def _close(self, device_ns: int) -> None:
        """The bin is full: its least delayed sample joins the others, and the line is drawn anew."""
        if self._least is not None:
            self._bins.append(self._least)
        self._least, self._end_ns = None, max(self._end_ns + BIN_NS, device_ns + 1)
        if self._before is not None and len(self._bins) >= TRIAL_BINS:
            self._judge(self._before)
        self.line = lower_line(self._bins, self.line.slope) if self._before is None else self.line

    def _judge(self, before: deque[tuple[int, int]]) -> None:
        """Whether the bins since the gap lie on the line of those before it."""
        line = lower_line(before, self.line.slope)
        if abs(min(device + delay - line.host(device) for device, delay in self._bins)) <= SAME_NS:
            self._bins.extendleft(reversed(list(before)[-BINS + len(self._bins) :]))
        else:
            self.segments += 1
        self._before = None


def lower_line(points: Sequence[tuple[int, int]], known: float) -> Line:
    """The line under points of (device, host − device) ns, in the order of the device's time.

    Over less than ``SETTLED_NS`` the slope ``known`` is kept, and only the offset is told.
    """
    first_ns, last_ns = points[0][0], points[-1][0]
    if last_ns - first_ns < SETTLED_NS:
        device, delay = min(points, key=lambda point: point[1] - (point[0] - first_ns) * known)
        return Line(device, device + delay, known)
    middle_ns = sum(device for device, _ in points) // len(points)
    hull = _lower_hull(points)
    right = next(i for i in range(1, len(hull)) if hull[i][0] >= middle_ns)
    (device, delay), (device_2, delay_2) = hull[right - 1], hull[right]
    return Line(device, device + delay, (delay_2 - delay) / (device_2 - device))


def _lower_hull(points: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """The lower convex hull, left to right (Andrew's monotone chain)."""
    hull: list[tuple[int, int]] = []
    for x, y in points:
        while len(hull) > 1:
            (x0, y0), (x1, y1) = hull[-2], hull[-1]
            if (x1 - x0) * (y - y0) > (x - x0) * (y1 - y0):
                break
            hull.pop()
        hull.append((x, y))
    return hull


def recorded_line(device_ns: Ints, host_ns: Ints) -> Line:
    """The line of a whole recording's stamps [n], both int64."""
    clock = LiveClock()
    for device, host in zip(device_ns.tolist(), host_ns.tolist(), strict=True):
        clock.add(device, host)
    return clock.line
