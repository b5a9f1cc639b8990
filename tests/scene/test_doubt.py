from __future__ import annotations

import math

import numpy as np
import pytest

from app.motion.basics import Role
from app.motion.estimate import Trust
from app.scene import doubt
from app.scene.page import Scene


def test_the_outline_lies_on_the_ellipse() -> None:
    points = doubt.outline(2.0, 0.5, 0.7).reshape(-1, 3)
    c, s = math.cos(0.7), math.sin(0.7)
    along, across = c * points[:, 0] + s * points[:, 1], -s * points[:, 0] + c * points[:, 1]
    assert (along / 2.0) ** 2 + (across / 0.5) ** 2 == pytest.approx(np.ones(len(points)), abs=1e-6)
    assert not points[:, 2].any()


def test_a_change_nobody_sees_is_none() -> None:
    one = (1.0, 0.5, 0.1, "good")
    assert doubt.is_same(one, (1.01, 0.505, 0.1 + math.pi, "good"))
    assert not doubt.is_same(one, (1.2, 0.5, 0.1, "good"))
    assert not doubt.is_same(one, (1.0, 0.5, 0.4, "good"))
    assert not doubt.is_same(one, (1.0, 0.5, 0.1, "lost"))
    assert doubt.is_same((1.0, 0.99, 0.1, "good"), (1.0, 0.99, 1.4, "good"))  # a circle has no direction


def test_it_is_drawn_on_the_floor_where_something_is_known(scene: Scene) -> None:
    ring = doubt.Doubt(scene._server.scene, "/ned/doubt/t", Role.FOOT)
    ring.lie((1.0, 2.0, -0.3), 0.07, None)
    assert not ring._frame.visible
    ring.lie((1.0, 2.0, -0.3), 0.07, Trust(0.4, 0.2, 0.0, "good", ""))
    assert ring._frame.visible
    assert tuple(ring._frame.position) == pytest.approx((1.0, 2.0, 0.07 - doubt.ABOVE_FLOOR_M))
    assert ring._line is not None
    reach = np.abs(ring._line.points.reshape(-1, 3)).max(axis=0)
    assert reach == pytest.approx([0.4, 0.2, 0.0], abs=0.01)
    first = ring._line
    ring.lie((1.0, 2.0, -0.3), 0.07, Trust(0.8, 0.2, 0.0, "good", ""))
    assert ring._line is first
    assert np.abs(first.points).max() == pytest.approx(0.8, abs=0.01)
    ring.lie((1.0, 2.0, -0.3), 0.07, Trust(math.nan, 0.2, 0.0, "lost", ""))
    assert not ring._frame.visible
