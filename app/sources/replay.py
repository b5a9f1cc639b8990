"""Edge: a recording played at its own pace, or faster: pause, step, seek, loop.

The playhead runs on the host's clock. Samples it has passed are released in bursts, at least
5 ms apart, and in the order of their stamps. A jump back starts the walk again from the first
sample, as fast as the reader takes them, because a walk is a fold over all its samples.
"""

from __future__ import annotations

import asyncio
import math
import time
from bisect import bisect_right
from collections.abc import AsyncIterator, Mapping, Sequence
from dataclasses import replace
from operator import itemgetter
from typing import Protocol

from app.formats.wire.stream import Counters
from app.motion.basics import InputError
from app.motion.commands import (
    ApplyCandidate,
    Command,
    DropCandidate,
    Loop,
    Order,
    Pause,
    ReplaceCandidate,
    ReplayCommand,
    RestartHere,
    Seek,
    SetApplyAtOnce,
    SetErrors,
    Speed,
    Step,
)
from app.motion.recording import Journal, Landing, Recording, Stretch
from app.motion.samples import Sample
from app.motion.source import Link, SourceInfo, Truth
from app.settings import Settings
from app.sources.landing import Landings
from app.sources.source import Item
from app.sources.spec import FASTEST, SLOWEST
from app.sources.timeline import Timeline

_BURST_NS = 5_000_000  # between wake-ups, and between chances for the rest of the loop
_CHUNK = 256  # samples made at once
#: Where sensors tell their own orientation, so many samples of a seek are given one by one: the walk by that
#: orientation is made of each. In a longer recording it begins where a seek lands.
MOST_ONE_BY_ONE = 60_000
#: A seek gives the first and the last samples one by one: what watches a stream tells by them.
WATCHED_NS = 12_000_000_000


class Clock(Protocol):
    """What a replay needs of time; a test brings its own."""

    def now_ns(self) -> int:
        """Monotonic nanoseconds."""

    async def wait(self, event: asyncio.Event, seconds: float | None) -> None:
        """Return when the event is set, or after ``seconds`` if given."""


class HostClock:
    """The machine's monotonic clock."""

    def now_ns(self) -> int:
        """Monotonic nanoseconds."""
        return time.monotonic_ns()

    async def wait(self, event: asyncio.Event, seconds: float | None) -> None:
        """Return when the event is set; after ``seconds`` it sets itself."""
        timer = None if seconds is None else asyncio.get_running_loop().call_later(seconds, event.set)
        try:
            await event.wait()
        finally:
            if timer:
                timer.cancel()


class Replay:
    """A source over a recording: iterate it once, steer it by ``control``.

    It yields samples, a recording's own orders between them (unless ``changes`` is off), and
    ``RestartHere`` before it begins anew. At the end it waits for a seek or
    a loop, unless ``finish`` is set. ``speed`` 0 is as fast as the reader takes them. With ``stretches``
    a long seek yields ``Stretch``, and with a ``key`` ``Landing`` where states were saved, not samples.
    """

    def __init__(
        self,
        recording: Recording,
        *,
        speed: float = 1.0,
        loop: bool = False,
        finish: bool = False,
        changes: bool = True,
        truth: Truth | None = None,
        clock: Clock | None = None,
        stretches: bool = False,
        key: bytes = b"",
    ) -> None:
        self.recording = recording
        self.replay = True
        self.detail = ""
        self.made_by = recording.spec
        self.counters: Mapping[str, Counters] = {}
        self.errors: Mapping[str, float] | None = None
        self._info = source_info(recording, truth)
        self._warmth = recording.journal.temperatures if recording.journal else ()
        self._warmth_told = 0  # of them, by ``info``
        self.speed = _checked_speed(speed)
        self.loop = loop
        self.paused = False
        self.ended = False
        self._finish = finish
        self._clock = clock or HostClock()
        self._timeline = Timeline(recording)
        self._journal = recording.journal if changes else None
        self._orders = orders_by_place(self._journal)
        self._places = sorted(self._orders)
        one_by_one = 0 < orientations(recording) <= MOST_ONE_BY_ONE
        self._stretches = stretches and not one_by_one
        keyed = bool(key) and not one_by_one
        self._landings = Landings(recording, self._timeline, key) if keyed and self._journal else None
        self._next = 0  # the first sample not yet released
        self._begun = False  # the playhead waits for the reader
        self._restart = False
        self._jump: tuple[int, int] | None = None  # release up to this sample at once; the playhead then
        self._anchor = (self._clock.now_ns(), 0)  # host time, playhead
        self._news = asyncio.Event()

    @property
    def info(self) -> SourceInfo:
        """What the recording says of itself, and what its sensors' thermometers read where it is."""
        told = bisect_right(self._warmth, self._next, key=itemgetter(0))
        if told != self._warmth_told:
            self._warmth_told = told
            warmth = {sensor: celsius for _, sensor, celsius in self._warmth[:told]}
            self._info = replace(self._info, temperatures=warmth)
        return self._info

    @property
    def settings(self) -> Settings | None:
        """What the recorded walk began with, if it is to be repeated with its changes."""
        return self._journal.settings if self._journal else None

    @property
    def link(self) -> Link:
        """Whether it plays."""
        if self._next == 0:
            return Link.WAITING
        if self.paused:
            return Link.PAUSED
        return Link.ENDED if self.ended else Link.LIVE

    @property
    def duration_s(self) -> float:
        """Seconds from the first sample to the last."""
        return self._timeline.duration_ns * 1e-9

    @property
    def position_s(self) -> float:
        """Where the playhead is, in seconds from the first sample."""
        return max(self._playhead_ns(), 0) * 1e-9

    def control(self, command: ReplayCommand) -> None:
        """Take a command, at once; to be called on the loop that reads. Bad values raise ``InputError``."""
        match command:
            case Pause(on):
                self._move_anchor(self._playhead_ns())
                self.paused = on
            case Speed(factor):
                _checked_speed(factor)
                self._move_anchor(self._playhead_ns())
                self.speed = factor
            case Seek(t_s):
                self._seek(t_s)
            case Step(samples):
                self._step(samples)
            case Loop(on):
                self.loop = on
            case SetErrors():
                raise InputError("errors can be set for a simulated sensor only, this is a recording")
        self._news.set()

    def __aiter__(self) -> AsyncIterator[Item]:
        return self._play()

    def close(self) -> None:
        """Nothing is held open."""

    def unread(self) -> Sequence[Sample]:
        """Nothing: it brings what is asked for."""
        return ()

    async def _play(self) -> AsyncIterator[Item]:
        for order in opening_orders(self._journal, anew=False):
            yield order
        self._move_anchor(self._playhead_ns())
        self._begun = True
        breath_ns = self._clock.now_ns()
        while True:
            self._news.clear()
            if self._restart:
                self._begin_anew()
                yield RestartHere()
                for order in opening_orders(self._journal, anew=True):
                    yield order
            now_ns = self._clock.now_ns()
            for item in self._out(now_ns):
                for order in self._orders.get(self._next, ()):
                    yield order
                self._next += 1 if isinstance(item, Sample) else len(item)
                yield item
                if self._at_end():
                    for order in self._orders.get(self._next, ()):
                        yield order
                if self._clock.now_ns() - breath_ns > _BURST_NS:
                    await asyncio.sleep(0)
                    breath_ns = self._clock.now_ns()
                if self._news.is_set():
                    break
            self._land()
            if self._news.is_set() or self._next < self._due():
                continue
            if self._at_end() and self._finish and not self.paused and not self.loop:
                self.ended = True
                return
            await self._rest()
            breath_ns = self._clock.now_ns()

    def _out(self, now_ns: int) -> Sequence[Sample | Stretch | Landing]:
        """Some of what is due: a stretch up to the next order or block where there is far to go."""
        first, due = self._next, self._due()
        far = self._timeline.due(self._timeline.elapsed_ns(due - 1) - WATCHED_NS) if due > first else first
        early = self._timeline.elapsed_ns(min(first, due - 1)) < WATCHED_NS
        if not self._stretches or self._jump is None or early or far - first <= _CHUNK:
            return self._timeline.cut(first, min(due, first + _CHUNK), now_ns) if due > first else ()
        landing = self._landings and self._landings.landing(first, far, now_ns)
        if landing:
            return (landing,)
        place = bisect_right(self._places, first)
        order = self._places[place] if place < len(self._places) else far
        return (self._timeline.stretch(first, min(far, order, self._timeline.block_end(first)), now_ns),)

    # --- the playhead ---

    def _playhead_ns(self) -> int:
        if self._jump:
            return self._jump[1]
        host_ns, position_ns = self._anchor
        if self._begun and not self.paused and self.speed > 0.0:
            position_ns += int((self._clock.now_ns() - host_ns) * self.speed)
        elif not self.paused and self._next:
            position_ns = max(position_ns, self._timeline.elapsed_ns(self._next - 1))
        return min(position_ns, self._timeline.duration_ns)

    def _move_anchor(self, position_ns: int) -> None:
        self._anchor = (self._clock.now_ns(), position_ns)

    def _due(self) -> int:
        """How many samples should be out by now."""
        if self._jump:
            return self._jump[0]
        if self.paused:
            return self._next
        if self.speed == 0.0:
            return len(self._timeline)
        return max(self._timeline.due(self._playhead_ns()), self._next)

    # --- jumps ---

    def _seek(self, t_s: float) -> None:
        if not math.isfinite(t_s):
            raise InputError(f"seek to {t_s}: expected 0 to {self.duration_s:.1f} s")
        position_ns = round(min(max(t_s, 0.0), self.duration_s) * 1e9)
        self._jump_to(self._timeline.due(position_ns), position_ns)

    def _step(self, samples: int) -> None:
        """On by a few samples, from where a jump under way will land."""
        if self.paused and samples > 0:
            start = self._jump[0] if self._jump else self._next
            index = min(start + samples, len(self._timeline))
            self._jump_to(index, self._timeline.elapsed_ns(index - 1))

    def _jump_to(self, index: int, position_ns: int) -> None:
        self._restart = self._restart or index < self._next
        self._jump = (index, position_ns)

    def _land(self) -> None:
        """At the end of a jump the playhead goes on from where the jump led."""
        if self._jump and self._next >= self._jump[0] and not self._restart:
            position_ns = self._jump[1]
            self._jump = None
            self._move_anchor(position_ns)

    def _begin_anew(self) -> None:
        self._restart = False
        self.ended = False
        self._next = 0

    # --- the end, and waiting ---

    def _at_end(self) -> bool:
        return self._next >= len(self._timeline)

    async def _rest(self) -> None:
        """Wait for the next sample's time or for a command; at the end, begin anew or wait for one."""
        if self._at_end() and self.loop and not self.paused:
            self._restart = True
            self._move_anchor(-self._timeline.interval_ns)
            await asyncio.sleep(0)
        elif self._at_end() or self.paused:
            self.ended = self._at_end()
            await self._clock.wait(self._news, None)
        else:
            await self._clock.wait(self._news, self._seconds_to_next())

    def _seconds_to_next(self) -> float:
        ahead_ns = self._timeline.elapsed_ns(self._next) - self._playhead_ns()
        return max(ahead_ns / self.speed, _BURST_NS) * 1e-9


def orientations(recording: Recording) -> int:
    """How many samples come from sensors that tell their own orientation."""
    return sum(len(samples) for samples in recording.sensors if samples.device_q_nb is not None)


def orders_by_place(journal: Journal | None) -> dict[int, list[Order]]:
    """A recording's orders by the number of samples before them."""
    orders: dict[int, list[Order]] = {}
    for place, order in journal.orders if journal else ():
        orders.setdefault(place, []).append(order)
    return orders


def opening_orders(journal: Journal | None, anew: bool) -> list[Order]:
    """What brings a session to where a recording began: ``anew``, whatever was done to it meanwhile."""
    if journal is None:
        return []
    commands: list[Command] = []
    if anew:
        commands += [SetApplyAtOnce(False), DropCandidate()]
        commands += [ReplaceCandidate(journal.settings, "as recorded"), ApplyCandidate()]
    if journal.candidate != journal.settings:
        commands.append(ReplaceCandidate(journal.candidate, "as recorded"))
    if journal.apply_at_once:
        commands.append(SetApplyAtOnce(True))
    return [Order(command, "recording", 0) for command in commands]


def source_info(recording: Recording, truth: Truth | None = None) -> SourceInfo:
    """What a recording says of itself."""
    return SourceInfo(
        name=recording.name,
        format=recording.format,
        sensors={samples.sensor: samples.role for samples in recording.sensors},
        rate_hz=max(samples.rate_hz for samples in recording.sensors),
        assumed=recording.assumed,
        dropped=recording.dropped,
        duration_s=recording.duration_s,
        truth=truth,
        clocks=recording.clocks,
        serials=recording.serials,
        rod_m=recording.rod_m,
    )


def _checked_speed(factor: float) -> float:
    if factor != 0.0 and not SLOWEST <= factor <= FASTEST:
        raise InputError(
            f"speed {factor:g}: expected {SLOWEST:g} to {FASTEST:g}, or 0 for as fast as possible"
        )
    return factor
