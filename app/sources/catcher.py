"""Edge: a process of its own that does nothing but take datagrams out of a socket: nothing else holds it up.

What the system keeps for a socket is full after a tenth of a second of many sensors; a program that draws,
compiles or waits for its share of a busy machine is away for longer. This one is not: it imports nothing of
the house, gives each datagram its arrival time and keeps what the program has not fetched yet.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import select
import socket
import struct
import subprocess
import sys
import time
from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

#: Kept for a program that does not fetch: a minute and a half of 16 sensors at 400 Hz. Newer ones are lost.
MOST_BYTES = 64 * 1024 * 1024
#: Before a datagram: its arrival in ns, how many were lost before it, the lengths of its sender's address
#: and of itself, the sender's port.
HEAD = struct.Struct("<QIHIH")
_LARGEST = 65_536
_AT_ONCE = 256  # datagrams taken before what waits is handed on
_AT_LAST = 1000  # pieces that may wait when the program ends: who floods must not keep it
_PIPE_BYTES = 1024 * 1024
_READ_BYTES = 4 * 1024 * 1024
_READY = b"\n"


class Datagram(NamedTuple):
    """What came, from whom and when."""

    data: bytes
    host: str
    port: int
    host_ns: int


# --- the program's side --------------------------------------------------------------------------


class Catcher:
    """The process, and what it caught. It ends with the program, however that ends."""

    def __init__(self, bound: socket.socket) -> None:
        """``bound`` is a datagram socket on its address; when this returns, the process reads it."""
        self._process = subprocess.Popen(
            [sys.executable, "-I", "-S", __file__, str(bound.fileno())],
            stdin=subprocess.PIPE,  # when that is closed, the program has ended
            stdout=subprocess.PIPE,
            bufsize=0,
            pass_fds=(bound.fileno(),),
            start_new_session=True,  # Ctrl-C is the program's
        )
        assert self._process.stdout is not None
        self.fileno = self._process.stdout.fileno()
        os.read(self.fileno, len(_READY))
        os.set_blocking(self.fileno, False)
        self._rest = b""
        self.lost = 0  # found no room while the program did not fetch

    def fetch(self) -> Iterator[Datagram]:
        """What has been caught; raises ``EOFError`` where the process has ended."""
        try:
            data = os.read(self.fileno, _READ_BYTES)
        except BlockingIOError:
            return
        if not data:
            raise EOFError("the process that takes datagrams has ended")
        data, at = self._rest + data, 0
        while len(data) - at >= HEAD.size:
            host_ns, lost, host_length, length, port = HEAD.unpack_from(data, at)
            begin = at + HEAD.size + host_length
            if len(data) < begin + length:
                break
            self.lost += lost
            host = data[at + HEAD.size : begin].decode("ascii", "replace")
            at = begin + length
            yield Datagram(data[begin:at], host, port, host_ns)
        self._rest = data[at:]

    def end(self) -> None:
        """Have the process hand on what has come, and end: ``fetch`` it until it says so."""
        if self._process.stdin is not None:
            self._process.stdin.close()

    def close(self) -> None:
        """End it at once and close the pipes."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()


# --- the process ---------------------------------------------------------------------------------


def catch(bound: socket.socket, out: int, ends: int) -> None:
    """Hand on what comes to ``bound`` through the pipe ``out``, until ``ends`` is closed at its other end."""
    waiting: deque[bytes] = deque()
    size = lost = 0
    while True:
        to_write = [out] if waiting else []
        readable, writable, _ = select.select([bound.fileno(), ends], to_write, [])
        if ends in readable:
            _hand_on_all(bound, waiting, lost, out)
            return
        if bound.fileno() in readable:
            caught, lost = _take(bound, lost, size < MOST_BYTES)
            if caught:
                waiting.append(caught)
                size += len(caught)
        if waiting and (writable or len(waiting) == 1):
            size -= _hand_on(waiting, out)


def _take(bound: socket.socket, lost: int, room: bool) -> tuple[bytes, int]:
    """Some of what stands there as one piece, and how many are lost that nobody has been told of."""
    pieces = []
    for _ in range(_AT_ONCE):
        try:
            data, (host, port, *_) = bound.recvfrom(_LARGEST)
        except (BlockingIOError, InterruptedError):
            break
        except OSError:  # a sender that is not there any more; nothing of it came
            continue
        if not room:
            lost += 1
            continue
        sender = host.encode("ascii", "replace")
        pieces += [HEAD.pack(time.monotonic_ns(), lost, len(sender), len(data), port), sender, data]
        lost = 0
    return b"".join(pieces), lost


def _hand_on(waiting: deque[bytes], out: int) -> int:
    """Write what the pipe takes; how many bytes that were."""
    piece = waiting.popleft()
    try:
        written = os.write(out, piece)
    except BlockingIOError:
        written = 0
    if written < len(piece):
        waiting.appendleft(piece[written:])
    return written


def _hand_on_all(bound: socket.socket, waiting: deque[bytes], lost: int, out: int) -> None:
    """The program ends, and waits for what has come by now; one that has ended closes the pipe."""
    while (taken := _take(bound, lost, len(waiting) < _AT_LAST))[0]:
        lost = taken[1]
        waiting.append(taken[0])
    os.set_blocking(out, True)
    for piece in waiting:
        rest = memoryview(piece)
        while rest:
            rest = rest[os.write(out, rest) :]


def _main() -> None:
    os.set_blocking(1, False)
    with contextlib.suppress(AttributeError, OSError):  # of another system: a small pipe will do
        fcntl.fcntl(1, fcntl.F_SETPIPE_SZ, _PIPE_BYTES)
    bound = socket.socket(fileno=int(sys.argv[1]))
    bound.setblocking(False)
    with contextlib.suppress(BrokenPipeError):  # the program has ended
        os.write(1, _READY)
        catch(bound, 1, 0)


if __name__ == "__main__":
    _main()
