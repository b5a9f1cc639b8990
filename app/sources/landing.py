"""Edge: where a seek in a recording can land: the newest saved state of every sensor, and the way to it."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from functools import cached_property

from app.formats.states import joined, read_state, read_way
from app.motion.estimate import Saved, Way
from app.motion.recording import Landing, Recording, Stretch
from app.sources.timeline import Timeline

#: A leap over less than this is not worth it.
LEAST_NS = 60_000_000_000


class Landings:
    """The saved states of one recording; ``key`` tells which were made by who reads them."""

    def __init__(self, recording: Recording, timeline: Timeline, key: bytes) -> None:
        journal = recording.journal
        self._timeline, self._key = timeline, key
        self._sensors = timeline.sensors()
        self._states = journal.states if journal else ()
        self._told_ways = journal.ways if journal else ()
        self._orders = sorted({place for place, _ in journal.orders}) if journal else []

    @cached_property
    def _ways(self) -> list[tuple[int, str, Way]]:
        read = ((place, sensor, read_way(data)) for place, sensor, data in self._told_ways)
        return [(place, sensor, way) for place, sensor, way in read if way is not None]

    def landing(self, first: int, last: int, host_ns: int) -> Landing | None:
        """From sample ``first`` to ``last``, or to the next order if it is sooner; None if not far."""
        order = bisect_right(self._orders, first)  # none is leapt over; those before have been taken
        last = min([last, *self._orders[order : order + 1]])
        if last <= first or self._timeline.elapsed_ns(last - 1) < self._timeline.elapsed_ns(first) + LEAST_NS:
            return None
        saved = {sensor: self._newest(sensor, first, last) for sensor in self._sensors}
        good = {sensor: state for sensor, state in saved.items() if state is not None}
        ways = {sensor: self._way(sensor, state.row, last) for sensor, state in good.items()}
        led = {sensor: way for sensor, way in ways.items() if way is not None}
        if len(led) < len(self._sensors):
            return None
        return Landing(
            self._timeline.stretch(first, last, host_ns), good, led, lambda: self._steps(first, last, host_ns)
        )

    def _newest(self, sensor: str, first: int, last: int) -> Saved | None:
        """The last state of a sensor between two samples."""
        found = [data for place, name, data in self._states if name == sensor and first < place <= last]
        return read_state(found[-1], self._key) if found else None

    def _way(self, sensor: str, row: int, last: int) -> Way | None:
        way = joined([way for place, name, way in self._ways if name == sensor and place <= last])
        return way if way is not None and way.last == row else None

    def _steps(self, first: int, last: int, host_ns: int) -> Iterator[Stretch]:
        while first < last:
            end = min(last, self._timeline.block_end(first))
            yield self._timeline.stretch(first, end, host_ns)
            first = end
