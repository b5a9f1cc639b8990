"""What a recording tells of itself: its trails, and shoes that stand where the walk begins."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.motion.basics import Role
from app.motion.source import Outline
from app.scene.outline import setting_out_rad
from app.scene.page import Scene
from tests.scene import fakes


def way(heading_rad: float, start: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    along = np.linspace(0.0, 5.0, 21)
    points = np.zeros((21, 3), np.float32)
    points[:, 0] = start[0] + along * math.cos(heading_rad)
    points[:, 1] = start[1] + along * math.sin(heading_rad)
    return np.stack([points[:-1], points[1:]], axis=1)


@pytest.mark.parametrize("heading_rad", [0.0, 1.0, -2.5])
def test_a_walk_sets_out_the_way_it_goes(heading_rad: float) -> None:
    assert setting_out_rad(way(heading_rad, (3.0, -1.0))) == pytest.approx(heading_rad, abs=1e-5)


def test_who_never_left_has_a_direction_all_the_same() -> None:
    assert setting_out_rad(np.zeros((1, 2, 3), np.float32)) == 0.0


def test_shoes_stand_at_the_start_until_the_walk_is_there(scene: Scene) -> None:
    find = scene._server.scene.get_handle_by_name
    outline = Outline("walk.mcap", 3600.0, ((Role.LEFT, way(0.5)), (Role.RIGHT, way(0.5))))
    status = fakes.status()
    told = replace(status, source=replace(status.source, outline=outline))
    scene.draw(replace(fakes.snapshot(0.0), main=fakes.snapshot(0.0).main._replace(feet=())), told)
    left, right = find("/ned/outline/0"), find("/ned/outline/1")
    assert left is not None
    assert right is not None
    assert right.position[1] - left.position[1] == pytest.approx(0.2)
    shoe = find("/ned/outline/0/shoe")
    assert shoe is not None
    assert 2.0 * math.atan2(shoe.wxyz[3], shoe.wxyz[0]) == pytest.approx(0.5, abs=1e-5)
    scene._next_text = 0.0
    scene.draw(fakes.snapshot(0.1, two=True), status)
    assert find("/ned/left")
    assert not find("/ned/outline/0/shoe")
