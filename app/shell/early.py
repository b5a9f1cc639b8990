"""Shell: what a sensor sends while kernels are being compiled: recorded already, it waits for the session."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterator
from typing import Generic, TypeVar

_T = TypeVar("_T")

#: Between chances for the rest of the loop while what waits is taken.
BREATH = 32
#: From here on the source keeps what comes: it knows whether its sender can be made to wait.
FULL = 100_000


class Early(Generic[_T]):
    """What came, in that order; ``take`` has each of it once it can."""

    def __init__(self, take: Callable[[_T], None]) -> None:
        self._take = take
        self._waiting: deque[_T] = deque()
        self._over = False

    def __len__(self) -> int:
        return len(self._waiting)

    def __iter__(self) -> Iterator[_T]:
        return iter(self._waiting)

    @property
    def holds(self) -> bool:
        """Whether what comes now has to wait: nothing is compiled yet, or others came before it."""
        return not self._over or bool(self._waiting)

    @property
    def full(self) -> bool:
        """Whether no more should be read."""
        return len(self._waiting) >= FULL

    def add(self, item: _T) -> None:
        """Let it wait behind the others."""
        self._waiting.append(item)

    async def release(self, prepared: asyncio.Task[None], changed: Callable[[], None] = lambda: None) -> None:
        """Once everything is ``prepared``, have all of it taken; a fault in preparing is raised here."""
        await asyncio.wait((prepared,))
        prepared.result()
        self._over = True
        while self._waiting:
            for _ in range(min(BREATH, len(self._waiting))):
                self._take(self._waiting.popleft())
            changed()
            await asyncio.sleep(0)
