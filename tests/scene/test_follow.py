from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.scene.follow import JUMP_M, Glide, middle


def test_it_arrives() -> None:
    glide = Glide()
    for _ in range(1000):
        glide.towards((1.0, -2.0, 0.5), 1 / 60)
    assert glide.centre == pytest.approx((1.0, -2.0, 0.5), abs=1e-3)


def test_it_never_shoots_over() -> None:
    glide = Glide()
    path = [glide.towards((1.0, 0.0, 0.0), 1 / 60)[0] for _ in range(300)]
    assert all(a <= b for a, b in itertools.pairwise(path))
    assert max(path) <= 1.0


@given(st.floats(0.001, 0.5), st.integers(1, 20))
def test_many_small_steps_are_one_large_one(step_s: float, count: int) -> None:
    small, large = Glide(), Glide()
    for _ in range(count):
        small.towards((2.0, 1.0, -1.0), step_s)
    large.towards((2.0, 1.0, -1.0), count * step_s)
    assert small.centre == pytest.approx(large.centre, abs=1e-9)


def test_a_seek_goes_there_at_once() -> None:
    assert Glide().towards((JUMP_M + 1, 0.0, 0.0), 0.01) == (JUMP_M + 1, 0.0, 0.0)


def test_a_walker_stays_in_view() -> None:
    glide = Glide()
    lag = 0.0
    for i in range(3000):
        north = 1.3 * i / 60
        lag = max(lag, abs(north - glide.towards((north, 0.0, 0.0), 1 / 60)[0]))
    assert lag < 1.0


def test_middle() -> None:
    assert middle([]) == (0.0, 0.0, 0.0)
    assert middle([(0.0, 1.0, 2.0), (2.0, 3.0, 4.0)]) == (1.0, 2.0, 3.0)
    assert math.isfinite(sum(middle([(1e5, 1e5, 1e5)])))
