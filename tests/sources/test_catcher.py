"""Datagrams are caught whatever the program does meanwhile: real sockets, real processes."""

from __future__ import annotations

import asyncio
import ctypes
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator

import pytest

from app.sources import catcher, udp
from app.sources.catcher import Catcher, Datagram
from app.sources.spec import parse_spec
from app.sources.udp import UdpSource
from tests.sources.links import Reader

COUNT, RATE_HZ = 1500, 500
#: Sends COUNT messages of a sensor, from a process of its own.
SENDER = f"""
import socket, sys, time
sys.path.insert(0, {os.getcwd()!r})
from app.formats.wire.message import encode_binary
from tests.sources.links import walk
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
made = [encode_binary(1, [sample]) for sample in walk({COUNT})]
sys.stdin.readline()
began = time.monotonic()
for i, data in enumerate(made):
    time.sleep(max(began + i / {RATE_HZ} - time.monotonic(), 0.0))
    s.sendto(data, ("127.0.0.1", int(sys.argv[1])))
"""


@pytest.fixture
def bound() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as made:
        made.bind(("127.0.0.1", 0))
        yield made


def caught(by: Catcher, count: int, seconds: float = 90.0) -> list[Datagram]:
    found: list[Datagram] = []
    end = time.monotonic() + seconds
    while len(found) < count:
        assert time.monotonic() < end, f"{len(found)} of {count} came"
        found += by.fetch()
        time.sleep(0.005)
    return found


def test_datagrams_come_whole_in_order_with_sender_and_time(bound: socket.socket) -> None:
    by = Catcher(bound)
    sent = [bytes([i % 256]) * (i * 37 % 9000) for i in range(300)]
    before_ns = time.monotonic_ns()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        found: list[Datagram] = []
        for first in range(0, 300, 10):  # as many as the socket itself has room for
            for data in sent[first : first + 10]:
                sender.sendto(data, bound.getsockname())
            found += caught(by, 10)
        assert {(d.host, d.port) for d in found} == {("127.0.0.1", sender.getsockname()[1])}
    by.close()
    assert [d.data for d in found] == sent
    stamps = [d.host_ns for d in found]
    assert stamps == sorted(stamps)
    assert before_ns <= stamps[0] <= stamps[-1] <= time.monotonic_ns()


def test_nothing_is_lost_while_the_program_holds_its_interpreter_for_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With the socket's usual room, not what this machine may give: it holds about 500 messages."""
    monkeypatch.setattr(udp, "BUFFER_BYTES", 200_000)

    async def main() -> None:
        source = UdpSource(parse_spec("udp:0"))
        reader = Reader(source)
        command = [sys.executable, "-c", SENDER, str(source.port)]
        with subprocess.Popen(command, stdin=subprocess.PIPE, text=True) as sender:
            assert sender.stdin is not None
            sender.stdin.write("go\n")
            sender.stdin.flush()
            await reader.until(lambda: len(reader.got) > 30)
            ctypes.PyDLL(None).usleep(2_000_000)  # a call that does not let go of the interpreter
            await reader.until(lambda: len(reader.got) >= COUNT)
        assert [s.seq for s in reader.got] == list(range(COUNT))
        assert source.info.line == {}
        reader.stop()

    asyncio.run(main())


def test_what_found_no_room_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The process's own function, with pipes of this one."""
    monkeypatch.setattr(catcher, "_AT_ONCE", 4)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as here:
        here.bind(("127.0.0.1", 0))
        here.setblocking(False)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for i in range(8):
                sender.sendto(bytes([i]), here.getsockname())
        nothing, lost = catcher._take(here, 0, room=False)
        assert (nothing, lost) == (b"", 4)
        kept, lost = catcher._take(here, lost, room=True)
        assert lost == 0
        assert catcher.HEAD.unpack_from(kept)[1] == 4


def test_a_process_that_is_killed_is_begun_again_and_one_without_its_program_ends() -> None:
    async def main() -> None:
        source = UdpSource(parse_spec("udp:0"))
        reader = Reader(source)
        os.kill(source._catcher._process.pid, signal.SIGKILL)
        killed = source._catcher
        await reader.until(lambda: source._catcher is not killed)
        command = [sys.executable, "-c", SENDER, str(source.port)]
        with subprocess.Popen(command, stdin=subprocess.PIPE, text=True) as sender:
            await asyncio.to_thread(sender.communicate, "go\n")
        await reader.until(lambda: len(reader.got) == COUNT)
        process = source._catcher._process
        assert process.stdin is not None
        process.stdin.close()  # as the system does where a program is killed
        await asyncio.to_thread(process.wait, 30)
        reader.stop()

    asyncio.run(main())
