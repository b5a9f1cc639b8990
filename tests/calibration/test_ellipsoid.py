"""Ellipsoids: what is squashed and moved is found, and what surrounds nothing is refused."""

from __future__ import annotations

import numpy as np
import pytest

from app.calibration import ellipsoid


def sphere(count: int, seed: int = 0) -> np.ndarray:
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return np.asarray(points / np.linalg.norm(points, axis=1)[:, np.newaxis])


@pytest.mark.parametrize("seed", range(4))
def test_an_ellipsoid_is_found_exactly(seed: int) -> None:
    rng = np.random.default_rng(seed)
    aside = rng.uniform(-0.05, 0.05, (3, 3))
    scale = np.diag(rng.uniform(0.9, 1.1, 3)) + aside + aside.T
    null = rng.uniform(-20, 20, 3)
    readings = 48.6 * sphere(200, seed) @ np.linalg.inv(scale).T + null
    got_null, got_scale, left = ellipsoid.fit(readings, 48.6, skew=True)
    np.testing.assert_allclose(got_null, null, atol=1e-6)
    np.testing.assert_allclose(got_scale, scale, atol=1e-7)
    assert left < 1e-6


def test_six_sides_are_enough_for_null_and_scale() -> None:
    scale, null = np.array([1.02, 0.98, 1.01]), np.array([0.1, -0.2, 0.3])
    sides = 9.8 * np.vstack([np.eye(3), -np.eye(3)]) / scale + null
    got_null, got_scale, _ = ellipsoid.fit(sides, 9.8, skew=False)
    np.testing.assert_allclose(got_null, null, atol=1e-9)
    np.testing.assert_allclose(got_scale, np.diag(scale), atol=1e-9)


@pytest.mark.parametrize(
    "readings",
    [np.ones((20, 3)), sphere(200) * [1.0, 1.0, 0.0], sphere(4), np.linspace(0, 1, 30).reshape(10, 3)],
)
def test_what_surrounds_no_centre_is_refused(readings: np.ndarray) -> None:
    with pytest.raises(ValueError, match="readings"):
        ellipsoid.fit(readings, 1.0, skew=True)
