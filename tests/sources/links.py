"""What the tests of live links share: samples to send, and a reader of a source."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from app.motion.samples import Sample
from app.sources.source import Source

STEP_NS = 2_500_000


def walk(count: int, sensor: str = "left", first: int = 0) -> list[Sample]:
    """Samples whose numbers can be told apart, 400 a second."""
    return [
        Sample(sensor, i, i * STEP_NS, 0, (0.001 * i, 0.2, -9.8), (0.0, 0.1, 0.01), (20.0, 0.0, 44.0))
        for i in range(first, first + count)
    ]


class Reader:
    """Reads a source in a task, as the walk does."""

    def __init__(self, source: Source) -> None:
        self.got: list[Sample] = []
        self._source = source
        self._task = asyncio.create_task(self._read())

    async def _read(self) -> None:
        async for item in self._source:
            assert isinstance(item, Sample)
            self.got.append(item)

    def of(self, sensor: str) -> list[Sample]:
        """Its samples, without when they came."""
        return [s._replace(host_ns=0) for s in self.got if s.sensor == sensor]

    async def until(self, condition: Callable[[], bool], seconds: float = 90.0) -> None:
        """Wait; a reader that failed is seen at once."""
        async with asyncio.timeout(seconds):
            while not condition():
                if self._task.done():
                    self._task.result()
                await asyncio.sleep(0.01)

    def stop(self) -> None:
        self._task.cancel()
        self._source.close()
