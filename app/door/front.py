"""Door: the public port. Browsers talk to this server; viser listens behind it on loopback."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import ssl
import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial

from app.door import tls
from app.door.access import Access, is_loopback
from app.door.addresses import own_names, reachable
from app.door.counters import Counters
from app.door.entrance import Entrance
from app.door.files import Files
from app.door.gate import Gate
from app.door.greeting import greeting
from app.door.hand_in import HandIn
from app.door.ingest import Ingest, Taker
from app.door.listening import bind
from app.door.service import Service, Told
from app.motion.door import GuiRule, Measure

log = logging.getLogger(__name__)

STOP_SECONDS = 0.9


class Door:
    """A small HTTP and websocket server on its own thread and its own loop.

    ``rules()`` says what a browser may write, by control; ``health()`` is what ``/healthz`` tells
    anybody on this machine, and ``measures()`` what ``/metrics`` does, so nothing secret. All are
    called on the door's thread and must not block. ``extra_head`` is our own markup for the page's head,
    ``files`` the library, ``hand_in`` makes a file of what is seen, ``taker`` takes phones' samples.
    """

    def __init__(
        self,
        access: Access,
        *,
        viser_port: int,
        rules: Callable[[], Mapping[str, GuiRule]],
        health: Callable[[], Mapping[str, object]],
        measures: Callable[[], Iterable[Measure]] = tuple,
        extra_head: str = "",
        files: Files | None = None,
        taker: Taker | None = None,
        hand_in: HandIn | None = None,
    ) -> None:
        self.counters = Counters()
        self.access = access
        self._viser_port, self._rules, self._extra_head = viser_port, rules, extra_head
        self._told = Told(health, measures)
        self._files = files
        self._taker, self._hand_in = taker, hand_in
        self._thread: threading.Thread | None = None
        self._stop: Callable[[], object] | None = None

    @property
    def address(self) -> str:
        """What an operator opens in a browser; with ``?token=…`` where there is one: never log it."""
        return self._address(self.access.operator)

    @property
    def watching(self) -> str:
        """The same for who only watches; an operator's where there is no token for viewers."""
        return self._address(self.access.viewer or self.access.operator)

    def greeting(self) -> list[str]:
        """What to print once it is open, and nowhere else: the addresses with their tokens."""
        watch = self.watching if self.access.viewer else None
        lines = greeting(self.address, watch, reachable=not is_loopback(self.access.host))
        if self.access.certificate:
            lines.append(f"Its certificate, SHA-256: {tls.fingerprint(self.access.certificate)}")
        return lines

    def _address(self, token: str | None) -> str:
        return self.access.address(reachable(self.access.host), self.access.port, token)

    def start(self) -> None:
        """Bind, and return when serving; a host or port that cannot be had raises ``InputError``."""
        certificate = self.access.certificate
        secure = tls.context(certificate) if certificate else None
        listener = bind(self.access)
        self.access = replace(self.access, port=listener.getsockname()[1])
        ready = threading.Event()
        self._thread = threading.Thread(
            target=self._run, args=(listener, secure, ready), name="door", daemon=True
        )
        self._thread.start()
        ready.wait()
        if self._stop is None:
            raise RuntimeError("the door did not open: the log says why")

    def stop(self) -> None:
        """End all connections and free the port, within a second; a second call does nothing."""
        thread, self._thread = self._thread, None
        if thread is None or self._stop is None:
            return
        with contextlib.suppress(RuntimeError):  # its loop has ended by itself
            self._stop()
        thread.join(STOP_SECONDS)

    def _run(self, listener: socket.socket, secure: ssl.SSLContext | None, ready: threading.Event) -> None:
        try:
            asyncio.run(self._serve(listener, secure, ready))
        except Exception:
            log.exception("the door fell shut")
        finally:
            listener.close()
            ready.set()

    async def _serve(
        self, listener: socket.socket, secure: ssl.SSLContext | None, ready: threading.Event
    ) -> None:
        stopping = asyncio.Event()
        loop = asyncio.get_running_loop()

        def opened() -> None:
            self._stop = partial(loop.call_soon_threadsafe, stopping.set)
            ready.set()

        gate = Gate(self.access, own_names(self.access.host))
        service = Service(
            Entrance(gate),
            self._viser_port,
            self._rules,
            self._told,
            self._extra_head,
            self.counters,
            Ingest(gate, self._taker),
            self._files,
            self._hand_in,
        )
        await service.run(listener, secure, stopping, opened)
