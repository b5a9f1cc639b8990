"""Edge: samples between the task that receives them and the one that takes them."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import AsyncIterator, Coroutine, Iterable

from app.motion import Sample

_BREATH_NS = 5_000_000  # between chances for the rest of the loop


class Mailbox:
    """``put`` never waits; ``items`` gives what was put, in that order."""

    def __init__(self) -> None:
        self._samples: deque[Sample] = deque()
        self._news = asyncio.Event()

    def put(self, samples: Iterable[Sample]) -> None:
        """Keep them until they are taken."""
        self._samples.extend(samples)
        self._news.set()

    async def items(self, *workers: Coroutine[None, None, None]) -> AsyncIterator[Sample]:
        """Run the workers that put, and give what comes, until all have returned; a fault is raised."""
        tasks = [asyncio.create_task(worker) for worker in workers]
        for task in tasks:
            task.add_done_callback(lambda _: self._news.set())
        breath_ns = time.monotonic_ns()
        try:
            while True:
                self._news.clear()
                while self._samples:
                    yield self._samples.popleft()
                    if time.monotonic_ns() - breath_ns > _BREATH_NS:
                        await asyncio.sleep(0)
                        breath_ns = time.monotonic_ns()
                for task in tasks:
                    if task.done():
                        task.result()
                if all(task.done() for task in tasks) and not self._samples:
                    return
                await self._news.wait()
                breath_ns = time.monotonic_ns()
        finally:
            for task in tasks:
                task.cancel()
