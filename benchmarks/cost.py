"""Benchmarks: what a sample, a walk and a sweep cost, beside imufusion and ahrs in the same process."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import ahrs
import imufusion
import numpy as np

from app.blocks import Blocks
from app.estimator import sweep
from app.estimator.smoother import smooth
from app.estimator.tracker import Tracker, store
from app.motion.recording import Recording
from app.motion.samples import Sample, Samples
from app.session import Session
from app.settings import BUILT_IN, Settings
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from app.sources.timeline import Timeline
from app.warm import warm_hindsight, warm_up
from benchmarks.figures import Figure, Section

SIX_MINUTES = "sim:walk?path=oval&rate_hz=100&duration_s=360&noise=1"
ROUNDS = 9

Timed = Callable[[], float]  # seconds of processor time for one round


def cost() -> Section:
    """Processor time of one thread, least of several interleaved rounds: what else runs costs nothing."""
    warm_up("papers")
    warm_up("kalman")
    warm_hindsight()
    recording, _ = open_recording(parse_spec(SIX_MINUTES))
    (samples,) = recording.sensors
    yield from per_sample(recording, samples)
    yield from whole_walk(samples)
    yield from gain_sweep(samples)


def per_sample(recording: Recording, samples: Samples) -> Section:
    """Microseconds for one sample, the libraries' own update calls beside ours."""
    loops = {
        "advance": lambda: live_calls(samples, Settings()),
        "kalman": lambda: live_calls(samples, BUILT_IN["default"]),
        "smoother": lambda: smoother_s(samples),
        "take": lambda: session_takes(recording),
        "imufusion": lambda: imufusion_calls(samples),
        "madgwick": lambda: ahrs_calls(ahrs.filters.Madgwick, samples, 2000),
        "mahony": lambda: ahrs_calls(ahrs.filters.Mahony, samples, 2000),
    }
    us = {name: 1e6 * seconds for name, seconds in interleaved(loops).items()}
    ours = us["advance"]
    yield Figure("one sample through Tracker.advance", ours, "µs", 3.0, note="attitude, gait, ZUPT, position")
    yield Figure("the same by the Kalman filter, profile default", us["kalman"], "µs", 6.0)
    yield Figure("its smoother, for each sample of the walk", us["smoother"], "µs", 15.0)
    yield Figure(
        "one sample through Session.take", us["take"], "µs", note="the first's, kept, with its trail"
    )
    for name, what in (
        ("imufusion", "imufusion Ahrs.update_no_magnetometer"),
        ("madgwick", "ahrs Madgwick.updateIMU"),
        ("mahony", "ahrs Mahony.updateIMU"),
    ):
        yield Figure(what, us[name], "µs", note=f"{us[name] / ours:.2g} × ours; attitude only")


def interleaved(loops: dict[str, Timed]) -> dict[str, float]:
    """Each loop's least time of several rounds, in turns, so that all meet the same machine."""
    rounds = [{name: loop() for name, loop in loops.items()} for _ in range(ROUNDS)]
    return {name: min(one[name] for one in rounds) for name in loops}


def live_calls(samples: Samples, settings: Settings) -> float:
    """Seconds a sample: the table grows by one row, the tracker takes it."""
    table, tracker = store(samples), Tracker(settings)
    count, table.end = table.end, 0
    began = time.thread_time()
    for end in range(1, count + 1):
        table.end = end
        tracker.advance(table)
    return (time.thread_time() - began) / count


def smoother_s(samples: Samples) -> float:
    """Seconds a sample that the smoother takes after the walk."""
    table, tracker = store(samples), Tracker(BUILT_IN["hindsight"])
    tracker.advance(table)
    began = time.thread_time()
    smooth(tracker, table)
    return (time.thread_time() - began) / len(table)


def session_takes(recording: Recording) -> float:
    """Seconds a sample through the session: kept, estimated, its trail settled."""
    session, taken = Session(Settings()), readings(recording)
    began = time.thread_time()
    for sample in taken:
        session.take(sample)
    return (time.thread_time() - began) / len(taken)


def readings(recording: Recording) -> list[Sample]:
    """The recording as a source gives it."""
    timeline = Timeline(recording)
    return timeline.cut(0, len(timeline), 0)


def imufusion_calls(samples: Samples) -> float:
    """Seconds a sample: arrays in degrees a second and g are made beforehand."""
    filter_ = imufusion.Ahrs()
    filter_.set_sample_period(0.01)
    rates = list(np.degrees(samples.matrix[:, 4:7]))
    forces = list(samples.matrix[:, 1:4] / 9.80665)
    began = time.thread_time()
    for rate, force in zip(rates, forces, strict=True):
        filter_.update_no_magnetometer(rate, force)
    return (time.thread_time() - began) / len(rates)


def ahrs_calls(kind: type, samples: Samples, count: int) -> float:
    """Seconds a sample of one of the ahrs package's filters, over the first ``count`` samples."""
    filter_ = kind(frequency=100.0)
    q = np.array([1.0, 0.0, 0.0, 0.0])
    rates, forces = list(samples.matrix[:count, 4:7]), list(samples.matrix[:count, 1:4])
    began = time.thread_time()
    for rate, force in zip(rates, forces, strict=True):
        q = filter_.updateIMU(q, gyr=rate, acc=force)
    return (time.thread_time() - began) / count


def whole_walk(samples: Samples) -> Section:
    """Samples a second on one core: a walk of six minutes, and two hours, whose rows no cache holds."""
    for turns, what in ((1, "six minutes"), (20, "two hours")):
        table = Blocks(samples.matrix.shape[1])
        for turn in range(turns):  # the same walk again and again
            rows = samples.matrix.copy()
            rows[:, 0] += turn * (rows[-1, 0] + 1e7)
            table.extend(rows)
        rate = len(table) / min(batch_s(table) for _ in range(ROUNDS))
        yield Figure(f"{what} in one call, samples a second on one core", rate, "", 4e6, True)


def batch_s(table: Blocks) -> float:
    """Seconds for all samples of a table."""
    tracker = Tracker(Settings())
    began = time.thread_time()
    tracker.advance(table)
    return time.thread_time() - began


def gain_sweep(samples: Samples) -> Section:
    """41 × 21 gains over six minutes, as the viewer does it and on one thread."""
    table, settings = store(samples), Settings()
    halves = np.array_split(sweep.GAINS_STANCE, 2)

    def both() -> None:
        with ThreadPoolExecutor(2) as pool:
            list(pool.map(lambda half: sweep.sweep(table, settings, half), halves))

    note = f"six minutes at 100 Hz, {len(table)} samples"
    yield Figure("41 × 21 gain sweep, two threads", wall_s(both), "s", 1.5, note=note)
    yield Figure("41 × 21 gain sweep, one thread", wall_s(lambda: sweep.sweep(table, settings)), "s")
    yield Figure("its processor time", processor_s(lambda: sweep.sweep(table, settings)), "s")


def wall_s(work: Callable[[], object]) -> float:
    """Least time on the clock of three runs."""
    return min(lapse(work, time.perf_counter) for _ in range(3))


def processor_s(work: Callable[[], object]) -> float:
    """Least processor time of this thread of three runs."""
    return min(lapse(work, time.thread_time) for _ in range(3))


def lapse(work: Callable[[], object], clock: Callable[[], float]) -> float:
    """Seconds by ``clock`` that ``work`` takes."""
    began = clock()
    work()
    return clock() - began
