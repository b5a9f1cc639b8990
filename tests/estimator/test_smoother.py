"""The smoother: nothing moves where nothing is to know, and the past gets nearer to the truth."""

from __future__ import annotations

import numpy as np
import pytest

from app.blocks import BLOCK
from app.estimator.smoother import finish, smooth
from app.estimator.tracker import Tracker
from app.motion.basics import Floats
from app.motion.samples import Samples
from app.settings import BUILT_IN, Settings
from tests.estimator.scoring import rmse
from tests.estimator.walks import foot, rows_of, still, table_of, walk, without

KALMAN = BUILT_IN["default"]


def tracked(samples: Samples, settings: Settings = KALMAN) -> Tracker:
    tracker = Tracker(settings)
    tracker.advance(table_of(samples.matrix))
    return tracker


def smoothed(samples: Samples) -> Tracker:
    tracker = tracked(samples)
    smooth(tracker, table_of(samples.matrix))
    return tracker


def test_rest_stays_rest() -> None:
    assert np.abs(rows_of(smoothed(still(5.0)))[:, :6]).max() < 1e-9


def test_the_same_strides_with_the_same_ends() -> None:
    samples = foot("strides=20&rate_hz=200&noise=1&seed=2")
    before, after = tracked(samples), smoothed(samples)
    assert [s.number for s in after.strides] == [s.number for s in before.strides]
    assert np.allclose([s.length_m for s in after.strides], [s.length_m for s in before.strides], atol=0.05)
    assert abs(after.distance_m - sum(s.length_m for s in after.strides)) < 1e-9


def test_hindsight_is_nearer_to_the_truth_within_a_swing() -> None:
    query = "strides=40&rate_hz=200&noise=3&seed="
    gains: list[float] = []
    for seed in range(6):
        samples = foot(f"{query}{seed}")
        truth: Floats = walk(f"{query}{seed}").truth(samples.sensor, samples.matrix[:, 0] * 1e-9)[0]
        live = rmse(rows_of(tracked(samples))[:, :3], truth)
        gains.append(rmse(rows_of(smoothed(samples))[:, :3], truth) / live)
    assert np.mean(gains) < 1.0


def test_the_start_stays_and_attitudes_stay_unit() -> None:
    after = rows_of(smoothed(foot("strides=8&rate_hz=200&noise=1&seed=5")))
    assert np.abs(after[:50, :3]).max() < 1e-6
    assert np.abs(np.linalg.norm(after[:, 6:10], axis=1) - 1.0).max() < 1e-9


def test_blocks_leave_no_seam() -> None:
    samples = foot("strides=60&rate_hz=200&noise=1&seed=5")
    assert len(samples) > 2 * BLOCK
    rows = rows_of(smoothed(samples))
    steps = np.linalg.norm(np.diff(rows[:, :3], axis=0), axis=1)
    expected = np.linalg.norm(rows[:-1, 3:6], axis=1) / 200
    assert np.abs(steps - expected).max() < 0.01


def test_a_gap_is_no_obstacle() -> None:
    samples = without(foot("strides=12&rate_hz=200"), 6.0, 8.0)
    rows = rows_of(smoothed(samples))
    assert np.isfinite(rows).all()
    assert np.abs(np.diff(rows[:, :3], axis=0)).max() < 0.1


def test_only_who_asks_for_hindsight_gets_it() -> None:
    samples = foot("strides=6&rate_hz=200&noise=1")
    for name in ("papers", "default"):
        tracker = tracked(samples, BUILT_IN[name])
        before = rows_of(tracker)
        finish(tracker, table_of(samples.matrix))
        assert np.array_equal(rows_of(tracker), before)
    tracker = tracked(samples, BUILT_IN["hindsight"])
    before = rows_of(tracker)
    finish(tracker, table_of(samples.matrix))
    assert not np.array_equal(rows_of(tracker), before)


def test_the_first_stride_that_is_left_begins_at_the_footprint_before_it() -> None:
    """Also where the walk was interrupted before its oldest row."""
    samples = without(foot("strides=60&rate_hz=200&noise=1&seed=5"), 6.0, 8.0)
    tracker, table = tracked(samples), table_of(samples.matrix)
    tracker.drop_oldest()
    table.drop_oldest()
    base = tracker.checkpoints[BLOCK]
    assert tracker.segments[0] < BLOCK
    smooth(tracker, table)
    assert base.contact is not None
    first = next(stride for stride in tracker.strides if stride.number == base.strides + 1)
    assert first.start_s == base.contact.t_s
    assert first.stance_s > 0.0


def test_strides_still_know_the_gaps_before_them() -> None:
    """A toe direction is sought anew behind a gap; two feet may be anywhere after one."""
    whole = foot("strides=30&rate_hz=200")
    samples = without(without(whole, 6.0, 8.0), 20.0, 21.0)
    before, after = tracked(samples), smoothed(samples)
    gaps_s = {round(step.end_s, 1): round(step.gap_s, 1) for step in before.steps if step.gap_s}
    assert sorted(gaps_s.values()) == [1.0, 2.0]
    assert {round(step.end_s, 1): round(step.gap_s, 1) for step in after.steps if step.gap_s} == gaps_s
    cut = without(whole, 6.0, 8.0)
    end = int(np.searchsorted(cut.matrix[:, 0], 8.6e9))  # it ends before the next stride
    ended = Samples(cut.sensor, cut.role, 0, cut.matrix[:end], cut.saturation[:end])
    assert smoothed(ended)._gap_s == tracked(ended)._gap_s == pytest.approx(2.005)
