from __future__ import annotations

import math

import numpy as np
import pytest

from app.scene import guard
from tests.scene import fakes


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e9])
def test_a_place_that_is_none(bad: float) -> None:
    foot = fakes.foot(3.0)
    assert guard.drawable(foot)
    assert not guard.drawable(foot._replace(position_n=(0.0, bad, 0.0)))


@pytest.mark.parametrize("bad", [(0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 1.0)])
def test_a_turn_that_is_none(bad: tuple[float, float, float, float]) -> None:
    assert not guard.drawable(fakes.foot(3.0)._replace(q_nb=bad))


def test_unit() -> None:
    assert np.linalg.norm(guard.unit((1.0, 2.0, -3.0, 0.5))) == pytest.approx(1.0, abs=1e-15)


def test_segments_and_rows() -> None:
    segments = np.zeros((4, 2, 3), np.float32)
    assert guard.finite_segments(segments) is segments
    segments[1, 0, 2], segments[2, 1, 0] = np.nan, np.inf
    assert len(guard.finite_segments(segments)) == 2
    a, b = guard.finite_rows((np.array([0.0, 1.0, np.nan]), np.array([np.inf, 2.0, 3.0])))
    assert (a.tolist(), b.tolist()) == ([1.0], [2.0])
