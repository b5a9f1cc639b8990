"""Two feet together: headings that drift are kept together, a walk that needs nothing is only turned."""

from __future__ import annotations

import numpy as np
import pytest

from app.estimator import smoother
from app.estimator.feet import Worn, link_worn
from app.estimator.tracker import Tracker
from app.motion.basics import Floats, Role
from app.motion.samples import Samples
from app.settings import Settings
from tests.estimator.walks import rows_of, table_of, walk

HINDSIGHT = Settings(estimator="kalman", hindsight=True, sensor_height_m=0.0)
WORN = {"left": Worn(Role.LEFT), "right": Worn(Role.RIGHT)}
BESIDE = np.array([0.0, 0.2])
QUERY = "feet=2&rate_hz=100&path=square&size_m=20&strides=60"


def walked(
    query: str, drift_radps: float, turned_rad: float = 0.0
) -> tuple[dict[str, Tracker], dict[str, Samples]]:
    """Both feet of a walk, the gyros' biases come only after the start: left one way, right the other."""
    trackers, samples = {}, {}
    for foot in walk(query).recording.sensors:
        matrix = foot.matrix.copy()
        sign = 1.0 if foot.sensor == "left" else -1.0
        matrix[:, 6] += sign * drift_radps * (matrix[:, 0] > 2e9)
        heading = turned_rad if foot.sensor == "right" else 0.0
        tracker = Tracker(HINDSIGHT.with_changes({"start_heading_rad": heading}))
        tracker.advance(table_of(matrix))
        smoother.finish(tracker, table_of(matrix))
        trackers[foot.sensor] = tracker
        samples[foot.sensor] = Samples(foot.sensor, foot.role, 0, matrix, foot.saturation)
    return trackers, samples


def linked(trackers: dict[str, Tracker], samples: dict[str, Samples], apart_m: float = 1.0) -> bool:
    return link_worn(trackers, WORN, {name: table_of(s.matrix) for name, s in samples.items()}, apart_m)


def apart(trackers: dict[str, Tracker]) -> Floats:
    """From the left foot to the right, horizontally [n, 2]."""
    left, right = (rows_of(trackers[name])[:, :2] for name in ("left", "right"))
    return right + BESIDE - left


def true_apart(query: str, samples: dict[str, Samples]) -> Floats:
    truth = {name: walk(query).truth(name, s.matrix[:, 0] * 1e-9)[0][:, :2] for name, s in samples.items()}
    return truth["right"] + BESIDE - truth["left"]


def alone(query: str, name: str, trackers: dict[str, Tracker], samples: dict[str, Samples]) -> float:
    """RMSE of one foot's walk after the best turn and shift, m."""
    true = walk(query).truth(name, samples[name].matrix[:, 0] * 1e-9)[0][:, :2]
    e, t = (path - path.mean(axis=0) for path in (rows_of(trackers[name])[:, :2], true))
    yaw = np.arctan2(np.sum(e[:, 0] * t[:, 1] - e[:, 1] * t[:, 0]), np.sum(e * t))
    turned = e @ np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    return float(np.sqrt(np.mean(np.sum((turned - t) ** 2, axis=1))))


@pytest.mark.parametrize("drift_radps", [1e-3, 3e-3])
def test_headings_that_drift_apart_come_together_and_each_walk_gets_better(drift_radps: float) -> None:
    trackers, samples = walked(QUERY, drift_radps)
    true = true_apart(QUERY, samples)
    before = float(np.sqrt(np.mean((apart(trackers) - true) ** 2)))
    singles = [alone(QUERY, name, trackers, samples) for name in WORN]
    assert linked(trackers, samples)
    assert np.sqrt(np.mean((apart(trackers) - true) ** 2)) < 0.4 * before
    assert np.hypot(*apart(trackers).T).max() < 1.15
    for name, single in zip(WORN, singles, strict=True):
        assert alone(QUERY, name, trackers, samples) < single


@pytest.mark.parametrize("query", ["feet=2&rate_hz=100&strides=12", QUERY])
def test_a_walk_that_needs_nothing_is_only_turned(query: str) -> None:
    trackers, samples = walked(query, 0.0, turned_rad=0.7)
    singles = [alone(query, name, trackers, samples) for name in WORN]
    left = rows_of(trackers["left"])
    assert linked(trackers, samples)
    assert np.abs(rows_of(trackers["left"]) - left).max() < 1e-3
    assert np.abs(apart(trackers) - true_apart(query, samples)).max() < 0.5
    for name, single in zip(WORN, singles, strict=True):
        assert alone(query, name, trackers, samples) == pytest.approx(single, abs=1e-3)


def test_rows_strides_and_state_stay_one_walk() -> None:
    trackers, samples = walked(QUERY, 3e-3)
    lengths = {name: [s.length_m for s in t.strides] for name, t in trackers.items()}
    assert linked(trackers, samples)
    for name, tracker in trackers.items():
        rows, t_s = rows_of(tracker), samples[name].matrix[:, 0] * 1e-9
        assert [s.length_m for s in tracker.strides] == lengths[name]
        ends = np.array([s.end_n for s in tracker.strides])
        places = rows[np.searchsorted(t_s, [s.end_s - 1e-6 for s in tracker.strides]), :2]
        assert ends[:, :2] == pytest.approx(places, abs=1e-6)
        assert np.linalg.norm(rows[:, 6:10], axis=1) == pytest.approx(1.0)
        velocity = np.gradient(rows[:, :2], t_s, axis=0)
        assert np.abs(velocity - rows[:, 3:5])[5:-5].mean() < 0.05
        assert (float(tracker.state["px"][0]), float(tracker.state["py"][0])) == pytest.approx(rows[-1, :2])


def test_one_foot_two_lefts_no_bound_and_strangers_are_not_linked() -> None:
    trackers, samples = walked("feet=2&rate_hz=100&strides=12", 0.0)
    assert not linked(trackers, samples, apart_m=0.0)
    stores = {name: table_of(s.matrix) for name, s in samples.items()}
    one = {"left": trackers["left"]}
    assert not link_worn(one, WORN, stores, 1.0)
    assert not link_worn(trackers, {name: Worn(Role.LEFT) for name in WORN}, stores, 1.0)
    other, others = walked(QUERY, 0.0)
    before = rows_of(trackers["left"]).tobytes()
    mixed = {"left": trackers["left"], "right": other["right"]}
    assert not link_worn(
        mixed, WORN, {"left": stores["left"], "right": table_of(others["right"].matrix)}, 1.0
    )
    assert rows_of(trackers["left"]).tobytes() == before
