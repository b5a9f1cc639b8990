"""A gyro bias from one walk to the next."""

from __future__ import annotations

import numpy as np
import pytest

from app.estimator.bias import learnt
from app.estimator.tracker import track
from app.motion.samples import GyroBias, Samples
from app.settings import Settings
from tests.estimator.walks import estimate, foot, rows_of, walk

KALMAN = Settings(estimator="kalman")
BIAS = np.array([0.002, -0.001, 0.006])
QUERY = "strides=20&rate_hz=100"


def biased(begin_s: float = 0.0) -> Samples:
    """A walk whose gyro is off by ``BIAS``, from this second on."""
    samples = foot(QUERY)
    matrix = samples.matrix[round(begin_s * 100) :].copy()
    matrix[:, 0] -= matrix[0, 0]
    matrix[:, 4:7] += BIAS
    return Samples(samples.sensor, samples.role, 0, matrix, np.zeros(len(matrix), np.uint16))


def heading_error(tracker: object, begin_s: float) -> float:
    """How far the direction from the tenth footprint to the last is off, rad."""
    rows = rows_of(tracker)  # type: ignore[arg-type]
    true = walk(QUERY).truth("foot", foot(QUERY).matrix[round(begin_s * 100) :, 0] * 1e-9)[0]
    ways = [path[-1, :2] - path[len(path) // 2, :2] for path in (rows, true)]
    start = [path[len(path) // 2, :2] - path[0, :2] for path in (rows, true)]
    turn = [np.arctan2(w[1], w[0]) - np.arctan2(s[1], s[0]) for w, s in zip(ways, start, strict=True)]
    return float(abs(np.angle(np.exp(1j * (turn[0] - turn[1])))))


def test_a_rest_teaches_the_bias_and_a_walk_that_never_rests_none() -> None:
    taught = learnt(estimate(biased(), KALMAN))
    assert taught is not None
    assert np.abs(np.array(taught.rate_b) - BIAS).max() < 1e-3
    assert max(taught.doubt_radps) <= 0.002
    assert learnt(estimate(biased(2.0), KALMAN)) is None
    assert learnt(estimate(biased(), Settings())) is None


def test_a_remembered_bias_keeps_a_moving_start_straight() -> None:
    known = learnt(estimate(biased(), KALMAN))
    moving = biased(2.0)
    assert heading_error(track(moving, KALMAN, known), 2.0) < 0.4 * heading_error(track(moving, KALMAN), 2.0)


def test_it_can_be_switched_off() -> None:
    known = GyroBias((0.1, 0.1, 0.1), (1e-3, 1e-3, 1e-3))
    off = KALMAN.with_changes({"remembered_bias": False})
    assert rows_of(track(biased(), off, known)).tobytes() == rows_of(track(biased(), off)).tobytes()


def test_a_still_start_outweighs_it() -> None:
    wrong = GyroBias((0.004, 0.004, -0.004), (5e-4, 5e-4, 5e-4))
    found = track(biased(), KALMAN, wrong).state["gyro_bias"][0]
    assert found == pytest.approx(BIAS, abs=1.5e-3)
