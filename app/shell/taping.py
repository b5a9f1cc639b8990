"""Shell: the recording beside the walk: begun and ended by a button, or from the beginning."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterable
from pathlib import Path

from app.formats.journal import Start
from app.home.key import key
from app.motion.basics import InputError
from app.motion.commands import Order
from app.motion.recording import Stretch
from app.motion.samples import Sample
from app.motion.snapshot import FootView
from app.motion.source import SourceInfo
from app.motion.status import RecorderState
from app.outputs.recorder import Recorder
from app.saving import Saver
from app.session import Session
from app.sources.source import Source

#: Where a foot is drawn is recorded this often.
POSES_S = 0.04
#: A seek waits while so much waits for the disk.
MOST_WAITING = 50_000


class Taping:
    """What is recorded of the session there is now, if anything."""

    def __init__(self, folder: Path, profile: str, session: Callable[[], Session]) -> None:
        """``profile`` is the name of the settings that the walk began with."""
        self._folder, self._profile, self._session = folder, profile, session
        self._recorder: Recorder | None = None
        self._last: RecorderState | None = None
        self._saver = Saver()
        self._posed_s = 0.0
        self._strides: dict[str, tuple[int, int]] = {}  # epoch and number of the last stride recorded

    @property
    def on(self) -> bool:
        """Whether there is a recording under way."""
        return self._recorder is not None

    @property
    def state(self) -> RecorderState | None:
        """Of the recording under way, or the last one."""
        return self._recorder.state if self._recorder is not None else self._last

    def start(self, source: Source, spec: str, told: Iterable[Order]) -> bool:
        """Begin, unless it runs, and say whether; ``told`` are the orders that the walk began with."""
        if self._recorder is not None and not self._recorder.on:
            self.stop()
        if self._recorder is not None:
            return False
        self._recorder = Recorder(self._folder, self._profile, spec, source.info, source.made_by, key=key())
        self.begin(told)
        return True

    def begin(self, told: Iterable[Order]) -> None:
        """The walk, or its source, begins here: what a walk that is recorded from here begins with."""
        if self._recorder is not None:
            now = self._session().snapshot()
            self._recorder.start(Start(now.main.settings, now.candidate_settings, now.apply_at_once))
            for order in told:
                self.order(order)
            self._saver.begin(self._session())

    def stop(self) -> None:
        """Close the file."""
        if self._recorder is not None:
            self._recorder.close()
            self._last, self._recorder = self._recorder.state, None

    # --- what comes ----------------------------------------------------------------------------------

    def sample(self, sample: Sample) -> None:
        """One that the session has taken."""
        if self._recorder is not None:
            self._recorder.sample(sample)

    async def stretch(self, stretch: Stretch) -> None:
        """Many of them, no faster than the disk takes them."""
        if self._recorder is not None:
            for sample in stretch.each():
                self._recorder.sample(sample)
        while self._recorder is not None and self._recorder.on and self._recorder.waiting > MOST_WAITING:
            await asyncio.sleep(0.01)

    def order(self, order: Order, waiting: int = 0) -> None:
        """One that the session was given, or will be as the last of so many that are ``waiting`` for it."""
        if self._recorder is not None:
            self._recorder.order(self._session().number + waiting, order)

    def mark(self, who: str, text: str) -> None:
        """Mark this moment."""
        if self._recorder is None:
            raise InputError("no recording to mark: start one first")
        self._recorder.marker(who, text)

    def preflight(self, told: str) -> None:
        """What the look before the walk came to."""
        if self._recorder is not None:
            self._recorder.marker("pre-flight", told)

    def walk(self, info: SourceInfo, feet: tuple[FootView, ...] | None) -> None:
        """Where the feet are drawn, and the strides that ended since the last look.

        None: the session is behind what is recorded, where its estimate would stand in the wrong place.
        """
        if self._recorder is None or time.monotonic() < self._posed_s + POSES_S:
            return
        self._posed_s = time.monotonic()
        self._recorder.learn(info)
        if feet is None:
            return
        session = self._session()
        for foot in feet:
            self._recorder.pose(foot.sensor, foot.position_n, foot.q_nb)
            for stride in session.main.feet[foot.sensor].settled_strides(4):
                if (session.epoch, stride.number) > self._strides.get(foot.sensor, (0, -1)):
                    self._strides[foot.sensor] = (session.epoch, stride.number)
                    self._recorder.stride(foot.sensor, stride)
        for due in self._saver.due(session):
            self._recorder.estimate(*due)
