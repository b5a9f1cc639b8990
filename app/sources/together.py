"""Edge: several live sources as one, such as a sensor on each foot."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Iterable, Mapping, Sequence

from app.formats.wire.stream import Counters
from app.motion.samples import Sample
from app.motion.source import Link, SourceInfo
from app.sources.inbox import Inbox
from app.sources.source import Item, Live, Source

log = logging.getLogger(__name__)

#: The link of all is the worst of each: what stands first here.
_WORST = (Link.LOST, Link.WAITING, Link.LIVE)


class Together(Live):
    """Live sources whose sensors have different names, read side by side."""

    def __init__(self, sources: Sequence[Source]) -> None:
        self._sources = tuple(sources)
        self._inbox = Inbox("together", "")

    @property
    def info(self) -> SourceInfo:
        """All sensors; what is assumed stands with its foot's name."""
        infos = [source.info for source in self._sources]
        formats = sorted({info.format for info in infos})
        return SourceInfo(
            name=", ".join(info.name for info in infos),
            format=" and ".join(formats),
            sensors={sensor: role for info in infos for sensor, role in info.sensors.items()},
            rate_hz=max(info.rate_hz for info in infos),
            assumed=tuple(f"{_names(info)}: {sentence}" for info in infos for sentence in info.assumed),
            dropped=summed(info.dropped for info in infos),
            line=summed(info.line for info in infos),
            places={sensor: info.name for info in infos for sensor in info.sensors},
            temperatures={sensor: c for info in infos for sensor, c in info.temperatures.items()},
            serials={sensor: serial for info in infos for sensor, serial in info.serials.items()},
        )

    @property
    def link(self) -> Link:
        """The worst of all."""
        return min((source.link for source in self._sources), key=_WORST.index)

    @property
    def detail(self) -> str:
        """What each says, once where all say the same."""
        told = [(_names(source.info), source.detail) for source in self._sources if source.detail]
        if len({detail for _, detail in told}) == 1 and len(told) == len(self._sources):
            return told[0][1]
        return "; ".join(f"{names}: {detail}" for names, detail in told)

    @property
    def counters(self) -> Mapping[str, Counters]:
        """Of every sensor."""
        return {sensor: kept for source in self._sources for sensor, kept in source.counters.items()}

    def __aiter__(self) -> AsyncIterator[Item]:
        return self._read()

    def close(self) -> None:
        """Let go of all."""
        for source in self._sources:
            source.close()

    def unread(self) -> list[Sample]:
        """What came and was not read."""
        return [*self._inbox.unread(), *(sample for source in self._sources for sample in source.unread())]

    async def _read(self) -> AsyncIterator[Item]:
        tasks = [asyncio.create_task(self._take(source)) for source in self._sources]
        try:
            async for item in self._inbox:
                yield item
        finally:
            for task in tasks:
                task.cancel()

    async def _take(self, source: Source) -> None:
        try:
            async for item in source:
                if isinstance(item, Sample):  # a live source gives nothing else
                    self._inbox.put((item,))
        except Exception:
            log.exception("%s failed", source.info.name)


def summed(each: Iterable[Mapping[str, int]]) -> dict[str, int]:
    """Counts by their words, added up."""
    total: dict[str, int] = {}
    for counts in each:
        for words, count in counts.items():
            total[words] = total.get(words, 0) + count
    return total


def _names(info: SourceInfo) -> str:
    return " and ".join(info.sensors)
