"""Edge: where samples that others send wait for the walk: put in from any thread, read on one loop."""

from __future__ import annotations

import asyncio
import threading
import time
from collections import deque
from collections.abc import AsyncIterator, Callable, Mapping, Sequence

from app.formats.wire.stream import Counters
from app.motion.basics import Role, role_of
from app.motion.samples import Sample
from app.motion.source import Link, SourceInfo
from app.sources.source import Item, Live

#: Between two looks: a burst costs one turn of the loop, not one for each sample.
REST_S = 0.002
#: Between chances for the rest of the loop while a slow reader works off what waits.
BREATH = 32
#: Nothing for so long: the link counts as lost.
SILENT_S = 1.0
#: A sender that can wait is made to wait here.
FULL = 100_000
#: One that cannot wait (UDP) loses its oldest samples here: four hours of a foot at 100 Hz.
MOST = 1_500_000


class Inbox(Live):
    """A live source that is filled by ``put``. What it says of itself comes from ``told`` and ``line``."""

    def __init__(
        self,
        name: str,
        format_: str,
        told: Callable[[], Sequence[str]] = tuple,
        line: Callable[[], Mapping[str, int]] = dict,
        counters: Callable[[], Mapping[str, Counters]] = dict,
        temperatures: Callable[[], Mapping[str, float]] = dict,
    ) -> None:
        self._name, self._format = name, format_
        self._told, self._line, self._counters = told, line, counters
        self._temperatures = temperatures
        self._lock = threading.Lock()
        self._waiting: list[Sample] = []
        self._batch: deque[Sample] = deque()  # what is being read of them
        self._sensors: dict[str, Role] = {}
        self._overflowed = 0
        self._last_s: float | None = None
        self._left = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._news = asyncio.Event()
        self._woken = False

    def put(self, samples: Sequence[Sample]) -> None:
        """Hand samples over, from any thread; never waits. Once it is closed nothing is kept."""
        if not samples or self._left:
            return
        with self._lock:
            self._waiting += samples
            if len(self._waiting) > MOST:
                self._overflowed += len(self._waiting) // 2
                del self._waiting[: len(self._waiting) // 2]
            self._last_s = time.monotonic()
            for sample in samples:
                if sample.sensor not in self._sensors:
                    self._sensors = {**self._sensors, sample.sensor: role_of(sample.sensor)}
            wake = self._loop is not None and not self._woken
            self._woken = self._woken or wake
        if wake and self._loop is not None:
            try:
                self._loop.call_soon_threadsafe(self._news.set)
            except RuntimeError:  # the loop has ended: nobody reads any more
                self._loop = None

    @property
    def full(self) -> bool:
        """Whether a sender that can wait should."""
        return len(self._waiting) > FULL

    @property
    def info(self) -> SourceInfo:
        """Who has sent what so far."""
        line = {what: count for what, count in self._line().items() if count}
        if self._overflowed:
            line["came faster than the walk could take them"] = self._overflowed
        told, warmth = tuple(self._told()), self._temperatures()
        return SourceInfo(
            self._name, self._format, self._sensors, assumed=told, line=line, temperatures=warmth
        )

    @property
    def counters(self) -> Mapping[str, Counters]:
        """What became of the bytes."""
        return self._counters()

    @property
    def silent_s(self) -> float | None:
        """Seconds since the last sample; None before the first."""
        return None if self._last_s is None else time.monotonic() - self._last_s

    @property
    def link(self) -> Link:
        """Waiting for the first sample, live, or lost when no more come."""
        silent_s = self.silent_s
        if silent_s is None:
            return Link.WAITING
        return Link.LIVE if silent_s < SILENT_S else Link.LOST

    @property
    def detail(self) -> str:
        """What is being waited for."""
        if self.link is Link.LIVE:
            return ""
        return f"{self._name}: {'nobody sends yet' if self._last_s is None else 'nobody sends any more'}"

    def __aiter__(self) -> AsyncIterator[Item]:
        return self._read()

    async def _read(self) -> AsyncIterator[Item]:
        with self._lock:
            self._loop, self._news, self._woken = asyncio.get_running_loop(), asyncio.Event(), False
        while True:
            with self._lock:
                batch = self._batch = deque(self._waiting)
                self._waiting, self._woken = [], bool(batch)
                self._news.clear()
            came = len(batch)
            while batch:
                yield batch.popleft()
                if len(batch) % BREATH == 0:
                    await asyncio.sleep(0)
            if came:
                await asyncio.sleep(REST_S)
            else:
                await self._news.wait()

    def close(self) -> None:
        """Nobody reads any more: keep nothing that comes from now on."""
        self._left = True

    def unread(self) -> list[Sample]:
        """What came and was not read."""
        with self._lock:
            unread = [*self._batch, *self._waiting]
            self._batch, self._waiting = deque(), []
        return unread
