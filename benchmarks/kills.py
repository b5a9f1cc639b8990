"""Benchmarks: kill −9 at random moments of recording two feet at 400 Hz: what is lost, what comes back."""

from __future__ import annotations

import os
import random
import signal
import tempfile
import time
from pathlib import Path
from typing import NamedTuple, NoReturn

from app.formats import kept
from app.formats.journal import Start
from app.formats.recover import recover
from app.motion.basics import InputError
from app.motion.samples import Sample
from app.motion.source import SourceInfo
from app.outputs.recorder import Recorder
from app.settings import Settings
from app.simulate.walk import make_walk
from app.sources.timeline import Timeline
from benchmarks.figures import Figure, Section

KILLS = 200
RATE_HZ = 800.0
WALK = {"feet": "2", "rate": "400", "noise": "1", "path": "straight", "seed": "7"}
SOONEST_S, LATEST_S = 0.0, 2.0


class Killed(NamedTuple):
    """Of one kill: seconds lost, and whether what came back is an exact beginning of what was sent."""

    lost_s: float
    exact: bool


def kills(count: int = KILLS) -> Section:
    """At most a second lost each time, and never anything but a beginning of what was sent."""
    samples = some_samples()
    chance = random.Random(9)
    with tempfile.TemporaryDirectory() as folder:
        found = [kill(Path(folder), samples, chance.uniform(SOONEST_S, LATEST_S)) for _ in range(count)]
    yield Figure("kills while two feet are recorded at 400 Hz", len(found))
    yield Figure("recovered an exact prefix", sum(one.exact for one in found), "", len(found), True)
    yield Figure("lost, the worst", max(one.lost_s for one in found), "s", 1.0)
    yield Figure("lost, the median", sorted(one.lost_s for one in found)[len(found) // 2], "s")


def some_samples() -> list[Sample]:
    """A few seconds of two feet."""
    timeline = Timeline(make_walk(WALK).recording)
    return timeline.cut(0, min(len(timeline), int(RATE_HZ * 2 * LATEST_S)), 0)


def kill(folder: Path, samples: list[Sample], after_s: float) -> Killed:
    """Record in a process of its own, kill it, look at the file."""
    process = os.fork()
    if process == 0:
        record(folder, samples)
    while not list(folder.glob("*.mcap")):
        time.sleep(0.001)
    time.sleep(after_s)
    os.kill(process, signal.SIGKILL)
    killed_ns = time.monotonic_ns()
    os.waitpid(process, 0)
    (path,) = folder.glob("*.mcap")
    data = path.read_bytes()
    path.unlink()
    try:
        back = kept.samples(kept.kept(path.name, recover(path.name, data).data))
    except InputError:
        return Killed(after_s, True)  # nothing yet: all of it is lost
    exact = [one._replace(host_ns=0) for one in back] == [
        one._replace(host_ns=0) for one in samples[: len(back)]
    ]
    return Killed((killed_ns - back[-1].host_ns) * 1e-9 if back else after_s, exact)


def record(folder: Path, samples: list[Sample]) -> NoReturn:
    """Send the samples at their pace until somebody kills us."""
    recorder = Recorder(folder, "papers", "sim:walk", SourceInfo("walk", "simulated"))
    recorder.start(Start(Settings(), Settings(), False))
    began = time.monotonic()
    for i, sample in enumerate(samples):
        recorder.sample(sample._replace(host_ns=time.monotonic_ns()))
        time.sleep(max(0.0, began + i / RATE_HZ - time.monotonic()))
    os._exit(1)
