"""Benchmarks: 10,000 simulated strides of every kind, with a sensor's errors: how far off is it, and sure?"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from app.estimator.tracker import Tracker, store
from app.motion.basics import Floats
from app.motion.samples import Samples
from app.settings import Settings
from app.simulate.sensors import SensorErrors, read
from app.simulate.walk import make_walk
from benchmarks import scoring

#: How each kind walks: what is asked of ``sim:walk``.
KINDS = {
    "normal": "cadence=110&stride_m=1.35",
    "slow": "cadence=60&stride_m=0.8",
    "fast": "cadence=140&stride_m=1.8",
    "running": "cadence=170&stride_m=2.6&lift_m=0.25",
    "stairs": "path=stairs&cadence=90",
    "turns": "path=eight&size_m=4&cadence=100&stride_m=1.1",
    "shuffles": "cadence=90&stride_m=0.35&lift_m=0.02",
    "stops": "cadence=110&stride_m=1.35",
}
WALKS, STRIDES, RATE_HZ = 25, 50, 200
#: A consumer's sensor at 200 Hz: noise of force, rate and field; biases drawn anew for each walk (σ).
NOISE = (0.03, 0.0035, 0.3)
FORCE_BIAS, RATE_BIAS = 0.03, 0.004
RANGES = (16 * 9.80665, np.radians(2000.0), 4900.0)
#: A walk has failed whose RMSE is more than this share of its path, or of whose strides so many are off.
FAILED_PERCENT, FAILED_STRIDES = 2.0, 0.04
#: Each stop lasts so long; the walk stands once every so many strides.
STOP_S, EVERY = 2.0, 5


class Walk(NamedTuple):
    """One walk: RMSE in per cent of the path, strides found, and the word at its end."""

    percent: float
    strides: int
    word: str

    @property
    def failed(self) -> bool:
        """Whether it is far off."""
        return self.percent > FAILED_PERCENT or abs(self.strides - STRIDES) > FAILED_STRIDES * STRIDES


class Kind(NamedTuple):
    """All walks of a kind."""

    name: str
    walks: list[Walk]

    @property
    def failed(self) -> list[Walk]:
        """Those that failed."""
        return [walk for walk in self.walks if walk.failed]

    @property
    def unnoticed(self) -> list[Walk]:
        """Those that failed and were called good."""
        return [walk for walk in self.failed if walk.word == "good"]


def kinds(settings: Settings, walks: int = WALKS) -> Iterator[Kind]:
    """Every kind, its walks one after the other."""
    for number, (name, query) in enumerate(KINDS.items()):
        seeds = range(1000 * number, 1000 * number + walks)
        yield Kind(name, [one(query, seed, settings, stops=name == "stops") for seed in seeds])


def one(query: str, seed: int, settings: Settings, stops: bool = False) -> Walk:
    """One walk: its truth is a formula, its samples have errors."""
    options = dict(part.split("=") for part in f"{query}&strides={STRIDES}&rate_hz={RATE_HZ}".split("&"))
    walk = make_walk(options)
    (ideal,) = walk.recording.sensors
    truth = walk.truth(ideal.sensor, ideal.matrix[:, 0] * 1e-9)[0]
    rows = with_stops(ideal.matrix, float(options["cadence"])) if stops else np.arange(len(ideal.matrix))
    samples = read(
        "foot",
        np.arange(len(rows), dtype=np.float64) * (1e9 / RATE_HZ),
        ideal.matrix[rows, 1:],
        errors(seed),
        seed,
    )
    return scored(samples, truth[rows], settings)


def with_stops(matrix: Floats, cadence_spm: float) -> Floats:
    """Row numbers in which every so many strides the middle of a stance lasts longer."""
    rate = np.linalg.norm(matrix[:, 4:7], axis=1)
    still = np.convolve(rate, np.ones(21), "same") < 1e-9
    cycle = int(120.0 / cadence_spm * RATE_HZ)
    places = [
        np.flatnonzero(still[at : at + cycle]) + at for at in range(3 * cycle, len(rate), EVERY * cycle)
    ]
    held = [int(place[len(place) // 2]) for place in places if len(place)]
    counts = np.ones(len(rate), int)
    counts[held] = int(STOP_S * RATE_HZ)
    repeated: Floats = np.repeat(np.arange(len(rate)), counts)
    return repeated


def errors(seed: int) -> SensorErrors:
    """A sensor drawn by chance."""
    chance = np.random.default_rng(seed)
    a, b, c = (float(x) for x in FORCE_BIAS * chance.standard_normal(3))
    u, v, w = (float(x) for x in RATE_BIAS * chance.standard_normal(3))
    return SensorErrors(NOISE, ((a, b, c), (u, v, w), (0.0, 0.0, 0.0)), RANGES, None, 0.0)


def scored(samples: Samples, truth: Floats, settings: Settings) -> Walk:
    """What the estimator makes of it."""
    tracker = Tracker(settings)
    tracker.advance(store(samples))
    rows = tracker.rows.table(tracker.rows.start, tracker.rows.end)
    up = scoring.up(truth)
    percent = 100.0 * scoring.rmse_m(scoring.up(rows[:, :3]), up) / scoring.path_m(up, scoring.PATH_EVERY)
    return Walk(percent, tracker.stride_count, tracker.trust.word if tracker.trust else "")
