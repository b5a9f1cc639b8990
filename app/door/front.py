"""Door: the public port. Browsers talk to this server; viser listens behind it on loopback."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import socket
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from app.door.access import Access, is_loopback
from app.door.counters import Counters
from app.door.gate import Gate
from app.door.greeting import greeting
from app.door.service import Service
from app.door.upstream import SOCKET_BYTES
from app.motion import GuiRule, InputError

log = logging.getLogger(__name__)

STOP_SECONDS = 0.9


class Door:
    """A small HTTP and websocket server on its own thread and its own loop.

    ``rules()`` says what a browser may write, by control; ``health()`` is what ``/healthz`` tells
    anybody on this machine, so nothing secret. Both are called on the door's thread and must not
    block. ``extra_head`` is our own markup for the page's head.
    """

    def __init__(
        self,
        access: Access,
        *,
        viser_port: int,
        rules: Callable[[], Mapping[str, GuiRule]],
        health: Callable[[], Mapping[str, object]],
        extra_head: str = "",
    ) -> None:
        self.counters = Counters()
        self.access = access
        self._viser_port, self._rules, self._health, self._extra_head = viser_port, rules, health, extra_head
        self._thread: threading.Thread | None = None
        self._stop: Callable[[], object] | None = None

    @property
    def address(self) -> str:
        """What an operator opens in a browser; with ``?token=…`` where there is one: never log it."""
        return self._address(self.access.operator)

    def greeting(self) -> list[str]:
        """What to print once it is open, and nowhere else: the addresses with their tokens."""
        watch = self._address(self.access.viewer) if self.access.viewer else None
        return greeting(self.address, watch, reachable=not is_loopback(self.access.host))

    def _address(self, token: str | None) -> str:
        return self.access.address(_reachable(self.access.host), self.access.port, token)

    def start(self) -> None:
        """Bind, and return when serving; a host or port that cannot be had raises ``InputError``."""
        listener = _bind(self.access.host, self.access.port)
        self.access = replace(self.access, port=listener.getsockname()[1])
        ready = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(listener, ready), name="door", daemon=True)
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

    def _run(self, listener: socket.socket, ready: threading.Event) -> None:
        try:
            asyncio.run(self._serve(listener, ready))
        except Exception:
            log.exception("the door fell shut")
        finally:
            listener.close()
            ready.set()

    async def _serve(self, listener: socket.socket, ready: threading.Event) -> None:
        stopping = asyncio.Event()
        loop = asyncio.get_running_loop()

        def opened() -> None:
            self._stop = partial(loop.call_soon_threadsafe, stopping.set)
            ready.set()

        gate = Gate(self.access, _own_names(self.access.host))
        service = Service(gate, self._viser_port, self._rules, self._health, self._extra_head, self.counters)
        await service.run(listener, stopping, opened)


def _bind(host: str, port: int) -> socket.socket:
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            _numeric(host), port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise _no_such_host(host) from error
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        # What a browser does not take soon is better not sent: viser then sends the newest instead.
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SOCKET_BYTES)
        if family == socket.AF_INET6:
            listener.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)  # "::" takes IPv4 as well
        listener.bind(address)
        listener.listen(128)
    except OSError as error:
        listener.close()
        raise _cannot_bind(host, port, error) from error
    listener.setblocking(False)
    return listener


def _cannot_bind(host: str, port: int, error: OSError) -> InputError:
    if error.errno == errno.EADDRINUSE:
        return InputError(f"port {port} is taken: another program listens there; give another with --port")
    if error.errno in (errno.EACCES, errno.EPERM):
        return InputError(f"port {port} is not allowed to this user: give one from 1024 on with --port")
    return _no_such_host(host)


def _no_such_host(host: str) -> InputError:
    return InputError(f"host {host} is no address of this machine: expected 127.0.0.1, 0.0.0.0 or its own")


def _numeric(host: str) -> str:
    """Browsers try 127.0.0.1 for ``localhost`` as well, so one listener will do."""
    return "127.0.0.1" if host.lower() == "localhost" else host


def _own_names(host: str) -> frozenset[str]:
    name = socket.gethostname().lower()
    return frozenset({host.lower(), name, f"{name.partition('.')[0]}.local"})


def _reachable(host: str) -> str:
    """The host to print: of a server that listens everywhere, the address others reach it by."""
    if host not in ("", "0.0.0.0", "::"):
        return _numeric(host)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe, contextlib.suppress(OSError):
        probe.connect(("192.0.2.1", 9))  # sends nothing: only asks which address would be used
        return str(probe.getsockname()[0])
    return "127.0.0.1"
