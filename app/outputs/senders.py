"""Edge, outputs: what the feet ask for, sent to other programs: MOVESMover's packet and OSC, both by UDP.

Nothing is ever waited for, and nobody need listen. Both end with zeros, said more than once since UDP
may lose them.
"""

from __future__ import annotations

import contextlib
import socket
from collections.abc import Callable

from app.formats import osc
from app.motion.basics import InputError

#: A packet at least so often (ten a second are promised).
PACKET_S = 0.08
#: Axes at most so often while they change, and at least so often while any is not 0.
AXES_S, AXES_AGAIN_S = 1 / 30, 0.2
FAREWELLS = 3


def address_of(text: str, option: str) -> tuple[str, int]:
    """``HOST:PORT``; ``InputError`` for anything else."""
    host, colon, port = text.rpartition(":")
    if not colon or not host or not port.isascii() or not port.isdigit() or not 0 < int(port) < 65536:
        raise InputError(f"{option} {text}: expected HOST:PORT, for example 127.0.0.1:9000")
    return host.strip("[]"), int(port)


class Outlet:
    """A UDP socket to one place."""

    def __init__(self, text: str, option: str) -> None:
        host, port = address_of(text, option)
        try:
            family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
            self._socket, self._place = socket.socket(family, kind, protocol), place
        except (OSError, UnicodeError) as error:
            raise InputError(f"{option} {text}: no such host ({error})") from None
        self._socket.setblocking(False)

    def send(self, data: bytes) -> None:
        """Away with it; where nobody listens it is lost."""
        with contextlib.suppress(OSError):
            self._socket.sendto(data, self._place)

    def close(self) -> None:
        """Let go of the socket."""
        self._socket.close()


class PacketSender:
    """The papers' packet: on every change, and at least ten times a second."""

    def __init__(self, outlet: Outlet, still: bytes) -> None:
        self._outlet, self._still = outlet, still
        self._last, self._next_s = b"", 0.0

    def tell(self, packet: bytes, now_s: float) -> None:
        """What the feet ask for now."""
        if packet != self._last or now_s >= self._next_s:
            self._last, self._next_s = packet, now_s + PACKET_S
            self._outlet.send(packet)

    def close(self) -> None:
        """Say that nothing is asked for any more."""
        for _ in range(FAREWELLS):
            self._outlet.send(self._still)
        self._outlet.close()


class AxesSender:
    """VRChat's axes: on a change, not too often; again while not 0; a 0 three times."""

    def __init__(self, outlet: Outlet) -> None:
        self._outlet = outlet
        self._axes = {address: _Axis(outlet.send, address) for address in osc.axes(0.0, 0.0, 0.0)}

    def tell(self, ahead: float, right: float, turn: float, now_s: float) -> None:
        """How the camera moves now, each −1 to 1."""
        for address, value in osc.axes(ahead, right, turn).items():
            self._axes[address].tell(value, now_s)

    def close(self) -> None:
        """All axes to 0: whoever listens keeps the last value for ever."""
        for _ in range(FAREWELLS):
            for address in self._axes:
                self._outlet.send(osc.message(address, 0.0))
        self._outlet.close()


class _Axis:
    def __init__(self, send: Callable[[bytes], None], address: str) -> None:
        self._send, self._address = send, address
        self._last: float | None = None
        self._sent_s, self._zeros = -1.0, 0

    def tell(self, value: float, now_s: float) -> None:
        passed = now_s - self._sent_s
        changed = value != self._last
        if passed < AXES_S:
            return
        if changed:
            self._zeros = 0
        elif passed < AXES_AGAIN_S or (value == 0.0 and self._zeros >= FAREWELLS):
            return
        self._zeros += value == 0.0
        self._last, self._sent_s = value, now_s
        self._send(osc.message(self._address, value))
