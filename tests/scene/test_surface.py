from __future__ import annotations

import io

import numpy as np
from PIL import Image

from app.motion.estimate import Sweep
from app.scene import surface
from tests.scene import fakes


def test_the_png_is_one() -> None:
    rgb = np.random.default_rng(1).integers(0, 256, (7, 11, 3), dtype=np.uint8)
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(surface.png(rgb)))), rgb)


def test_the_best_is_brightest_and_what_failed_is_unknown() -> None:
    closure = np.array([[3.0, 1.0], [2.0, np.nan]])
    bright = surface.brightness(closure)
    assert bright[0, 1] == 1.0
    assert bright[0, 0] < bright[1, 0]
    assert np.isnan(bright[1, 1])


def test_axes_units_and_the_minimum_are_told() -> None:
    text = surface.picture(fakes.sweep())
    for words in (
        "stance gain k_s, 1/s",
        "swing gain k_d, 1/s",
        "k_s 1.20 1/s",
        "k_d 0.15 1/s",
        "<circle",
        " m</text>",
    ):
        assert words in text


def test_k_s_grows_to_the_right_and_k_d_upward() -> None:
    sweep = Sweep(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0]), np.ones((3, 2)), (2.0, 1.0))
    left, below = (surface._place(axis, value, 100) for axis, value in
                   ((sweep.gains_stance, 2.0), (sweep.gains_swing, 1.0)))  # fmt: skip
    assert left > 80
    assert below > 70


def test_a_sweep_that_failed_everywhere_still_draws() -> None:
    text = surface.picture(Sweep(np.arange(3.0), np.arange(2.0), np.full((3, 2), np.nan), (0.0, 0.0)))
    assert "ending – m" in text
