"""A machine that is slow for a moment costs no sample: the sensor's process, or this one, held up."""

from __future__ import annotations

import asyncio
import ctypes
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from itertools import pairwise

import pytest

from app.motion.samples import Sample
from app.sources.opening import open_source

Stall = Callable[[subprocess.Popen[str]], None]
WALK = "sim:walk?path=straight&rate_hz=100&duration_s={seconds}"


def held_up(process: subprocess.Popen[str]) -> None:
    """This interpreter, by a call that does not let go of it."""
    ctypes.PyDLL(None).usleep(1_000_000)


def stopped(seconds: float) -> Stall:
    """The sensor, so long that it counts as silent and is asked, perhaps more than once."""

    def stall(process: subprocess.Popen[str]) -> None:
        process.send_signal(signal.SIGSTOP)
        asyncio.get_running_loop().call_later(seconds, process.send_signal, signal.SIGCONT)

    return stall


async def read(seconds: int, stall: Stall) -> tuple[list[Sample], int, int]:
    """The samples of a sensor held up while it sends, how many it sent, how often it was started again."""
    source = WALK.format(seconds=seconds)
    command = [sys.executable, "-m", "app", "emulate", "mip", "--source", source, "--baud", "115200"]
    samples: list[Sample] = []
    details: set[str] = set()
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=os.getcwd()) as process:
        assert process.stdout is not None
        live = open_source(f"serial:{process.stdout.readline().strip()}?device=mip&baud=115200")

        async def take() -> None:
            async for item in live:
                assert isinstance(item, Sample)
                samples.append(item)
                details.add(live.detail)

        task = asyncio.create_task(take())
        try:
            async with asyncio.timeout(60.0):
                while not samples:
                    await asyncio.sleep(0.05)
                stall(process)
                told = await asyncio.to_thread(process.stdout.readline)
            await asyncio.sleep(0.2)
        finally:
            task.cancel()
            live.close()
            process.kill()
    again = (re.search(r"(\d+) times? lost", detail) for detail in details)
    return (
        samples,
        int(json.loads(told)["messages"]),
        max((int(found[1]) for found in again if found), default=0),
    )


@pytest.mark.parametrize(("stall", "seconds"), [(held_up, 4), (stopped(6.0), 9)], ids=["host", "sensor"])
def test_no_sample_is_lost(stall: Stall, seconds: int) -> None:
    """What it sent is there, but for what came while it was started; without a word to it all is there."""
    samples, sent, again = asyncio.run(read(seconds, stall))
    steps_ns = [b.device_ns - a.device_ns for a, b in pairwise(samples)]
    assert min(steps_ns) > 0
    assert len(samples) > sent - 40 * (1 + again)
    assert sent > 100 * seconds / 2
    assert again or max(steps_ns) < 15_000_000
