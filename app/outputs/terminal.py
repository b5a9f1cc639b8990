"""Edge: a pseudo-terminal as the far end of a serial line: a host opens its path as it would a port."""

from __future__ import annotations

import asyncio
import contextlib
import os
import select
import shutil
import tempfile
import termios
import tty
from collections.abc import Callable
from pathlib import Path

#: What a real port's driver and its system keep for a host that is busy.
BUFFER = 65536
_LOOK_S = 0.02  # between looks whether a host has opened it
_MOST = 4096


class Terminal:
    """What the host writes goes to ``on_data``. ``linked``: the path is a link that survives an unplug."""

    def __init__(self, name: str, baud: int, on_data: Callable[[bytes], None], linked: bool) -> None:
        self._speed = getattr(termios, f"B{baud}", None)
        self._on_data = on_data
        self._folder = Path(tempfile.mkdtemp(prefix="stridescope-")) if linked else None
        self._name = name
        self._loop: asyncio.AbstractEventLoop | None = None  # where the host is heard
        self._master = -1
        self._hosted = False
        self._waiting = b""  # for a host that is busy
        self.overrun = 0  # bytes that the host did not fetch in time
        self.plug()

    @property
    def path(self) -> str:
        """What the host opens."""
        return str(self._folder / self._name) if self._folder else self._tty

    @property
    def hosted(self) -> bool:
        """Whether a host has it open."""
        return self._hosted

    @property
    def baud_agrees(self) -> bool:
        """Whether the host's speed is the device's, as far as the system tells."""
        if self._master < 0 or self._speed is None:
            return True
        speed: int = termios.tcgetattr(self._master)[5]
        return speed == int(self._speed)

    def plug(self) -> None:
        """A new pseudo-terminal, raw and at the device's speed."""
        self._master, slave = os.openpty()
        self._tty = os.ttyname(slave)
        tty.setraw(slave)
        if self._speed is not None:
            attributes = termios.tcgetattr(slave)
            attributes[4] = attributes[5] = self._speed
            termios.tcsetattr(slave, termios.TCSANOW, attributes)
        os.close(slave)  # so that it shows when a host opens it
        os.set_blocking(self._master, False)
        if self._folder:
            (self._folder / self._name).symlink_to(self._tty)

    def unplug(self) -> None:
        """Take it away from under the host."""
        if self._folder:
            (self._folder / self._name).unlink(missing_ok=True)
        self._leave()
        if self._master >= 0:
            os.close(self._master)
            self._master = -1

    async def watch(self) -> None:
        """Read what hosts write, for ever; to be run as a task."""
        poll = select.poll()
        while True:
            if self._master >= 0 and not self._hosted:
                poll.register(self._master, select.POLLIN)
                ((_, events),) = poll.poll(0) or [(0, 0)]
                poll.unregister(self._master)
                if not events & select.POLLHUP:
                    self._hosted = True
                    self._loop = asyncio.get_running_loop()
                    self._loop.add_reader(self._master, self._read)
            await asyncio.sleep(_LOOK_S)

    def write(self, data: bytes) -> None:
        """Send; nobody hears what no host is there for, or does not fetch."""
        if not self._hosted:
            return
        kept = data[: BUFFER - len(self._waiting)]
        self.overrun += len(data) - len(kept)
        self._waiting += kept
        self._flush()

    async def emptied(self) -> None:
        """Wait until all that was written is the host's, or no host is there."""
        while self._hosted and self._waiting:
            await asyncio.sleep(_LOOK_S)

    def close(self) -> None:
        """Take it away, and its link."""
        self.unplug()
        if self._folder:
            shutil.rmtree(self._folder, ignore_errors=True)

    def _read(self) -> None:
        try:
            data = os.read(self._master, _MOST)
        except BlockingIOError:
            return
        except OSError:  # the host has closed it
            data = b""
        if data:
            self._on_data(data)
        else:
            self._leave()

    def _flush(self) -> None:
        written = 0
        with contextlib.suppress(OSError):
            written = os.write(self._master, self._waiting)
        self._waiting = self._waiting[written:]
        if self._loop is not None:
            if self._waiting:
                self._loop.add_writer(self._master, self._flush)
            else:
                self._loop.remove_writer(self._master)

    def _leave(self) -> None:
        self._hosted, self._waiting = False, b""
        if self._loop is not None:
            self._loop.remove_reader(self._master)
            self._loop.remove_writer(self._master)
            self._loop = None
