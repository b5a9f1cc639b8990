"""Shell: one source being walked: its samples, corrected, onto the disk and into the session."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable
from dataclasses import replace

from app.clocks import Clock, clock_for
from app.motion.basics import InputError, Role, role_of
from app.motion.commands import Order, RestartHere
from app.motion.recording import Landing, Stretch
from app.motion.samples import Sample
from app.motion.source import Link, SourceInfo
from app.motion.status import Status
from app.session import Session
from app.settings import Settings
from app.shell.before import Before
from app.shell.early import Early
from app.shell.remembering import Remembering
from app.shell.taping import Taping
from app.sources.source import Source

log = logging.getLogger(__name__)

#: Between looks while no more can wait for the session.
PAUSE_S = 0.02


class Walk:
    """A source and its session. Where another source comes, this ends and another walk begins."""

    def __init__(
        self, source: Source, settings: Settings, budget_bytes: int, epoch: int, taping: Taping
    ) -> None:
        """``epoch`` is that of the session when it begins; ``settings`` unless the source has its own."""
        self.source = source
        self.before = Before(lambda: source.info, taping.preflight)
        self.remembering = Remembering(lambda: source.info, self.before.calibrated)
        self.last_sample_s = time.monotonic()
        self._came = 0  # samples
        self._taping = taping
        self._early = Early(self._take_waiting)
        info = source.info
        self.session = Session(
            source.settings or settings, self._role, info.truth, budget_bytes, self._clock, epoch, info.rod_m
        )

    @property
    def info(self) -> SourceInfo:
        """What the source says of itself, and which sensor is which foot, as a tap told."""
        info = self.source.info
        return replace(info, sensors={**info.sensors, **self.before.names})

    def close(self) -> None:
        """Let go of the source, with what it had still on the disk; keep what was learnt of its sensors."""
        self.remembering.keep(self.session)
        self.source.close()
        for sample in self.source.unread():
            if self._taping.on:
                self._recorded(sample)

    def apply(self, order: Order) -> None:
        """Apply it, and record it: one that is refused is refused again in a replay."""
        if self._early:  # behind the samples that came before it
            self._early.add(order)
            self._taping.order(order, len(self._early))
            return
        try:
            self.session.apply(order)
        finally:
            self._taping.order(order)

    def record(self, spec: str) -> None:
        """Begin to record it, as what it was opened by, with all that the session has not had yet."""
        told = self.remembering.told
        if not self._taping.start(self.source, spec, told):
            return
        for place, item in enumerate(self._early, start=1):
            if isinstance(item, Sample):
                self._taping.sample(item)
            elif item not in told:
                self._taping.order(item, place)

    @property
    def behind(self) -> bool:
        """Whether something is recorded that the session has not had yet."""
        return bool(self._early)

    def told(self, status: Status) -> Status:
        """The status with what is known of the source now."""
        source = self.source
        silent = time.monotonic() - self.last_sample_s
        return replace(
            status,
            source=source.info,
            link=source.link,
            detail=source.detail,
            replay=source.replay,
            stale_s=silent if source.link in (Link.LIVE, Link.LOST) else 0.0,
            speed=source.speed,
            loop=source.loop,
            position_s=source.position_s,
            errors=source.errors,
        )

    def health(self) -> dict[str, object]:
        """For /healthz; read on the door's thread, so only what is one read."""
        line = {sensor: vars(counters) for sensor, counters in self.source.counters.items()}
        return {"link": self.source.link.value, "taken": self._came, "line": line}

    async def read(
        self,
        obey: Callable[[Order], None],
        changed: Callable[[], None],
        fill: Callable[[Session], None],
        prepared: asyncio.Task[None],
    ) -> None:
        """All that the source brings. ``changed``: there is something to draw; ``fill``: after a landing.

        What a sensor sends is recorded at once and taken when all is ``prepared``; a replay waits for that.
        """
        release = self._early.release(prepared, changed)
        if self.source.replay:
            await release
            await self._read(obey, changed, fill)
        else:
            await asyncio.gather(release, self._read(obey, changed, fill))

    async def _read(
        self,
        obey: Callable[[Order], None],
        changed: Callable[[], None],
        fill: Callable[[Session], None],
    ) -> None:
        async for item in self.source:
            if isinstance(item, RestartHere):
                obey(Order(item, "replay", time.monotonic_ns()))
                self._taping.begin(self.remembering.told)
            elif isinstance(item, Order):
                obey(item)
            elif isinstance(item, Stretch):
                await self._take_stretch(item, changed)
            elif isinstance(item, Landing):
                if self._land(item):
                    fill(self.session)
                else:
                    for stretch in item.steps():
                        await self._take_stretch(stretch, changed)
                        await asyncio.sleep(0)
            else:
                self._take_sample(item)
            changed()
            while self._early.full:
                await asyncio.sleep(PAUSE_S)

    def _recorded(self, sample: Sample) -> Sample:
        """The sample as it is taken, on the disk."""
        self._came += 1
        sample = self.before.sample(sample)
        if (known := self.remembering.order(sample.sensor)) is not None:
            self.apply(known)
        self._taping.sample(sample)
        return sample

    def _take_sample(self, sample: Sample) -> None:
        sample = self._recorded(sample)
        self.last_sample_s = time.monotonic()
        if self._early.holds:
            self._early.add(sample)
        else:
            self.session.take(sample)

    def _take_waiting(self, item: Sample | Order) -> None:
        """One that is recorded already."""
        if isinstance(item, Sample):
            self.session.take(item)
            return
        try:
            self.session.apply(item)
        except InputError as error:
            log.warning("%s", error)

    def _land(self, landing: Landing) -> bool:
        """Show a far place at once; a recording of it wants every sample."""
        if self._taping.on or self.before.wants_each or not self.session.land(landing):
            return False
        self._came += len(landing)
        self.last_sample_s = time.monotonic()
        return True

    async def _take_stretch(self, stretch: Stretch, changed: Callable[[], None]) -> None:
        if self.before.wants_each:
            for sample in stretch.each():
                self._take_sample(sample)
            changed()
        else:
            self._came += len(stretch)
            self.session.take_stretch(stretch)
            self.last_sample_s = time.monotonic()
            changed()
            await self._taping.stretch(stretch)

    def _role(self, sensor: str) -> Role:
        named = self.before.names.get(sensor)
        return named or self.source.info.sensors.get(sensor) or role_of(sensor)

    def _clock(self, sensor: str) -> Clock:
        return clock_for(self.source.info, sensor)
