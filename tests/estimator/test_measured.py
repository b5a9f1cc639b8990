"""The papers' method on walks that were measured: one setting for every recording."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from app.settings import BUILT_IN, Settings
from tests.estimator.scoring import IN_PLACE, corridor_percent, rmse, vicon_percent, walked
from tests.estimator.walks import rows_of

PAPERS = Settings()
DEFAULT = BUILT_IN["default"]


def test_scoring_forgives_yaw_and_place_and_nothing_else() -> None:
    truth = np.random.default_rng(0).standard_normal((50, 3))
    c, s = np.cos(1.0), np.sin(1.0)
    turned = truth @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + [3.0, -1.0, 2.0]
    assert rmse(turned, truth) < 1e-12
    assert rmse(truth * [1.0, -1.0, 1.0], truth) > 0.5  # a mirror
    assert rmse(truth * 1.1, truth) > 0.1  # a scale


def test_vicon_room(shared_data: Path) -> None:
    files = [f for f in sorted((shared_data / "pyshoe_vicon").glob("*.mat")) if f.stem != IN_PLACE]
    assert len(files) == 28
    assert np.median([vicon_percent(file, PAPERS) for file in files]) <= 0.85


def test_corridor(shared_data: Path) -> None:
    points = sorted((shared_data / "hallway_gcp").glob("*_strideIndex_*.csv"))
    files = [p.with_name(p.name.split("_strideIndex")[0] + ".csv") for p in points]
    assert len(files) == 6
    assert np.median([corridor_percent(file, PAPERS) for file in files]) <= 0.90


def test_a_short_walk_closes(shared_data: Path) -> None:
    tracker, _ = walked(shared_data / "xio_ngimu" / "short_walk.csv", PAPERS)
    closure_m = float(np.hypot(*rows_of(tracker)[-1, :2]))
    assert 100.0 * closure_m / tracker.distance_m <= 1.7


def test_the_default_is_better_on_every_set(shared_data: Path) -> None:
    files = [f for f in sorted((shared_data / "pyshoe_vicon").glob("*.mat")) if f.stem != IN_PLACE]
    vicon = [vicon_percent(file, DEFAULT) for file in files]
    assert np.median(vicon) <= 0.32
    points = sorted((shared_data / "hallway_gcp").glob("*_strideIndex_*.csv"))
    corridor = [
        corridor_percent(p.with_name(p.name.split("_strideIndex")[0] + ".csv"), DEFAULT) for p in points
    ]
    assert np.mean(corridor) <= 0.36
    assert max(corridor) <= 0.75
    tracker, _ = walked(shared_data / "xio_ngimu" / "short_walk.csv", DEFAULT)
    assert 100.0 * float(np.hypot(*rows_of(tracker)[-1, :2])) / tracker.distance_m <= 0.3
