"""Edge: ``udp:PORT``: datagrams of many sensors on one port, read in a thread of their own."""

from __future__ import annotations

import contextlib
import logging
import select
import socket
import threading
import time

from app.formats.wire.catalogue import KINDS
from app.formats.wire.datagrams import Datagrams
from app.motion import InputError, Sample
from app.sources.inbox import Inbox
from app.sources.listening import bind, options_of, place_of
from app.sources.spec import Spec

_log = logging.getLogger(__name__)

#: Asked of the system, which may give less: datagrams wait here while the program is busy.
BUFFER_BYTES = 4 * 1024 * 1024
_LARGEST = 65_536
_LOOK_S = 0.2  # between looks whether to end
_MOST_AT_ONCE = 256


class UdpSource(Inbox):
    """Listens from the start; what comes before it is read waits."""

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
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._listen, name="udp", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop listening and free the port."""
        self._ending.set()
        self._thread.join(1.0)

    def _listen(self) -> None:
        with self._socket:
            while not self._ending.is_set():
                try:
                    if select.select([self._socket], [], [], _LOOK_S)[0]:
                        self.put(self._take())
                except OSError as error:
                    _log.warning("%s: %s", self.info.name, error)
                    self._ending.wait(_LOOK_S)

    def _take(self) -> list[Sample]:
        """What stands there now."""
        samples: list[Sample] = []
        with contextlib.suppress(BlockingIOError):
            for _ in range(_MOST_AT_ONCE):
                data, sender = self._socket.recvfrom(_LARGEST)
                samples += self._datagrams.feed(data, (sender[0], sender[1]), time.monotonic_ns())
        return samples
