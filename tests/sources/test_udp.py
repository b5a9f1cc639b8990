"""Real datagrams: our own and sensors', two feet and many sensors on one port."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Callable
from typing import Any

import pytest

from app.formats.wire import ngimu
from app.formats.wire.datagrams import Datagrams
from app.formats.wire.message import encode_binary, encode_json
from app.motion.basics import InputError
from app.motion.samples import Sample
from app.motion.source import Link
from app.sources import udp
from app.sources.spec import parse_spec
from app.sources.udp import UdpSource
from tests.sources.links import Reader, walk


def sender() -> socket.socket:
    return socket.socket(socket.AF_INET, socket.SOCK_DGRAM)


def test_two_feet_and_a_sensor_of_another_make_on_one_port() -> None:
    async def main() -> None:
        source = UdpSource(parse_spec("udp:0"))
        reader = Reader(source)
        place = ("127.0.0.1", source.port)
        left, right, other = sender(), sender(), sender()
        osc = ngimu.NgimuEncoder(slip=False)
        for a, b in zip(walk(200), walk(200, "right"), strict=True):
            left.sendto(encode_json(1, [a]).encode(), place)
            right.sendto(encode_binary(2, [b], doubles=True), place)
            other.sendto(osc.encode(a), place)
            await asyncio.sleep(0.0005)
        await reader.until(lambda: len(reader.of("right")) == 200 and len(reader.of("foot")) >= 190)
        assert reader.of("left") == walk(200)
        assert reader.of("right") == walk(200, "right")
        assert source.link is Link.LIVE
        assert source.info.line == {}
        assert any("NGIMU" in note for note in source.info.assumed)
        reader.stop()
        for each in (left, right, other):
            each.close()

    asyncio.run(main())


def test_sixteen_sensors_at_400_hz_lose_nothing() -> None:
    """A second of what ``make soak`` does for a minute, as fast as the receiver empties the socket."""

    async def main() -> None:
        source = UdpSource(parse_spec("udp:0"))
        reader = Reader(source)
        sockets = [sender() for _ in range(16)]
        for i in range(400):
            for k, each in enumerate(sockets):
                each.sendto(encode_binary(k, walk(1, f"s{k}", i)), ("127.0.0.1", source.port))
            if i % 4 == 3:
                await reader.until(lambda i=i: len(reader.got) >= 16 * (i + 1))  # type: ignore[misc]
        assert all(len(reader.of(f"s{k}")) == 400 for k in range(16))
        assert source.info.line == {}
        reader.stop()
        for each in sockets:
            each.close()

    asyncio.run(main())


def test_a_closed_source_frees_its_port_and_a_taken_one_is_said() -> None:
    source = UdpSource(parse_spec("udp:0"))
    with pytest.raises(InputError, match="taken"):
        UdpSource(parse_spec(f"udp:{source.port}"))
    source.close()
    source.close()
    again = UdpSource(parse_spec(f"udp:{source.port}"))
    again.close()


def test_an_unknown_device_is_said_before_anything_is_opened() -> None:
    with pytest.raises(InputError, match="device=ximu:"):
        UdpSource(parse_spec("udp:0?device=ximu"))


def test_what_was_caught_when_it_is_closed_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    """The program was busy for a moment when Ctrl-C came."""
    monkeypatch.setattr(udp, "REST_S", 0.3)
    source = UdpSource(parse_spec("udp:0"))
    place, each = ("127.0.0.1", source.port), sender()
    each.sendto(encode_binary(1, walk(1), doubles=True), place)
    wait_for(lambda: len(source._waiting) == 1)  # and now it rests
    for i in range(1, 50):
        each.sendto(encode_binary(1, walk(1, "left", i), doubles=True), place)
    source.close()
    assert [sample.seq for sample in source.unread()] == list(range(50))
    each.close()


def test_a_fault_of_the_program_costs_one_datagram(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    feed = Datagrams.feed

    def falter(datagrams: Datagrams, data: bytes, *more: Any) -> list[Sample]:
        if data == b"falter":
            raise KeyError("a fault")
        return feed(datagrams, data, *more)

    monkeypatch.setattr(Datagrams, "feed", falter)
    source = UdpSource(parse_spec("udp:0"))
    place, each = ("127.0.0.1", source.port), sender()
    for i in range(20):
        each.sendto(encode_binary(1, walk(1, "left", i), doubles=True), place)
        each.sendto(b"falter", place)
    wait_for(lambda: len(source._waiting) == 20)
    assert "could not be read" in caplog.text
    source.close()
    each.close()


def wait_for(condition: Callable[[], bool]) -> None:
    until = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.005)
