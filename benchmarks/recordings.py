"""Benchmarks: an hour's recording: how soon it opens, how soon a seek lands; what recording costs."""

from __future__ import annotations

import asyncio
import resource
import tempfile
import time
from pathlib import Path

from app.formats import plain
from app.formats.journal import Start
from app.formats.keeping import Keeper
from app.motion.commands import Order, RestartHere, Seek
from app.motion.recording import Landing, Stretch
from app.motion.samples import Sample
from app.saving import Saver
from app.session import Session
from app.settings import Settings
from app.simulate.walk import make_walk
from app.sources.glanced import glanced
from app.sources.opening import open_source
from app.sources.replay import Replay
from app.sources.source import Item
from app.sources.timeline import Timeline
from app.warm import warm_up
from benchmarks.figures import Figure, Section

HOUR = {"path": "eight", "feet": "2", "rate_hz": "100", "noise": "1", "duration_s": "3600"}
FAST = {"path": "oval", "feet": "2", "rate_hz": "400", "noise": "1", "duration_s": "30"}
CHUNK_S = 0.2
KEY = bytes(32)
SEEKS_S = (3500.0, 1800.0, 60.0, 3000.0)


def recordings() -> Section:
    """All of it."""
    warm_up("papers")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hour.mcap"
        written_s, _ = write(path, HOUR)
        yield Figure("an hour of two feet at 100 Hz: its file", path.stat().st_size / 1e6, "MB")
        yield Figure("processor time of writing it", written_s, "s")
        open_source(str(path))  # what is compiled is there, the file in memory
        began = time.perf_counter()
        soon = glanced(str(path))
        assert soon is not None
        yield Figure("its trails to be drawn after", time.perf_counter() - began, "s", 2.0)
        began, used = time.perf_counter(), time.process_time()
        source = open_source(str(path), stretches=True, key=KEY)
        yield Figure("all of it read in", time.perf_counter() - began, "s")
        yield Figure("processor time of it", time.process_time() - used, "s")
        assert isinstance(source, Replay)
        took, filled = asyncio.run(seeks(source))
        yield Figure("seek and picture, the worst of four anywhere", max(took), "s", 1.0)
        yield Figure("and the walk before it filled in, by a worker", max(filled), "s")
        plain = open_source(str(path), stretches=True)
        assert isinstance(plain, Replay)
        slow, _ = asyncio.run(seeks(plain))
        yield Figure("seek without the states", max(slow), "s", 1.0)
        fast_s, csv = write(Path(folder) / "fast.mcap", FAST)
        share = fast_s / float(FAST["duration_s"])
        yield Figure("recording two feet at 400 Hz, of one core", 100.0 * share, "%", 10.0)
        size = (Path(folder) / "fast.mcap").stat().st_size
        yield Figure("its size ÷ that of plain CSV", size / csv, "×")
        yield Figure(
            "most memory of this process", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3, "MB"
        )


def write(path: Path, walk: dict[str, str]) -> tuple[float, int]:
    """Record a simulated walk as the recorder does; processor seconds of it, and the size as plain CSV."""
    recording = make_walk(walk).recording
    session, saver = Session(Settings()), Saver()
    saver.begin(session)
    roles = {samples.sensor: samples.role for samples in recording.sensors}
    timeline, keeper = Timeline(recording), Keeper({"source": "bench"}, roles, 10**18, KEY)
    each = int(CHUNK_S * sum(samples.rate_hz for samples in recording.sensors))
    used = 0.0
    with path.open("wb") as file:
        file.write(keeper.begin(0))
        keeper.start(0, Start(Settings(), Settings(), False))
        for first in range(0, len(timeline), each):
            samples = timeline.cut(first, min(first + each, len(timeline)), 0)
            session.take_stretch(timeline.stretch(first, first + len(samples), 0))
            due = list(saver.due(session))
            began = time.process_time()
            for i, sample in enumerate(samples):
                keeper.sample(sample._replace(host_ns=timeline.elapsed_ns(first + i)))
            for sensor, saved, way in due:
                keeper.estimate(sensor, timeline.elapsed_ns(first), saved, way)
            file.write(keeper.chunk())
            used += time.process_time() - began
        file.write(keeper.end())
    csv = len(plain.encode(recording)) if recording.duration_s < 100.0 else 0
    return used, csv


async def seeks(source: Replay) -> tuple[list[float], list[float]]:
    """Seconds from each order to seek to the snapshot that shows it, and then to fill in the walk before."""
    session = Session(source.settings or Settings())
    reading = aiter(source)

    def take(item: Item) -> None:
        if isinstance(item, Sample):
            session.take(item)
        elif isinstance(item, Stretch):
            session.take_stretch(item)
        elif isinstance(item, Landing):
            assert session.land(item)
        else:
            session.apply(Order(item, "replay", 0) if isinstance(item, RestartHere) else item)

    async def until(t_s: float) -> None:
        async for item in reading:
            take(item)
            if len(session.stores) == 2 and min(s.elapsed_s for s in session.stores.values()) >= t_s - 0.02:
                return

    await until(0.1)
    took, filled = [], []
    for t_s in SEEKS_S:
        began = time.perf_counter()
        source.control(Seek(t_s))
        await until(t_s)
        session.snapshot()
        took.append(time.perf_counter() - began)
        job = session.applying.filling
        if job is not None:
            began = time.perf_counter()
            session.applying.filled(job, job.run())
            filled.append(time.perf_counter() - began)
    return took, filled
