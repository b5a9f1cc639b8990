"""Door: binds the port and takes connections one by one: never more than it can hold, with TLS or without."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import socket
import ssl
from dataclasses import dataclass, field
from typing import Any

from aiohttp import web

from app.door.access import Access, is_loopback
from app.door.addresses import numeric
from app.door.counters import Counters
from app.door.upstream import SOCKET_BYTES
from app.motion.basics import InputError

log = logging.getLogger(__name__)

MAX_SOCKETS = 256
#: Of them from one address, so that one caller cannot hold them all; this machine may.
MAX_SOCKETS_OF_ONE = 64
#: From the connection to the end of its TLS handshake, and as long again to the end of its request's head.
HEAD_SECONDS = 10.0
#: Of what is on its way to a browser, the kernel keeps so much that it could not send yet.
UNSENT_BYTES = 16 * 1024
TLS_HELLO = b"\x16"
NOT_PLAIN = (
    b"HTTP/1.1 400 Bad Request\r\nContent-Type: text/plain; charset=utf-8\r\nConnection: close\r\n\r\n"
    b"400: this port speaks https: begin the address with https://\n"
)


@dataclass
class Reception:
    """Takes connections for ``server`` and ends those that never say what they want."""

    server: web.Server
    counters: Counters
    tls: ssl.SSLContext | None
    arriving: dict[asyncio.Task[None], Any] = field(default_factory=dict)  # and where each comes from

    async def accept(self, listener: socket.socket) -> None:
        """Take connections until cancelled; their number is known before the next is taken."""
        loop = asyncio.get_running_loop()
        while True:
            try:
                connection, address = await loop.sock_accept(listener)
            except OSError as error:  # out of file handles, or the caller has gone already
                log.warning("a connection could not be taken: %s", error)
                await asyncio.sleep(0.1)
                continue
            if self._has_room(str(address[0])):
                _hold_little(connection)
                task = asyncio.create_task(self._take(connection))
                self.arriving[task] = address
                task.add_done_callback(self.arriving.pop)
            else:
                connection.close()
                self.counters.refuse("full")

    def _has_room(self, address: str) -> bool:
        taken = [connection.peername for connection in self.server.connections]
        held = taken + [peer for peer in self.arriving.values() if peer not in taken]  # each once
        if len(held) >= MAX_SOCKETS:
            return False
        return is_loopback(address) or sum(bool(p) and p[0] == address for p in held) < MAX_SOCKETS_OF_ONE

    def drop_all(self) -> None:
        """End every connection now, wait for none."""
        for task in list(self.arriving):
            task.cancel()
        for connection in self.server.connections:
            if connection.transport is not None:
                connection.transport.abort()

    async def _take(self, connection: socket.socket) -> None:
        try:
            if self.tls is not None and not await _begins_tls(connection):
                return
            await asyncio.get_running_loop().connect_accepted_socket(
                self.server,
                connection,
                ssl=self.tls,
                ssl_handshake_timeout=HEAD_SECONDS if self.tls else None,
            )
        except (OSError, TimeoutError) as error:  # it left, or its handshake was none
            log.debug("a connection did not come about: %s", error)
            connection.close()
        except asyncio.CancelledError:
            connection.close()
            raise


def _hold_little(connection: socket.socket) -> None:
    """What a browser does not take soon is better not sent: viser then sends the newest instead."""
    with contextlib.suppress(OSError):  # it has gone again
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SOCKET_BYTES)
        if hasattr(socket, "TCP_NOTSENT_LOWAT"):
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_BYTES)


async def _begins_tls(connection: socket.socket) -> bool:
    """Whether the first byte is TLS's; who speaks plain HTTP is told."""
    async with asyncio.timeout(HEAD_SECONDS):
        await _readable(connection)
    first = connection.recv(1, socket.MSG_PEEK)
    if first != TLS_HELLO:
        if first:
            with contextlib.suppress(OSError):
                connection.send(NOT_PLAIN)
                connection.shutdown(socket.SHUT_WR)
                connection.recv(64 * 1024)  # what was read away cannot reset the answer
        connection.close()
    return first == TLS_HELLO


async def _readable(connection: socket.socket) -> None:
    loop = asyncio.get_running_loop()
    ready = asyncio.Event()
    loop.add_reader(connection, ready.set)
    try:
        await ready.wait()
    finally:
        loop.remove_reader(connection)


def bind(access: Access) -> socket.socket:
    """A listener; a host or port that cannot be had is ``InputError``."""
    host, port = access.host, access.port
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            numeric(host), port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise _no_such_host(host) from error
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
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
