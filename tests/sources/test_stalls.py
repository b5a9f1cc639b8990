"""A machine that is slow for a moment costs no sample: the sensor's process, or this one, held up."""

from __future__ import annotations

import asyncio
import ctypes
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from itertools import pairwise

import pytest

from app.motion.samples import Sample
from app.sources.opening import open_source

WALK = "sim:walk?path=straight&rate_hz=100&duration_s={seconds}"


def held_up(process: subprocess.Popen[str]) -> None:
    """This interpreter, by a call that does not let go of it."""
    ctypes.PyDLL(None).usleep(1_000_000)


def stopped(process: subprocess.Popen[str]) -> None:
    """The sensor, so long that it counts as silent and is started anew."""
    process.send_signal(signal.SIGSTOP)
    asyncio.get_running_loop().call_later(2.6, process.send_signal, signal.SIGCONT)


async def read(seconds: int, stall: Callable[[subprocess.Popen[str]], None]) -> tuple[list[Sample], int]:
    """The samples of a sensor held up while it sends, and how many it sent."""
    source = WALK.format(seconds=seconds)
    command = [sys.executable, "-m", "app", "emulate", "mip", "--source", source, "--baud", "115200"]
    samples: list[Sample] = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=os.getcwd()) as process:
        assert process.stdout is not None
        live = open_source(f"serial:{process.stdout.readline().strip()}?device=mip&baud=115200")

        async def take() -> None:
            async for item in live:
                assert isinstance(item, Sample)
                samples.append(item)

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
    return samples, int(json.loads(told)["messages"])


@pytest.mark.parametrize(("stall", "seconds", "most"), [(held_up, 4, 0), (stopped, 5, 60)])
def test_no_sample_is_lost(stall: Callable[[subprocess.Popen[str]], None], seconds: int, most: int) -> None:
    """Between the first and the last none is missing but ``most``: what was measured while it was asked."""
    samples, sent = asyncio.run(read(seconds, stall))
    steps_ns = [b.device_ns - a.device_ns for a, b in pairwise(samples)]
    assert min(steps_ns) > 0
    assert sum(round(step_ns / 10_000_000) - 1 for step_ns in steps_ns) <= most
    assert len(samples) > sent - 40  # at the beginning, while it is started
