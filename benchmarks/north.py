"""Benchmarks: a kilometre of eights with a gyro that drifts: what a magnetometer does to the heading."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from app.estimator.tracker import track
from app.motion.basics import Floats
from app.settings import Settings
from app.simulate.foot import rotate_to_body
from app.simulate.sensors import SensorErrors, read
from app.simulate.walk import make_walk
from benchmarks import scoring
from benchmarks.kinds import NOISE, RANGES

WALK = {"path": "eight", "size_m": "80", "strides": "800", "stride_m": "1.3", "rate_hz": "100"}
SEEDS = (1, 2, 3)
#: How far the gyro's bias drifts on every axis by the end, and what it is at the still start (σ), rad/s.
DRIFT_RADPS, BIAS_RADPS = 0.001, 0.003
#: The simulated earth's horizontal field, µT; how far a part of the place turns it; a magnet, µT m³.
FLAT_UT, TURN_RAD, MAGNET = 18.0, np.radians(15.0), 30.0
#: What is added to the field: of positions [n, 3] and chance, in *n* and in *b*, µT.
Bend = Callable[[Floats, np.random.Generator], tuple[Floats, Floats]]


def clean(place: Floats, _: np.random.Generator) -> tuple[Floats, Floats]:
    """Nothing."""
    return 0.0 * place, np.zeros(3)


def magnets(place: Floats, chance: np.random.Generator) -> tuple[Floats, Floats]:
    """Six magnets within a metre or two of the path: dipoles."""
    bent = 0.0 * place
    for at in place[chance.integers(0, len(place), 6)] + chance.normal(0.0, 1.0, (6, 3)):
        moment, away = chance.normal(0.0, MAGNET, 3), place - at
        far = np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 0.2)
        unit = away / far
        bent += (3.0 * unit * (unit @ moment)[:, None] - moment) / far**3
    return bent, np.zeros(3)


def turned(place: Floats, _: np.random.Generator) -> tuple[Floats, Floats]:
    """One half of the place turns the field, whose strength and dip stay."""
    turn = TURN_RAD / (1.0 + np.exp(-(place[:, 0] - place[:, 0].mean()) / 0.7))
    return FLAT_UT * np.column_stack([np.cos(turn) - 1.0, np.sin(turn), 0.0 * turn]), np.zeros(3)


def offset(ut: float) -> Bend:
    """An offset of the sensor that its calibration left."""

    def bend(place: Floats, chance: np.random.Generator) -> tuple[Floats, Floats]:
        way = chance.normal(0.0, 1.0, 3)
        return 0.0 * place, ut * way / np.linalg.norm(way)

    return bend


CASES: dict[str, Bend] = {
    "clean field": clean,
    "six magnets": magnets,
    "field turned by 15° in half of the place": turned,
    "1.5 µT left by the calibration": offset(1.5),
    "8 µT left": offset(8.0),
}


def held(settings: Settings, drift_radps: float) -> Iterator[tuple[str, float, float, float]]:
    """Each case: its mean error by the gyro alone, and with the field, and the most a walk lost by it: %."""
    for name, bend in CASES.items():
        pairs = []
        for seed in SEEDS:
            alone = settings.with_changes({"steady_north": False})
            pairs.append([one(bend, seed, drift_radps, which) for which in (alone, settings)])
        errors = np.array(pairs)
        gyro, field = errors.mean(axis=0).tolist()
        yield name, gyro, field, float(np.max(errors[:, 1] - errors[:, 0]))


def one(bend: Bend, seed: int, drift_radps: float, settings: Settings) -> float:
    """One walk's RMSE in per cent of its path."""
    walk = make_walk(WALK)
    (ideal,) = walk.recording.sensors
    t_s, chance = ideal.matrix[:, 0] * 1e-9, np.random.default_rng(seed)
    place, q_nb = walk.truth(ideal.sensor, t_s)
    in_n, in_b = bend(place, chance)
    matrix = ideal.matrix.copy()
    matrix[:, 7:10] += in_b + rotate_to_body(q_nb, in_n)
    matrix[:, 4:7] += drift_radps * chance.choice([-1.0, 1.0], 3) * (t_s / t_s[-1])[:, None]
    x, y, z = (BIAS_RADPS * chance.standard_normal(3)).tolist()
    errors = SensorErrors(NOISE, ((0.0, 0.0, 0.0), (x, y, z), (0.0, 0.0, 0.0)), RANGES, None, 0.0)
    tracker = track(read("foot", matrix[:, 0], matrix[:, 1:], errors, seed), settings)
    found, true = scoring.up(tracker.rows.table(0, tracker.rows.end)[:, :3]), scoring.up(place)
    return 100.0 * scoring.rmse_m(found, true) / scoring.path_m(true, scoring.PATH_EVERY)
