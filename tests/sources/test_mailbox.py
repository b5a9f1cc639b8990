import asyncio

import pytest

from app.motion import Sample
from app.sources.mailbox import Mailbox


def sample(seq: int) -> Sample:
    return Sample("foot", seq, seq, 0, (0.0, 0.0, -9.8), (0.0, 0.0, 0.0))


def test_what_workers_put_comes_out_in_order_and_ends_with_them() -> None:
    box = Mailbox()

    async def work() -> None:
        for first in range(0, 3000, 1000):
            box.put(sample(seq) for seq in range(first, first + 1000))
            await asyncio.sleep(0)

    async def taken() -> list[int]:
        return [item.seq async for item in box.items(work())]

    assert asyncio.run(taken()) == list(range(3000))


def test_a_fault_of_a_worker_comes_out() -> None:
    async def work() -> None:
        raise RuntimeError("broken")

    async def take() -> None:
        async for _ in Mailbox().items(work()):
            pass

    with pytest.raises(RuntimeError, match="broken"):
        asyncio.run(take())


def test_a_full_box_lets_others_run() -> None:
    """The loop has other things to do than to empty it."""

    async def run() -> int:
        box, ticks = Mailbox(), 0

        async def tick() -> None:
            nonlocal ticks
            while True:
                ticks += 1
                await asyncio.sleep(0)

        async def work() -> None:
            box.put(sample(seq) for seq in range(100_000))

        other = asyncio.create_task(tick())
        async for _ in box.items(work()):
            pass
        other.cancel()
        return ticks

    assert asyncio.run(run()) > 2
