from __future__ import annotations

import numpy as np
import pytest

from app.rotation import rotate
from app.scene import ground
from app.scene.colours import css, theme
from app.scene.follow import NED_WXYZ
from app.scene.page import Scene, in_view
from app.scene.shoe import SENSOR_HEIGHT_M


def test_north_is_ahead_east_to_the_right_down_below() -> None:
    for n, world in (((1, 0, 0), (0, 1, 0)), ((0, 1, 0), (1, 0, 0)), ((0, 0, 1), (0, 0, -1))):
        assert np.allclose(rotate(NED_WXYZ, n), world, atol=1e-12)


def test_the_view_is_centred_on_the_walker_with_the_floor_at_nought() -> None:
    centre = (12.0, -7.0, 0.4)
    moved = np.array(rotate(NED_WXYZ, centre)) + in_view(centre)
    assert np.allclose(moved, (0.0, 0.0, SENSOR_HEIGHT_M))


def test_everything_lies_just_above_the_floor() -> None:
    for segments in (ground.rose(), ground.north(), ground.ruler()):
        down = segments[..., 2]
        assert (down < SENSOR_HEIGHT_M).all()
        assert (down > SENSOR_HEIGHT_M - 0.01).all()


def test_letters_stand_where_they_point() -> None:
    middles = {letter: ground.strokes(letter, at, 0.1).mean(axis=(0, 1))[:2] for letter, at in
               {"N": (1.0, 0.0), "E": (0.0, 1.0), "S": (-1.0, 0.0), "W": (0.0, -1.0)}.items()}  # fmt: skip
    assert middles["N"][0] > 0.9
    assert middles["E"][1] > 0.9
    assert middles["S"][0] < -0.9
    assert middles["W"][1] < -0.9


def test_an_f_would_not_be_mirrored() -> None:
    """E opens to the right: its arms reach east of its spine."""
    points = ground.strokes("E", (0.0, 0.0), 1.0).reshape(-1, 3)
    spine = points[np.isclose(points[:, 1], points[:, 1].min())]
    assert np.ptp(spine[:, 0]) > 0.9


@pytest.mark.parametrize(("every_m", "reach_m"), [(1, ground.NEAR_M), (ground.BOLD_M, ground.REACH_M)])
def test_the_grid_is_on_whole_metres_and_fades_into_the_sky(every_m: int, reach_m: int) -> None:
    segments = ground.grid(every_m, reach_m)
    flat = segments[..., :2]
    whole = np.isclose(flat, np.rint(flat), atol=1e-5).all(axis=1)  # each line keeps one coordinate
    assert np.logical_or.reduce(whole, axis=1).all()
    ends = np.linalg.norm(flat, axis=-1)
    assert ends.max() <= reach_m + 1e-4
    colours = ground.fading(segments, (255, 255, 255), (0, 0, 0), reach_m)
    assert colours[ends > reach_m - 1e-3].max() == 0
    assert colours[ends < 0.05 * reach_m].min() > 0.8
    assert len(segments) < 200


def test_the_grid_comes_along_by_whole_squares(scene: Scene) -> None:
    node = scene._server.scene.get_handle_by_name("/ned/ground")
    assert node is not None
    for centre, at in (((2.4, -2.4, 1.0), (0, 0, 0)), ((203.0, -7.6, 0.3), (205, -10, 0))):
        scene._ground.reach(centre)
        assert tuple(node.position) == at


def test_the_sky_is_in_the_style(scene: Scene) -> None:
    for dark in (True, False):
        assert css(theme(dark).sky) in scene.head
        assert css(theme(dark).horizon) in scene.head
