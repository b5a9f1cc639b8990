"""Turns: rates carry gravity from pose to pose as SciPy's rotations do, and their scale is found."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.calibration import report, turns


def spun(axis: int, degrees: float, scale: np.ndarray, null: np.ndarray, count: int = 300) -> turns.Turn:
    """A turn at a rate that swells and ebbs, read by a sensor with errors."""
    s = np.linspace(0.0, 1.0, count)
    speed = np.radians(degrees) * 6.0 * s * (1.0 - s)
    true = speed[:, np.newaxis] * np.eye(3)[axis]
    before = np.array([0.6, 0.0, -0.8]) if axis == 1 else np.array([0.0, 0.6, -0.8])
    after = Rotation.from_rotvec(-np.radians(degrees) * np.eye(3)[axis]).apply(before)
    return turns.Turn(
        before, after, true @ np.linalg.inv(scale).T + null, np.full(count - 1, 1.0 / (count - 1))
    )


def test_the_scale_of_known_turns_is_found() -> None:
    scale, null = np.diag([1.03, 0.97, 1.01]), np.array([0.01, -0.02, 0.005])
    made = [spun(axis, degrees, scale, null) for axis in range(3) for degrees in (90.0, -180.0)]
    got, left = turns.fit(made, null)
    np.testing.assert_allclose(np.diag(got), np.diag(scale), rtol=1e-4)
    assert left < 1e-3


@pytest.mark.parametrize("count", [2, 3, 64, 257])
def test_small_turns_multiply_as_scipy_says(count: int) -> None:
    vectors = np.random.default_rng(count).normal(0.0, 0.1, (count, 3))
    expected = Rotation.identity()
    for vector in vectors:
        expected = Rotation.from_rotvec(vector) * expected
    np.testing.assert_allclose(turns._product(vectors), expected.as_matrix(), atol=1e-12)


def test_the_reports_equations_are_those_printed() -> None:
    high, low = np.array([10.0, 9.0, 11.0]), np.array([-9.0, -10.0, -8.0])
    np.testing.assert_array_equal(report.null(high, low), [0.5, -0.5, 1.5])
    np.testing.assert_allclose(report.scale(high, low, 1.0) * (high - report.null(high, low)), 1.0)
    np.testing.assert_allclose(report.scale(high, low, 1.0) * (low - report.null(high, low)), -1.0)
    assert report.turn_scale(np.pi / 2, np.pi / 2.2) == pytest.approx(1.1)


def test_a_steady_turn_integrates_to_its_angle() -> None:
    rates = np.tile([0.1, 1.0, -0.5], (101, 1))
    got = report.turned(rates, np.full(100, 0.01), np.array([0.1, 0.0, 0.0]))
    np.testing.assert_allclose(got, [0.0, 1.0, -0.5], atol=1e-12)
