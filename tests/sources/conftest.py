"""What the source tests share: small recordings, and a clock that only waiting moves."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from app.motion.basics import role_of
from app.motion.recording import Recording
from app.motion.samples import Samples


def make_recording(*stamps_ms: tuple[str, list[int]], start_ns: int = 0) -> Recording:
    """Feet with samples at these milliseconds; the force numbers them."""
    sensors = []
    for sensor, stamps in stamps_ms:
        matrix = np.full((len(stamps), 10), np.nan)
        matrix[:, 0] = (np.array(stamps) - stamps[0]) * 1_000_000
        matrix[:, 1:7] = np.arange(len(stamps))[:, None]
        first = start_ns + stamps[0] * 1_000_000
        sensors.append(Samples(sensor, role_of(sensor), first, matrix, np.zeros(len(stamps), np.uint16)))
    return Recording("walk.csv", "plain CSV", tuple(sensors))


class FakeClock:
    """Time stands still until somebody waits."""

    def __init__(self) -> None:
        self.ns = 10**15
        self.waits: list[float] = []

    def now_ns(self) -> int:
        return self.ns

    async def wait(self, event: asyncio.Event, seconds: float | None) -> None:
        if seconds is None:
            await event.wait()
            return
        await asyncio.sleep(0)
        self.waits.append(seconds)
        self.ns += round(seconds * 1e9)


@pytest.fixture
def clock() -> FakeClock:
    return FakeClock()


@pytest.fixture
def recording_of():
    return make_recording
