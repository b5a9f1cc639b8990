"""A forwarder and a real receiver with a cable between them that is cut: none lost, none twice, in order."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from app.motion.basics import InputError
from app.outputs import forwarder
from app.outputs.forwarder import Links, UdpSender, WsSender, sender_to
from app.sources.spec import parse_spec
from app.sources.udp import UdpSource
from app.sources.ws import WsSource
from tests.sources.links import Reader, walk
from tests.sources.proxies import Cable


class Line:
    """A receiver, a cable, a sender."""

    def __init__(self) -> None:
        self.source = WsSource(parse_spec("ws:0"))
        self.reader = Reader(self.source)
        self.cable = Cable(self.source.port)
        self.told: list[str] = []

    async def __aenter__(self) -> Line:
        await self.cable.plug_in()
        address = f"ws://127.0.0.1:{self.cable.port}"
        self.sender = WsSender(address, 5, Links(), self.told.append)
        self.task = asyncio.create_task(self.sender.run())
        return self

    async def __aexit__(self, *_: object) -> None:
        self.task.cancel()
        self.cable.cut()
        self.reader.stop()

    async def send(self, first: int, count: int) -> None:
        for a, b in zip(walk(count, "left", first), walk(count, "right", first), strict=True):
            self.sender.send(a)
            self.sender.send(b)
            await asyncio.sleep(0.001)

    async def arrived(self, count: int) -> None:
        await asyncio.wait_for(self.sender.finish(), 60)
        await self.reader.until(lambda: len(self.reader.got) >= 2 * count)
        assert self.reader.of("left") == walk(count)
        assert self.reader.of("right") == walk(count, "right")
        assert self.source.info.line.get("lost on the way", 0) == 0


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(forwarder, "PING_S", 0.3)
    monkeypatch.setattr(forwarder, "SILENT_S", 0.6)
    monkeypatch.setattr(forwarder, "LONGEST_WAIT_S", 0.4)


def test_a_cut_cable_costs_nothing() -> None:
    async def main() -> None:
        async with Line() as line:
            await line.send(0, 300)
            line.cable.cut()
            await line.send(300, 600)
            await asyncio.sleep(1.0)
            await line.cable.plug_in()
            await line.send(900, 300)
            await line.arrived(1200)
            assert line.cable.connections >= 2
            assert any("away" in words for words in line.told)
            assert line.sender.summary() == "2400 samples delivered, 0 not acknowledged"

    asyncio.run(main())


def test_a_cable_that_goes_silent_is_noticed() -> None:
    async def main() -> None:
        async with Line() as line:
            await line.send(0, 200)
            line.cable.stall(True)
            await line.send(200, 200)
            await asyncio.sleep(2.0)
            line.cable.cut()  # what stood in the stalled cable is gone
            line.cable.stall(False)
            await line.cable.plug_in()
            await line.send(400, 100)
            await line.arrived(500)

    asyncio.run(main())


def test_many_cuts_in_the_middle_of_messages_cost_nothing() -> None:
    async def main() -> None:
        async with Line() as line:
            for i in range(8):
                await line.send(100 * i, 100)
                line.cable.cut()
                await asyncio.sleep(0.05)
                await line.cable.plug_in()
            await line.arrived(800)

    asyncio.run(main())


def test_a_full_memory_gives_up_the_oldest_and_says_so() -> None:
    async def main() -> None:
        source = WsSource(parse_spec("ws:0"))
        reader = Reader(source)
        cable = Cable(source.port)
        await cable.plug_in()
        cable.cut()
        sender = WsSender(f"ws://127.0.0.1:{cable.port}", 5, Links(limit_bytes=50_000), lambda _: None)
        for sample in walk(5000):
            sender.send(sample)
        task = asyncio.create_task(sender.run())
        await cable.plug_in()
        await asyncio.wait_for(sender.finish(), 60)
        delivered = int(sender.summary().split()[0])
        await reader.until(lambda: len(reader.got) == delivered)
        assert 100 < delivered < 5000
        assert reader.of("left") == walk(delivered, first=5000 - delivered)
        assert f"{5000 - delivered} given up" in sender.summary()
        task.cancel()
        cable.cut()
        reader.stop()

    asyncio.run(main())


def test_a_source_that_begins_anew_is_a_new_session() -> None:
    async def main() -> None:
        async with Line() as line:
            for sample in walk(50):
                line.sender.send(sample)
            line.sender.begin_anew(6)
            for sample in walk(50):
                line.sender.send(sample)
            await asyncio.wait_for(line.sender.finish(), 60)
            await line.reader.until(lambda: len(line.reader.got) == 100)
            assert [s.seq for s in line.reader.got] == list(range(100))
            assert line.source.info.line == {}

    asyncio.run(main())


def test_a_receiver_that_refuses_the_token_ends_it(tmp_path: Path) -> None:
    (tmp_path / "token").write_text("right")

    async def main() -> None:
        source = WsSource(parse_spec(f"ws:0?token-file={tmp_path / 'token'}"))
        with pytest.raises(InputError, match="token"):
            await WsSender(f"ws://127.0.0.1:{source.port}", 5, Links("wrong"), print).run()
        source.close()

    asyncio.run(main())


def test_datagrams_arrive_and_a_lost_one_is_made_good_by_the_next() -> None:
    async def main() -> None:
        source = UdpSource(parse_spec("udp:0"))
        reader = Reader(source)
        sender = UdpSender("127.0.0.1", source.port, 5, repeats=2)
        deaf = UdpSender("127.0.0.1", 9, 5, repeats=2)
        sender._before, sent = deaf._before, walk(100)  # what the deaf one sends is lost
        for i, sample in enumerate(sent):
            (deaf if i % 3 else sender).send(sample)
            await asyncio.sleep(0.001)
        await reader.until(lambda: len(reader.got) == 100)
        assert [s.seq for s in reader.got] == list(range(100))
        assert source.info.line.get("lost on the way", 0) == 0
        assert "34 samples sent" in sender.summary()
        reader.stop()

    asyncio.run(main())


@pytest.mark.parametrize(
    "address",
    [
        "ws://x",
        "http://a:1",
        "udp://127.0.0.1",
        "udp://127.0.0.1:0",
        "udp://127.0.0.1:1?repeat=0008000",
        "udp://127.0.0.1:1?repeat=9",
        "udp://127.0.0.1:1?x=1",
        "ws://[",
    ],
)
def test_an_address_that_is_none_is_said(address: str) -> None:
    with pytest.raises(InputError, match="expected"):
        sender_to(address, 1, Links(), print)
