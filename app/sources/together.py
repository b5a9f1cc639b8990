"""Edge: several live sources as one, such as a sensor on each foot."""

from __future__ import annotations

from collections.abc import AsyncIterator, Mapping, Sequence

from app.formats.wire.stream import Counters
from app.motion import Link, Sample, SourceInfo
from app.sources.mailbox import Mailbox
from app.sources.source import Item, Live, Source

#: The link of all is the worst of each: what stands first here.
_WORST = (Link.LOST, Link.WAITING, Link.LIVE)


class Together(Live):
    """Live sources whose sensors have different names, read side by side."""

    def __init__(self, sources: Sequence[Source]) -> None:
        self._sources = tuple(sources)
        self._inbox = Mailbox()

    @property
    def info(self) -> SourceInfo:
        """All sensors; what is assumed stands with its foot's name."""
        infos = [source.info for source in self._sources]
        formats = sorted({info.format for info in infos})
        dropped: dict[str, int] = {}
        for info in infos:
            for reason, count in info.dropped.items():
                dropped[reason] = dropped.get(reason, 0) + count
        return SourceInfo(
            name=", ".join(info.name for info in infos),
            format=" and ".join(formats),
            sensors={sensor: role for info in infos for sensor, role in info.sensors.items()},
            rate_hz=max(info.rate_hz for info in infos),
            assumed=tuple(f"{_names(info)}: {sentence}" for info in infos for sentence in info.assumed),
            dropped=dropped,
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
        return self._inbox.items(*map(self._take, self._sources))

    def close(self) -> None:
        """Let go of all."""
        for source in self._sources:
            source.close()

    async def _take(self, source: Source) -> None:
        async for item in source:
            if isinstance(item, Sample):  # a live source gives nothing else
                self._inbox.put((item,))


def _names(info: SourceInfo) -> str:
    return " and ".join(info.sensors)
