"""Edge: ``udp:PORT``: datagrams of many sensors on one port."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import select
import socket
import threading
import time
from collections.abc import AsyncIterator

from app.formats.wire.catalogue import KINDS
from app.formats.wire.datagrams import Datagrams
from app.motion import InputError, Sample
from app.sources.inbox import REST_S, Inbox
from app.sources.listening import bind, options_of, place_of
from app.sources.source import Item
from app.sources.spec import Spec

_log = logging.getLogger(__name__)

#: Asked of the system, which may give less: datagrams wait here while the program is busy.
BUFFER_BYTES = 4 * 1024 * 1024
_LARGEST = 65_536
_LOOK_S = 0.2  # between looks whether to end
_MOST_AT_ONCE = 20_000  # more than any socket holds: a busy machine lets us look seldom


class UdpSource(Inbox):
    """Listens from the start, in a thread; what comes before it is read waits."""

    def __init__(self, spec: Spec) -> None:
        host, port = place_of(spec)
        options, own = options_of(spec, ("left", "right"))
        if options.device is not None and options.device not in KINDS:
            raise InputError(f"device={options.device}: expected one of {', '.join(KINDS)}, or auto")
        names = {address: foot for foot, address in own.items()}
        self._datagrams = Datagrams(options, names)
        self._socket = bind(spec, host, port, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
        self._socket.setblocking(False)
        self.port: int = self._socket.getsockname()[1]
        super().__init__(
            f"udp:{spec.target}",
            "datagrams",
            lambda: self._datagrams.notes,
            lambda: self._datagrams.lost(),
            lambda: self._datagrams.counters(),
        )
        self._closed, self._reading = False, True
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._listen, name="udp", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop listening and free the port."""
        self._closed = True
        self._stop_thread()
        self._socket.close()

    def __aiter__(self) -> AsyncIterator[Item]:
        return self._read_here()

    async def _read_here(self) -> AsyncIterator[Item]:
        """From now on the reader's own loop empties the socket: two threads would wait for each other."""
        loop = asyncio.get_running_loop()
        await asyncio.to_thread(self._stop_thread)
        self._look(loop)
        try:
            async for item in super().__aiter__():
                yield item
        finally:
            self._reading = False
            if not self._closed:
                loop.remove_reader(self._socket)

    def _look(self, loop: asyncio.AbstractEventLoop) -> None:
        if self._reading and not self._closed:
            loop.add_reader(self._socket, self._come, loop)

    def _come(self, loop: asyncio.AbstractEventLoop) -> None:
        """Take what stands there, and look again a little later: many datagrams cost one turn."""
        loop.remove_reader(self._socket)
        self._fetch()
        loop.call_later(REST_S, self._look, loop)

    def _stop_thread(self) -> None:
        self._ending.set()
        self._thread.join(1.0)

    def _listen(self) -> None:
        """Until somebody reads: the program is still preparing."""
        while not self._ending.is_set():
            if select.select([self._socket], [], [], _LOOK_S)[0]:
                self._fetch()

    def _fetch(self) -> None:
        try:
            self.put(self._take())
        except OSError as error:
            _log.warning("%s: %s", self.info.name, error)

    def _take(self) -> list[Sample]:
        """What stands there now."""
        samples: list[Sample] = []
        with contextlib.suppress(BlockingIOError):
            for _ in range(_MOST_AT_ONCE):
                data, sender = self._socket.recvfrom(_LARGEST)
                samples += self._datagrams.feed(data, (sender[0], sender[1]), time.monotonic_ns())
        return samples
