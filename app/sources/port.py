"""Edge: one serial port on the event loop: opened, read with arrival times, written, lost."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import os
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import serial
from serial_asyncio_fast import SerialTransport

Result = TypeVar("Result")
_CLOSE_S = 1.0


class PortLostError(Exception):
    """The port cannot be opened, or is gone: one sentence for the user."""


class Port(asyncio.Protocol):
    """An open port. What arrives is kept, each piece with its host time, until ``read`` takes it."""

    def __init__(self, path: str, link: serial.Serial) -> None:
        """``link`` is open; from here on it is read. To be called on the loop."""
        self.path = path
        self._link = link
        self._arrived: list[tuple[int, bytes]] = []
        self._news = asyncio.Event()
        self._lost = False
        self._transport = SerialTransport(asyncio.get_running_loop(), self, link)

    def data_received(self, data: bytes) -> None:
        """Called by the transport."""
        self._arrived.append((time.monotonic_ns(), data))
        self._news.set()

    def connection_lost(self, error: Exception | None) -> None:
        """Called by the transport when the port is closed."""
        self._lost = True
        self._news.set()

    async def read(self, timeout_s: float) -> list[tuple[int, bytes]]:
        """What has arrived, with host times in ns; nothing after ``timeout_s``. Raises ``PortLostError``.

        However short the time, what has come to the port is fetched.
        """
        if not self._arrived and not self._lost:
            self._news.clear()
            await asyncio.sleep(0.0)  # the loop looks at the port
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(timeout_s):
                    await self._news.wait()
        arrived, self._arrived = self._arrived, []
        if self._lost and not arrived:
            raise PortLostError(f"{self.path} is gone: plug it in again")
        return arrived

    def write(self, data: bytes) -> None:
        """Send; never waits. A port that is gone is told by the next ``read``."""
        self._transport.write(data)

    def set_baud(self, baud: int) -> None:
        """Change the speed; what came at another one is forgotten. Raises ``PortLostError``."""
        if self._link.baudrate == baud:
            return  # what has come is sound: a board says only once what its columns are
        try:
            self._link.baudrate = baud
            self._link.reset_input_buffer()
        except (OSError, ValueError) as error:
            raise PortLostError(f"{self.path} does not take {baud} baud ({error})") from None
        self._arrived.clear()

    async def close(self) -> None:
        """Let go of it; what was not sent is not sent."""
        if not self._transport.is_closing():
            self._transport.abort()
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(_CLOSE_S):
                while not self._lost:
                    self._news.clear()
                    await self._news.wait()


async def open_port(path: str, baud: int) -> Port:
    """Open a port for this program alone; ``PortLostError`` says why not, and what to do."""

    def opened() -> serial.Serial:
        return serial.Serial(path, baud, timeout=0, exclusive=True if os.name == "posix" else None)

    try:
        return Port(path, await in_daemon(opened))
    except (OSError, ValueError) as error:
        raise PortLostError(refusal(path, error)) from None


async def in_daemon(work: Callable[[], Result]) -> Result:
    """What ``work`` returns, from a thread that never holds up the program's end: some ports open slowly."""
    loop = asyncio.get_running_loop()
    done: asyncio.Future[Any] = loop.create_future()

    def settle(give: Callable[[Any], None], what: object) -> None:
        if not done.done():
            give(what)

    def run() -> None:
        answer: tuple[Callable[[Any], None], object]
        try:
            answer = (done.set_result, work())
        except Exception as error:
            answer = (done.set_exception, error)
        with contextlib.suppress(RuntimeError):  # the loop has ended meanwhile
            loop.call_soon_threadsafe(settle, *answer)

    threading.Thread(target=run, name="open port", daemon=True).start()
    result: Result = await done
    return result


def refusal(path: str, error: Exception) -> str:
    """Why a port could not be opened, and what to do, in a sentence."""
    match getattr(error, "errno", None):
        case errno.ENOENT | errno.ENXIO | errno.ENODEV:
            return f"{path} is not there: plug the sensor in"
        case errno.EACCES | errno.EPERM:
            return f"{path} may not be opened by you: join the group {owners(path)} and log in again"
        case errno.EAGAIN | errno.EBUSY:
            return f"{path} is in use: end the other program that reads it"
    reason = getattr(error, "strerror", None) or str(error)
    return f"{path} cannot be opened: {' '.join(str(reason).split())}"


def owners(path: str) -> str:
    """The group that may open a port: ``dialout`` or ``uucp`` on most systems."""
    with contextlib.suppress(OSError, KeyError, NotImplementedError):
        return Path(path).group()
    return "dialout"
