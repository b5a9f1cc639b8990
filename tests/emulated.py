"""An emulated sensor and a serial source on it, on one loop, and what should come out."""

from __future__ import annotations

import asyncio
import math
import time
from dataclasses import dataclass, field
from typing import Any

from app.formats.wire import gx1_talk
from app.formats.wire.catalogue import KINDS
from app.formats.wire.faults import parse_faults
from app.motion.samples import Sample
from app.motion.source import SourceInfo
from app.shell.emulate import Emulator, Wanted
from app.sources.opening import open_recording, open_source
from app.sources.spec import parse_spec
from app.sources.timeline import Timeline
from tests.formats.wire.protocols import converse, result

WALK = "sim:walk?path=straight&strides=12&still_s=0.8&rate=100&noise=1&seed=4"
PATIENCE_S = 60.0


@dataclass
class Served:
    """What came of a sensor: the samples, what was said, what the emulator sent."""

    samples: list[Sample]
    info: SourceInfo
    counters: Any
    sent: dict[str, int]
    details: list[tuple[float, str]] = field(default_factory=list)  # when, what
    came_s: list[float] = field(default_factory=list)


def serve(
    device: str,
    options: str = "",
    baud: int | None = None,
    faults: tuple[str, ...] = (),
    source: str = WALK,
    enough: float = math.inf,
) -> Served:
    """Read an emulated sensor until its source ends, or until there are ``enough`` samples."""
    return asyncio.run(_serve(device, options, baud, faults, source, enough))


async def _serve(
    device: str, options: str, baud: int | None, faults: tuple[str, ...], source: str, enough: float
) -> Served:
    spec = parse_spec(source)
    recording, truth = open_recording(spec)
    wanted = Wanted(device, source, baud, faults=parse_faults(faults))
    emulator = Emulator(wanted, recording, truth, spec.loop)
    live = open_source(f"serial:{emulator.path}?{options}")
    samples: list[Sample] = []
    details: list[tuple[float, str]] = []
    came_s: list[float] = []

    async def take() -> None:
        async for item in live:
            assert isinstance(item, Sample)
            samples.append(item)
            came_s.append(time.monotonic())

    async def watch() -> None:
        while True:
            if not details or details[-1][1] != live.detail:
                details.append((time.monotonic(), live.detail))
            await asyncio.sleep(0.01)

    tasks = [asyncio.create_task(take()), asyncio.create_task(watch())]
    try:
        async with asyncio.timeout(PATIENCE_S):
            serving = asyncio.create_task(emulator.run())
            while not serving.done() and len(samples) < enough:
                await asyncio.sleep(0.02)
            if serving.done():
                serving.result()
            serving.cancel()
        for task in tasks:
            assert not task.done(), task.result()
        return Served(samples, live.info, live.counters["foot"], emulator.sent(), details, came_s)
    finally:
        for task in tasks:
            task.cancel()
        live.close()
        emulator.close()


def expected(device: str, source: str = WALK, rate_hz: float = 100.0, fast: bool = False) -> list[Sample]:
    """What the same sensor says through no port at all."""
    recording, truth = open_recording(parse_spec(source))
    kind = KINDS[device]
    model = gx1_talk.Gx1Device(kind.axes, gx1_talk.FASTEST) if fast else kind.model(kind.axes)
    setup = result(converse(kind.start_up(rate_hz), model)) if kind.start_up else None
    decoder = kind.decoder("foot", kind.axes, setup)
    emulator_view = Emulator.__new__(Emulator)  # only for how it orients its samples
    emulator_view._timeline, emulator_view._truth = Timeline(recording), truth
    timeline = emulator_view._timeline
    oriented = emulator_view._oriented(timeline.cut(0, len(timeline), 0), 0)
    samples: list[Sample] = []
    for index, sample in enumerate(oriented):
        elapsed_ns = timeline.elapsed_ns(index)
        samples += decoder.feed(model.measure(sample._replace(device_ns=elapsed_ns)), elapsed_ns)
    return samples


def values(sample: Sample) -> tuple[Any, ...]:
    """A sample without its times and number."""
    return (sample.specific_force_b, sample.angular_rate_b, sample.field_b, sample.device_q_nb)
