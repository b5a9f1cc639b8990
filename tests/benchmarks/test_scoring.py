"""What the scores do not see, and what they do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.scoring import mirrored, path_m, pyshoe_m, rmse_m, up

PATH = np.cumsum(np.random.default_rng(0).normal(size=(200, 3)), axis=0)


def turned(points: np.ndarray, yaw: float) -> np.ndarray:
    c, s = np.cos(yaw), np.sin(yaw)
    return points @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


@given(st.floats(-10, 10), st.tuples(*3 * [st.floats(-100, 100)]))
def test_yaw_and_translation_are_not_errors(yaw, shift):
    assert rmse_m(turned(PATH, yaw) + shift, PATH) == pytest.approx(0.0, abs=1e-9)


@given(st.floats(-10, 10))
def test_a_left_handed_truth_scores_zero_once_mirrored(yaw):
    left_handed = PATH * [1.0, -1.0, 1.0]
    assert rmse_m(turned(PATH, yaw), mirrored(left_handed)) == pytest.approx(0.0, abs=1e-9)
    assert rmse_m(turned(PATH, yaw), left_handed) > 1.0


def test_north_east_down_becomes_right_handed_with_z_up():
    axes = up(np.eye(3))
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[2, 2] == -1.0


@pytest.mark.parametrize("scale", [0.9, 1.1])
def test_a_wrong_length_is_an_error(scale):
    spread_m = np.sqrt(np.mean(np.sum((PATH - PATH.mean(axis=0)) ** 2, axis=1)))
    assert rmse_m(scale * PATH, PATH) == pytest.approx(0.1 * spread_m)


def test_tilt_is_an_error():
    assert rmse_m(PATH[:, [0, 2, 1]], PATH) > 1.0


@given(st.floats(0.01, 1.0))
def test_no_other_yaw_scores_better(angle):
    estimate = turned(PATH, 1.0) + np.random.default_rng(1).normal(size=PATH.shape)
    best = rmse_m(estimate, PATH)
    centred, truth = estimate - estimate.mean(axis=0), PATH - PATH.mean(axis=0)
    for yaw in (-1.0 + angle, -1.0 - angle):
        other = turned(centred, yaw) - truth
        assert best <= np.sqrt(np.mean(np.sum(other**2, axis=1))) + 1e-9


def test_two_dimensions_do_as_well():
    assert rmse_m(turned(PATH, 0.3)[:, :2], PATH[:, :2]) == pytest.approx(0.0, abs=1e-9)


def test_the_path_is_horizontal():
    square = np.array([[0, 0, 0], [3, 0, 9], [3, 4, -9], [0, 4, 0], [0, 0, 0]], float)
    assert path_m(square) == 14.0
    assert path_m(square, 2) == 10.0


def test_pyshoes_metric_forgives_yaw_and_start_and_divides_by_the_root_of_two() -> None:
    t = np.linspace(0.0, 4.0, 200)
    truth = np.column_stack([t, 0.1 * t * t, 0 * t])
    c, s = np.cos(0.7), np.sin(0.7)
    turned = truth @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + [3.0, 1.0, 5.0]
    assert pyshoe_m(turned, truth) < 1e-12
    longer = truth * 1.1
    assert abs(pyshoe_m(longer, truth) - 0.1 * np.mean(np.linalg.norm(truth, axis=1)) / np.sqrt(2)) < 1e-9
