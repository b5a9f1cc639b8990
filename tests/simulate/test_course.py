"""Paths by arc length: the heading is the tangent, closed paths close, stairs climb."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.simulate.course import LANE_M, RISER_M, Course, Piece, course_of
from app.simulate.options import WalkOptions

PATHS = ["straight", "oval", "square", "eight", "stairs"]
CLOSED = ["oval", "square", "eight"]


def course(path: str) -> Course:
    return course_of(WalkOptions(path=path))


@pytest.mark.parametrize("path", PATHS)
def test_the_heading_is_the_tangent(path: str) -> None:
    s, h = np.random.default_rng(2).uniform(0.1, 900.0, 3000), 1e-4
    step = (course(path).places(s + h).position_n - course(path).places(s - h).position_n)[:, :2] / (2 * h)
    heading = course(path).places(s).heading_rad
    np.testing.assert_allclose(step, np.column_stack([np.cos(heading), np.sin(heading)]), atol=1e-3)


@pytest.mark.parametrize("path", PATHS)
def test_starts_at_the_origin_to_the_north(path: str) -> None:
    place = course(path).places(np.zeros(1))
    assert not place.position_n.any()
    assert place.heading_rad[0] == 0.0


@pytest.mark.parametrize("path", CLOSED)
def test_a_closed_path_comes_back_lap_after_lap(path: str) -> None:
    lap = course(path).length_m
    s = np.linspace(0.5, lap - 0.5, 50)
    first, third = course(path).places(s), course(path).places(s + 2 * lap)
    np.testing.assert_allclose(first.position_n, third.position_n, atol=1e-9)
    turns = (third.heading_rad - first.heading_rad) / (4 * math.pi)
    np.testing.assert_allclose(turns, {"oval": -1, "square": 1, "eight": 0}[path], atol=1e-9)


def test_the_lane_is_the_papers() -> None:
    assert course("oval").length_m == pytest.approx(LANE_M)
    east = course("oval").places(np.linspace(0, LANE_M, 2000)).position_n[:, 1]
    assert east.min() == pytest.approx(-2 * 42.77, abs=0.02)  # counter-clockwise: to the west of its start


@pytest.mark.parametrize(("path", "size_m", "length_m"), [
    ("oval", 100.0, 100.0),
    ("eight", 10.0, 2 * math.pi * 10.0),
    ("square", 20.0, 4 * 17.0 + 2 * math.pi * 1.5),
])  # fmt: skip
def test_size(path: str, size_m: float, length_m: float) -> None:
    assert course_of(WalkOptions(path=path, size_m=size_m)).length_m == pytest.approx(length_m)


def test_the_stairs_climb_twenty_risers_and_stay() -> None:
    stairs = course("stairs")
    down = stairs.places(np.array([0.0, stairs.length_m, stairs.length_m + 5.0])).position_n[:, 2]
    np.testing.assert_allclose(down, [0.0, -20 * RISER_M, -20 * RISER_M])


def test_an_arc_is_a_circle() -> None:
    quarter = Course((Piece(math.pi, 0.5 * math.pi),), closed=False).places(np.array([math.pi]))
    np.testing.assert_allclose(quarter.position_n, [[2.0, 2.0, 0.0]], atol=1e-12)
