"""Whether a magnetometer may be believed: what iron changes is seen, what a walk changes is not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.estimator.compass import FOOTPRINTS, judge, told
from app.motion.estimate import Compass
from app.motion.samples import Column, Samples
from app.settings import Settings
from tests.estimator.walks import estimate, foot, samples_of

KALMAN = Settings(estimator="kalman")
EARTH = np.array([20.0, 0.0, 40.0])


def judged(field_n: np.ndarray) -> Compass:
    """Footprints with these fields in *n*, along a way that is long enough."""
    places = np.column_stack([np.linspace(0.0, 9.0, FOOTPRINTS), np.zeros(FOOTPRINTS)])
    view = told(*judge(np.hstack([field_n, places])))
    assert view is not None
    return view


def test_the_earths_field_is_steady_whatever_its_strength_and_direction() -> None:
    field = np.tile(EARTH, (FOOTPRINTS, 1))
    assert judged(field).steady
    assert judged(3.0 * field @ np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])).steady


def turned(about: int, angles: np.ndarray) -> np.ndarray:
    """The earth's field, turned about an axis of n by each angle."""
    fields = []
    for angle in angles:
        c, s = math.cos(angle), math.sin(angle)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        if about == 1:
            turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        fields.append(turn @ EARTH)
    return np.array(fields)


@pytest.mark.parametrize(
    ("field", "why"),
    [
        (np.outer(np.linspace(0.8, 1.2, FOOTPRINTS), EARTH), "strength"),
        (turned(1, np.linspace(-0.1, 0.1, FOOTPRINTS)), "dip"),
        (turned(2, np.linspace(-0.2, 0.2, FOOTPRINTS)), "direction"),
        (turned(2, np.linspace(0.0, 2 * math.pi, FOOTPRINTS + 1)[:-1]), "direction"),
        (np.zeros((FOOTPRINTS, 3)), "strength"),
    ],
)
def test_what_strays_is_named(field: np.ndarray, why: str) -> None:
    told = judged(field)
    assert not told.steady
    assert why in told.why


def test_a_walk_in_the_earths_field_is_steady_on_any_course_and_one_past_a_magnet_is_not() -> None:
    for query in ("strides=12&noise=1", "path=eight&strides=16"):
        view = estimate(foot(query), KALMAN).compass
        assert view is not None
        assert view.steady, query
    beside = estimate(foot("strides=16&iron_gauss_m3=0.5&iron_along=0.8"), KALMAN).compass
    assert beside is not None
    assert "strength" in beside.why


def test_without_a_field_or_a_way_nothing_is_said() -> None:
    walked = foot("strides=12").matrix.copy()
    walked[:, Column.MX :] = np.nan
    blind = samples_of(walked[:, 0] * 1e-9, walked[:, 1:4], walked[:, 4:7])
    assert estimate(blind, KALMAN).compass is None
    few = foot("strides=4")
    assert estimate(Samples("foot", few.role, 0, few.matrix, few.saturation), KALMAN).compass is None
