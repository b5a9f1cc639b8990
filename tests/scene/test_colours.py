from __future__ import annotations

import numpy as np

from app.motion.basics import Role
from app.scene import colours


def luminance(rgb: np.ndarray) -> np.ndarray:
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return linear @ np.array([0.2126, 0.7152, 0.0722])


def test_viridis_ends_where_it_is_published_to() -> None:
    assert colours.viridis(np.array([0.0, 1.0])).tolist() == [[68, 1, 84], [253, 231, 37]]


def test_viridis_grows_lighter_all_the_way() -> None:
    light = luminance(colours.viridis(np.linspace(0, 1, 200)) / 255.0)
    assert (np.diff(light) >= -1e-3).all()
    assert light[-1] > 0.7 > 0.05 > light[0]


def test_what_is_not_finite_is_grey() -> None:
    assert colours.viridis(np.array([np.nan, np.inf])).tolist() == [[128] * 3] * 2


def test_feet_differ_also_without_red_and_green() -> None:
    left, right = np.array(colours.FOOT[Role.LEFT]), np.array(colours.FOOT[Role.RIGHT])
    assert abs(left[2] - right[2]) > 100  # blue stays, whichever cone is missing
    assert abs(luminance(left / 255.0) - luminance(right / 255.0)) > 0.15


def test_shades() -> None:
    assert colours.shade((100, 50, 0), 0.5) == (50, 25, 0)
    assert colours.shade((100, 50, 0), 2.0) == (255, 255, 255)
    assert colours.blend((0, 0, 0), (10, 20, 30), 0.5) == (5, 10, 15)
    assert colours.css((1, 2, 3), 0.5) == "rgba(1,2,3,0.5)"
