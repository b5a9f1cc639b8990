"""Edge: a replay of a simulated sensor whose errors may change while it plays."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterable
from dataclasses import asdict, replace
from typing import Any

from app.motion.basics import InputError
from app.motion.commands import ReplayCommand, SetErrors
from app.motion.recording import Recording, Stretch
from app.motion.samples import Sample
from app.simulate.lab import PERFECT, Lab
from app.sources.replay import Replay
from app.sources.source import Item


class Laboratory(Replay):
    """The same replay, its samples spoilt on their way out; at first they are as simulated."""

    def __init__(self, recording: Recording, seed: int = 0, **playing: Any) -> None:
        """``seed``: of the errors that chance has a part in; ``playing``: as a ``Replay`` takes it."""
        super().__init__(recording, **playing)
        self._info = replace(self._info, seed=seed)
        self._lab = Lab(seed)
        self.errors = asdict(PERFECT)

    def control(self, command: ReplayCommand) -> None:
        """As a replay, and the sensor's errors."""
        if not isinstance(command, SetErrors):
            return super().control(command)
        try:
            self._lab.errors = self._lab.errors.with_changes(dict(command.changes))
        except ValueError as error:
            raise InputError(str(error)) from None
        self.errors = asdict(self._lab.errors)
        return None

    async def _play(self) -> AsyncIterator[Item]:
        async for item in super()._play():
            if self._lab.errors == PERFECT or not isinstance(item, Sample | Stretch):
                yield item
                continue
            for sample in self._spoilt([item] if isinstance(item, Sample) else item.each()):
                yield sample

    def _spoilt(self, samples: Iterable[Sample]) -> Iterable[Sample]:
        return (read for read in map(self._lab.spoil, samples) if read is not None)
