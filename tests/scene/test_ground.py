from __future__ import annotations

import numpy as np

from app.rotation import rotate
from app.scene import ground
from app.scene.colours import theme
from app.scene.page import NED_WXYZ, in_view
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


def test_the_sky_goes_from_dark_to_the_horizon() -> None:
    for dark in (True, False):
        picture = ground.sky(theme(dark))
        assert tuple(picture[0, 0]) == theme(dark).sky
        assert tuple(picture[-1, 0]) == theme(dark).horizon
