"""How sure: the ellipse holds the truth about as often as it says, and a word for when not to believe."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from app.estimator.tracker import Tracker
from app.estimator.trust import CHI2_95, trust_of
from app.settings import BUILT_IN
from app.sources.files import load
from tests.estimator.walks import estimate, foot, rows_of, samples_of, still, table_of

KALMAN = BUILT_IN["default"]


def test_the_papers_do_not_know() -> None:
    assert estimate(still(2.0)).trust is None


def test_nobody_knows_before_level() -> None:
    assert estimate(still(0.3), KALMAN).trust is None


def test_the_ellipse_is_the_covariances() -> None:
    tracker = estimate(foot("strides=10&rate_hz=200&noise=1"), KALMAN)
    tracker.state["P"][0][:2, :2] = [[4.0, 0.0], [0.0, 9.0]]
    trust = trust_of(tracker.state, 0.0)
    assert trust is not None
    assert trust.major_m == pytest.approx(3.0 * CHI2_95**0.5)
    assert trust.minor_m == pytest.approx(2.0 * CHI2_95**0.5)
    assert abs(trust.angle_rad) == pytest.approx(np.pi / 2)


def test_a_walk_is_good_and_a_foot_that_never_stands_is_lost() -> None:
    good = estimate(foot("strides=10&rate_hz=200&noise=1"), KALMAN).trust
    assert good is not None
    assert good.word == "good"
    t_s = np.arange(1200) / 200
    waving = t_s > 1.0
    rate = np.zeros((1200, 3))
    rate[waving, 1] = 0.5  # turning on and on, too slow for walking
    force = np.tile([0.0, 0.0, -9.81], (1200, 1))
    force[waving, 0] = 4.0 * np.sin(9.0 * t_s[waving])
    lost = estimate(samples_of(t_s, force, rate), KALMAN).trust
    assert lost is not None
    assert lost.word == "lost"
    assert "no stance" in lost.why


def test_samples_said_at_the_wrong_rate_are_not_good() -> None:
    samples = foot("strides=20&rate_hz=200&noise=1")
    hurried = samples.matrix.copy()
    hurried[:, 0] /= 2.0
    trust = estimate(replace(samples, matrix=hurried), KALMAN).trust
    assert trust is not None
    assert trust.word == "lost"
    assert "rate" in trust.why


def test_the_ellipse_holds_the_truth_of_the_vicon_room(shared_data: Path) -> None:
    inside: list[bool] = []
    for file in sorted((shared_data / "pyshoe_vicon").glob("*.mat"))[::3]:
        samples = load(file).sensors[0]
        mat = scipy.io.loadmat(str(file))
        t_s, stamps = (samples.device_ns + samples.matrix[:, 0]) * 1e-9, mat["ts"].ravel()
        truth = np.column_stack([np.interp(t_s, stamps, mat["gt"][:, axis]) for axis in range(2)])
        table, tracker, at, inverse = table_of(samples.matrix[:0]), Tracker(KALMAN), [], []
        for end in range(400, len(samples), 100):
            table.extend(samples.matrix[table.end : end])
            tracker.advance(table)
            at.append(end - 1)
            inverse.append(np.linalg.inv(tracker.state["P"][0][:2, :2]))
        e, t = rows_of(tracker)[at, :2], truth[at] - truth[0]
        yaw = np.arctan2(np.sum(e[:, 0] * t[:, 1] - e[:, 1] * t[:, 0]), np.sum(e * t))
        c, s = np.cos(yaw), np.sin(yaw)
        away = e - t @ np.array([[c, -s], [s, c]])
        inside += [bool(d @ i @ d < CHI2_95) for d, i in zip(away, inverse, strict=True)]
    assert 0.90 <= np.mean(inside) <= 0.995
