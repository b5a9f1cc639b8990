"""What is put in from any thread comes out once, in order, on the loop."""

from __future__ import annotations

import asyncio
import threading
import time

import pytest

from app.motion.samples import Sample
from app.motion.source import Link
from app.sources import inbox
from app.sources.inbox import Inbox


def sample(i: int, sensor: str = "left") -> Sample:
    return Sample(sensor, i, i, 0, (0.0, 0.0, -9.8), (0.0, 0.0, 0.0))


async def read(box: Inbox, count: int) -> list[int]:
    got: list[int] = []
    async with asyncio.timeout(30):
        async for item in box:
            assert isinstance(item, Sample)
            got.append(item.seq)
            if len(got) == count:
                break
    return got


def test_what_several_threads_put_in_is_read_once_and_each_in_order() -> None:
    box = Inbox("test", "test")

    def put(start: int) -> None:
        for i in range(start, start + 2000):
            box.put([sample(i)])
            if i % 500 == 0:
                time.sleep(0.003)

    threads = [threading.Thread(target=put, args=(start,)) for start in (0, 10_000, 20_000)]

    async def main() -> list[int]:
        box.put([sample(-1)])  # before anybody reads
        for thread in threads:
            thread.start()
        return await read(box, 6001)

    got = asyncio.run(main())
    assert got[0] == -1
    for start in (0, 10_000, 20_000):
        assert [i for i in got if start <= i < start + 2000] == list(range(start, start + 2000))


def test_it_says_who_has_sent_and_whether_anybody_does(monkeypatch: pytest.MonkeyPatch) -> None:
    box = Inbox("ws:9000", "messages", lambda: ["a note"], lambda: {"lost": 3, "nothing": 0})
    assert str(box.link) == Link.WAITING
    assert "nobody sends yet" in box.detail
    box.put([sample(0), sample(0, "right")])
    assert str(box.link) == Link.LIVE
    assert box.detail == ""
    assert {name: role.value for name, role in box.info.sensors.items()} == {"left": "left", "right": "right"}
    assert (box.info.assumed, box.info.line) == (("a note",), {"lost": 3})
    monkeypatch.setattr(inbox, "SILENT_S", 0.0)
    assert str(box.link) == Link.LOST
    assert "any more" in box.detail


def test_a_walk_that_never_reads_costs_a_stated_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inbox, "MOST", 100)
    box = Inbox("test", "test")
    for i in range(1000):
        box.put([sample(i)])
    dropped = sum(box.info.line.values())
    got = asyncio.run(read(box, 1000 - dropped))
    assert got == list(range(dropped, 1000))
    assert len(got) <= 100


def test_what_came_and_was_not_read_is_there_at_the_end() -> None:
    """In the middle of a burst, too; what comes after the end is not kept."""
    box = Inbox("test", "test")
    box.put([sample(i) for i in range(100)])
    assert asyncio.run(read(box, 40)) == list(range(40))
    box.put([sample(100)])
    box.close()
    box.put([sample(101)])
    assert [left.seq for left in box.unread()] == list(range(40, 101))
    assert box.unread() == []


def test_a_reader_that_has_gone_harms_no_sender() -> None:
    box = Inbox("test", "test")
    box.put([sample(0)])
    asyncio.run(read(box, 1))
    box.put([sample(1)])
    box.put([sample(2)])
    assert str(box.link) == Link.LIVE
