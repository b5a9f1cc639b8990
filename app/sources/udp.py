"""Edge: ``udp:PORT``: datagrams of many sensors on one port."""

from __future__ import annotations

import contextlib
import logging
import select
import socket
import threading
import time
from collections.abc import Mapping

from app.formats.wire.catalogue import KINDS
from app.formats.wire.datagrams import Datagrams
from app.motion.basics import InputError
from app.motion.samples import Sample
from app.sources.catcher import Catcher, Datagram
from app.sources.inbox import REST_S, Inbox
from app.sources.listening import bind, options_of, place_of
from app.sources.spec import Spec

_log = logging.getLogger(__name__)

#: Asked of the system, which may give less: datagrams wait here while the machine is busy.
BUFFER_BYTES = 4 * 1024 * 1024
_LOOK_S = 0.2  # between looks whether to end
_LAST_S = 0.5  # for what came before it was closed
_AGAIN_S = 1.0  # before another process is begun for one that ended


class UdpSource(Inbox):
    """Listens from the start. A process takes the datagrams, a thread here reads them, many at once."""

    def __init__(self, spec: Spec) -> None:
        host, port = place_of(spec)
        options, own = options_of(spec, ("left", "right"))
        if options.device is not None and options.device not in KINDS:
            raise InputError(f"device={options.device}: expected one of {', '.join(KINDS)}, or auto")
        names = {address: foot for foot, address in own.items()}
        self._datagrams = Datagrams(options, names)
        self._socket = bind(spec, host, port, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
        self.port: int = self._socket.getsockname()[1]
        super().__init__(
            f"udp:{spec.target}",
            "datagrams",
            lambda: self._datagrams.notes,
            self._lost,
            lambda: self._datagrams.counters(),
            lambda: self._datagrams.temperatures(),
        )
        self._closed = threading.Event()
        self._catcher = Catcher(self._socket)
        self._lost_before = 0  # by catchers that ended
        self._thread = threading.Thread(target=self._run, name="udp", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop listening and free the port; what was caught by then is still taken."""
        self._closed.set()
        self._catcher.end()
        self._thread.join(1.0)
        until_s = time.monotonic() + _LAST_S
        with contextlib.suppress(EOFError, OSError, ValueError):
            while not self._thread.is_alive() and (left_s := until_s - time.monotonic()) > 0.0:
                select.select([self._catcher.fileno], [], [], left_s)
                self._fetch()
        self._catcher.close()
        self._socket.close()

    def _lost(self) -> Mapping[str, int]:
        unfetched = self._lost_before + self._catcher.lost
        return self._datagrams.lost() | {"came faster than this machine could read": unfetched}

    # --- in its thread ---

    def _run(self) -> None:
        while not self._closed.is_set():
            try:
                self._listen()
            except (EOFError, OSError, ValueError) as error:
                if self._closed.wait(_AGAIN_S):
                    return
                _log.warning("%s: %s; another is begun", self.info.name, error)
                self._lost_before += self._catcher.lost
                self._catcher.close()
                self._catcher = Catcher(self._socket)

    def _listen(self) -> None:
        """Take what was caught, and look again a little later: many datagrams cost one turn."""
        while not self._closed.is_set():
            if select.select([self._catcher.fileno], [], [], _LOOK_S)[0]:
                self._fetch()
                time.sleep(REST_S)

    def _fetch(self) -> int:
        """Take what was caught; how many datagrams that were."""
        caught = list(self._catcher.fetch())
        self.put([sample for datagram in caught for sample in self._samples(datagram)])
        return len(caught)

    def _samples(self, datagram: Datagram) -> list[Sample]:
        """A fault of the program costs one datagram, and is seen."""
        try:
            return self._datagrams.feed(datagram.data, (datagram.host, datagram.port), datagram.host_ns)
        except Exception:
            _log.exception("%s: a datagram of %s could not be read", self.info.name, datagram.host)
            return []
