"""Edge: a file synced again and again in a thread of its own: what is written never waits for the disk.

A kill takes nothing that was written, a power cut nothing that was synced: so both go on side by side.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable


class Syncer:
    """Syncs the file of this number whenever more was written. One thread tells it what was."""

    def __init__(self, number: int, sync: Callable[[int], None]) -> None:
        self._number, self._sync = number, sync
        self._news = threading.Condition()
        self._waiting: deque[bytes] = deque()  # written, not known to be synced
        self._over = False
        self._began_s: float | None = None
        self._took_s = 0.0
        self._error: OSError | None = None
        self._thread = threading.Thread(target=self._run, name="sync", daemon=True)
        self._thread.start()

    def wrote(self, data: bytes) -> None:
        """More is in the file. The error of an earlier sync is raised here."""
        with self._news:
            self._waiting.append(data)
            self._news.notify()
        self.check()

    def check(self) -> None:
        """Raise the error of a sync that failed."""
        if self._error is not None:
            raise self._error

    def finish(self) -> None:
        """Return when all is synced, or raise why it cannot be; nothing more may be written."""
        self.stop()
        self.check()

    def stop(self) -> list[bytes]:
        """End the thread; what it could not sync."""
        with self._news:
            self._over = True
            self._news.notify()
        self._thread.join()
        return list(self._waiting)

    @property
    def slow_s(self) -> float:
        """How long the sync under way, or the last one, takes."""
        began_s = self._began_s
        return self._took_s if began_s is None else max(self._took_s, time.monotonic() - began_s)

    def _run(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: self._waiting or self._over)
                count = len(self._waiting)
            if not count:
                return
            self._began_s = time.monotonic()
            try:
                self._sync(self._number)
            except OSError as error:
                self._error = error
                return
            self._took_s, self._began_s = time.monotonic() - self._began_s, None
            with self._news:
                for _ in range(count):
                    self._waiting.popleft()
