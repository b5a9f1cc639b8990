"""Shell: what both pages need of the loop that serves them: orders from other threads, the door, Ctrl-C."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from collections.abc import Callable, Coroutine, Iterable

from app.door.front import Door
from app.launch import open_in_browser
from app.motion.commands import Order


class Desk:
    """Where orders arrive, and the wish to stop."""

    def __init__(self) -> None:
        self.orders: asyncio.Queue[Order] = asyncio.Queue()
        self._stop = asyncio.Event()
        self._loop: asyncio.AbstractEventLoop | None = None

    def open(self) -> None:
        """Heed the running loop's signals, and hand it what ``submit`` gets."""
        self._loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            self._loop.add_signal_handler(number, self._stop.set)

    def submit(self, order: Order) -> None:
        """An order from any thread."""
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop has ended
                self._loop.call_soon_threadsafe(self.orders.put_nowait, order)

    async def until_stopped(self, work: Iterable[Coroutine[None, None, None]]) -> None:
        """Do it all at once until Ctrl-C, or until one is over; a fault of ours is seen."""
        tasks = [asyncio.create_task(self._stop.wait()), *(asyncio.create_task(part) for part in work)]
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in tasks:
            task.cancel()
        await asyncio.wait(tasks, timeout=1.0)
        for task in done:
            if not task.cancelled():
                task.result()


def open_door(
    door: Door, tell: Callable[[str], None], browser: bool, also: Callable[[], Iterable[str]] = tuple
) -> None:
    """Start it, tell its addresses and what else there is, and show it to who sits there."""
    door.start()
    for line in (*door.greeting(), *also()):
        tell(line)
    if browser:
        open_in_browser(door.address)
