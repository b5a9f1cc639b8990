"""Heart: a sensor's clock against the host's: offset and drift, told from delays that only ever add.

A sample arrives late, never early: bursts, a backlog and a slow network all lift ``host − device``, none
lowers it. So the line under all of them is the clock. Of each half second the least delayed sample is kept;
the line is the edge of their lower convex hull that passes under their middle, which is the line of least
total delay (Moon, Skelly, Towsley 1999). With a line for each sensor all of them share the host's clock.
"""

from __future__ import annotations

from bisect import bisect_left
from typing import Protocol

import numpy as np

from app.motion.basics import Ints
from app.motion.samples import GAP_NS, ClockLine
from app.motion.source import SourceInfo

BIN_NS = 500_000_000
#: Half seconds kept: a crystal's drift is steady for minutes, not for hours.
BINS = 600
#: Of a whole recording one sample in so long is looked at; shorter than the shortest gap.
THINNED_NS = 100_000_000
#: A drift is told from this span on; before it, what was known is kept.
SETTLED_NS = 20_000_000_000
#: After a gap so many bins decide whether it is still the same clock.
TRIAL_BINS = 4
SAME_NS = 1_500_000
#: So far below the line no clock drifts in half a second: the host slept, or the device began anew.
JUMP_NS = 50_000_000
#: More than this is no clock's drift.
NO_CRYSTAL = 0.02


SAME = ClockLine(0, 0)
Point = tuple[int, int]


class Clock(Protocol):
    """What a sensor's store needs of its clock."""

    line: ClockLine

    @property
    def settled(self) -> bool:
        """Whether the drift is known."""

    def add(self, device_ns: int, host_ns: int) -> None:
        """A sample and when it arrived."""


class FixedClock:
    """A clock whose line is given (a recording's), or that nobody reads: arrivals say nothing."""

    def __init__(self, line: ClockLine = SAME) -> None:
        self.line = line

    @property
    def settled(self) -> bool:
        """Whether it was recorded."""
        return self.line.slope != 0.0

    def add(self, device_ns: int, host_ns: int) -> None:
        """Nothing to learn."""


class LiveClock:
    """A live sensor's clock, told from arrivals; O(1) a sample, at most ``BINS`` points in memory."""

    def __init__(self) -> None:
        self.line = SAME
        self.segments = 0  # times the clock began anew
        self._bins = Hull()
        self._before: Hull | None = None  # of before a gap, on trial
        self._least: tuple[int, int] | None = None  # of the bin under way
        self._end_ns = 0  # of that bin
        self._last_ns = 0

    @property
    def settled(self) -> bool:
        """Whether the drift is told from the samples and not merely assumed."""
        bins = self._bins if self._before is None else self._before
        return bins.span_ns >= SETTLED_NS

    def add(self, device_ns: int, host_ns: int) -> None:
        """A sample and when it arrived."""
        step_ns, self._last_ns = device_ns - self._last_ns, device_ns
        below_ns = self.line.host(device_ns) - host_ns
        if self._least is None:
            self._begin(device_ns, host_ns, drift=0.0)
        elif not 0 <= step_ns <= GAP_NS or below_ns > JUMP_NS:
            self._interrupt(device_ns, host_ns)
        elif below_ns > 0:
            self.line = ClockLine(device_ns, host_ns, self.line.slope)
        if device_ns >= self._end_ns:
            self._close(device_ns)
        delay_ns = host_ns - device_ns
        if self._least is None or delay_ns < self._least[1]:
            self._least = (device_ns, delay_ns)

    def _begin(self, device_ns: int, host_ns: int, drift: float) -> None:
        self.line = ClockLine(device_ns, host_ns, drift)
        self._bins = Hull()
        self._least, self._end_ns = None, device_ns + BIN_NS

    def _interrupt(self, device_ns: int, host_ns: int) -> None:
        """A gap: the same clock goes on, or a device that began anew; some bins will tell."""
        if self._least is not None:
            self._bins.add(self._least)
        if self._before is None and self._bins.points:
            self._before = self._bins
        near = abs(self.line.host(device_ns) - host_ns) <= JUMP_NS
        line = self.line
        self._begin(device_ns, host_ns, self.line.slope)
        if near:
            self.line = line

    def _close(self, device_ns: int) -> None:
        """The bin is full: its least delayed sample joins the others, and the line is drawn anew."""
        if self._least is not None:
            self._bins.add(self._least)
        self._least, self._end_ns = None, max(self._end_ns + BIN_NS, device_ns + 1)
        if self._before is not None and len(self._bins.points) >= TRIAL_BINS:
            self._judge(self._before)
        if self._before is None:
            self.line = self._bins.line(self.line.slope)

    def _judge(self, before: Hull) -> None:
        """Whether the bins since the gap lie on the line of those before it."""
        line = before.line(self.line.slope)
        since, self._before = self._bins.points, None
        if abs(min(device + delay - line.host(device) for device, delay in since)) > SAME_NS:
            self.segments += 1
            return
        for point in since:
            before.add(point)
        self._bins = before


class Hull:
    """Points of (device, host − device) ns in the device's order, and the lower edge of them.

    A point costs O(1), amortised: the hull grows at its end, and is made anew when the oldest go.
    """

    def __init__(self) -> None:
        self.points: list[Point] = []
        self._edge: list[Point] = []

    @property
    def span_ns(self) -> int:
        """From the first point to the last."""
        return self.points[-1][0] - self.points[0][0] if self.points else 0

    def add(self, point: Point) -> None:
        """One more, later than all before; over ``BINS`` and a quarter the oldest quarter goes."""
        self.points.append(point)
        self._extend(point)
        if len(self.points) > BINS + BINS // 4:
            del self.points[: BINS // 4]
            self._edge.clear()
            for kept in self.points:
                self._extend(kept)

    def _extend(self, point: Point) -> None:
        """Andrew's monotone chain: whatever lies above the new edge is none of it."""
        edge, (x, y) = self._edge, point
        while len(edge) > 1:
            (x0, y0), (x1, y1) = edge[-2], edge[-1]
            if (x1 - x0) * (y - y0) > (x - x0) * (y1 - y0):
                break
            edge.pop()
        edge.append(point)

    def line(self, known: float) -> ClockLine:
        """The line under all points. Over less than ``SETTLED_NS`` the slope ``known`` is kept."""
        first_ns = self.points[0][0]
        if self.span_ns < SETTLED_NS:
            device, delay = min(self.points, key=lambda point: point[1] - (point[0] - first_ns) * known)
            return ClockLine(device, device + delay, known)
        right = bisect_left(self._edge, (first_ns + self.span_ns // 2, 0))
        (device, delay), (device_2, delay_2) = self._edge[right - 1], self._edge[right]
        return ClockLine(device, device + delay, (delay_2 - delay) / (device_2 - device))


def recorded_line(device_ns: Ints, host_ns: Ints) -> ClockLine:
    """The line of a whole recording's stamps [n], both int64.

    One that no crystal could draw (a replay at another speed was recorded) tells only the beginning.
    """
    span, arrived = int(device_ns[-1] - device_ns[0]), int(host_ns[-1] - host_ns[0])
    if span > SETTLED_NS and abs(arrived - span) > NO_CRYSTAL * span:
        return ClockLine(int(device_ns[0]), int(host_ns[0]))
    clock = LiveClock()
    rows = _least_delayed(device_ns, host_ns)
    for device, host in zip(device_ns[rows].tolist(), host_ns[rows].tolist(), strict=True):
        clock.add(device, host)
    if abs(clock.line.slope) > NO_CRYSTAL:
        return ClockLine(int(device_ns[0]), int(host_ns[0]))
    return clock.line


def _least_delayed(device_ns: Ints, host_ns: Ints) -> Ints:
    """The least delayed sample of each tenth of a second: the others lie above it and say nothing."""
    piece = device_ns // THINNED_NS
    order = np.lexsort((host_ns - device_ns, piece))
    first = np.flatnonzero(np.diff(piece[order], prepend=piece[order[:1]] - 1))
    return np.sort(order[first])


def clock_for(info: SourceInfo, sensor: str) -> Clock:
    """The clock of one of a source's sensors: learnt from a live one, known of a recording."""
    return LiveClock() if info.duration_s is None else FixedClock(info.clocks.get(sensor, SAME))
