"""The still start: level, gravity, gyro bias and heading, from the mean of a window."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.motion.basics import Floats
from app.motion.samples import Samples
from app.rotation import from_yaw, from_yaw_pitch_roll, multiply, pitch_of, roll_of, rotate, yaw_of
from tests.estimator.walks import G, estimate, foot, rows_of, samples_of, still, without

RNG = np.random.default_rng(5)


def tilted(
    seconds: float, yaw: float, pitch: float, roll: float, noise: float = 0.0, gravity: float = G
) -> Samples:
    """At rest in some attitude, a magnetometer in a field to the north that dips 60°."""
    n = round(seconds * 100)
    to_body = Rotation.from_euler("ZYX", [yaw, pitch, roll]).inv()
    force = to_body.apply([0.0, 0.0, -gravity]) + noise * RNG.standard_normal((n, 3))
    field = to_body.apply([25.0, 0.0, 43.0])
    return samples_of(np.arange(n) / 100.0, force, np.zeros(3), field)


def test_level_is_the_mean_of_the_window_not_one_sample() -> None:
    noise = 0.3
    tracker = estimate(tilted(2.0, 0.0, 0.2, -0.4, noise), still_window_s=1.0, gain_stance=0.0)
    q = tuple(rows_of(tracker)[-1, 6:10].tolist())
    tolerance = 4.0 * noise / G / math.sqrt(100)
    assert pitch_of(q) == pytest.approx(0.2, abs=tolerance)
    assert roll_of(q) == pytest.approx(-0.4, abs=tolerance)
    assert yaw_of(q) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("gravity", [9.55, 9.81])
def test_gravity_is_as_read_at_rest_or_as_set(gravity: float) -> None:
    samples = still(2.0, gravity=gravity)
    assert estimate(samples).state["gravity"][0] == pytest.approx(gravity)
    assert estimate(samples, gravity_from_rest=False, gravity_mps2=9.7).state["gravity"][0] == 9.7


def with_rate(samples: Samples, rate: Floats) -> Samples:
    matrix = samples.matrix.copy()
    matrix[:, 4:7] = rate
    return Samples("foot", samples.role, 0, matrix, samples.saturation)


def bias_of(samples: Samples, bias_from_rest: bool = True) -> list[float]:
    state = estimate(samples, bias_from_rest=bias_from_rest).state
    return [float(state[f"bias_{axis}"][0]) for axis in "xyz"]


def test_gyro_bias_is_taken_from_a_truly_still_start_only() -> None:
    bias = np.array([0.01, -0.005, 0.002])
    noisy = bias + 0.002 * RNG.standard_normal((200, 3))
    assert bias_of(with_rate(still(2.0), noisy)) == pytest.approx(noisy[:51].mean(axis=0), abs=3e-4)
    assert bias_of(with_rate(still(2.0), noisy), bias_from_rest=False) == [0.0, 0.0, 0.0]
    swaying = bias + 0.05 * np.sin(np.arange(200) / 5.0)[:, None]
    assert bias_of(with_rate(still(2.0), swaying)) == [0.0, 0.0, 0.0]
    turning = np.array([0.0, 0.0, 0.03])  # constant, but no sensor's bias
    assert bias_of(with_rate(still(2.0), turning)) == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("window_s", [0.1, 0.5, 3.0])
def test_level_is_found_when_the_window_is_full(window_s: float) -> None:
    for seconds, found in ((window_s, False), (window_s + 0.02, True)):
        tracker = estimate(still(seconds), still_window_s=window_s)
        assert tracker.levelled is found


def start_at(samples: Samples, begin_s: float) -> Samples:
    kept = without(samples, -1.0, begin_s)
    matrix = kept.matrix.copy()
    matrix[:, 0] -= matrix[0, 0]
    return Samples("foot", kept.role, 0, matrix, kept.saturation)


def test_a_walk_that_begins_in_mid_swing_finds_level_at_the_first_stance() -> None:
    samples = start_at(foot("strides=20&gyro_bias_radps=0.004,0.004,0.004"), 3.55)
    rates = np.linalg.norm(samples.matrix[:, 4:7], axis=1)
    assert rates[0] > 1.0
    tracker = estimate(samples)
    rows = rows_of(tracker)
    first_quiet = int(np.argmax(rates < 1.0))
    assert not rows[:first_quiet, :6].any()
    assert tracker.levelled
    assert 17 <= tracker.stride_count <= 19
    assert bias_of(samples) == [0.0, 0.0, 0.0]  # a stance is too short to tell a bias
    for stride in tracker.strides[1:]:
        assert stride.length_m == pytest.approx(1.2, abs=0.03)


def test_a_pause_shorter_than_a_tenth_of_a_second_does_not_level() -> None:
    rate = np.zeros((100, 3))
    rate[:, 1] = np.where(np.arange(100) % 12 < 9, 0.0, 5.0)  # quiet for 0.08 s at a time
    assert not estimate(with_rate(still(1.0), rate)).levelled


def test_the_compass_gives_the_start_heading() -> None:
    tracker = estimate(tilted(2.0, 1.1, 0.1, 0.2), magnetometer=True)
    assert yaw_of(tuple(rows_of(tracker)[-1, 6:10].tolist())) == pytest.approx(1.1, abs=1e-6)
    off = estimate(tilted(2.0, 1.1, 0.1, 0.2))
    assert yaw_of(tuple(rows_of(off)[-1, 6:10].tolist())) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("magnetometer", [True, False])
@pytest.mark.parametrize("turn", [0.7, -2.5])
def test_the_start_heading_turns_the_whole_walk_rigidly(magnetometer: bool, turn: float) -> None:
    samples = foot("path=square&laps=1&noise=1")
    plain = rows_of(estimate(samples, magnetometer=magnetometer))
    turned = rows_of(estimate(samples, magnetometer=magnetometer, start_heading_rad=turn))
    q = from_yaw(turn)
    for a, b in zip(plain[::50], turned[::50], strict=True):
        assert rotate(q, tuple(a[:3])) == pytest.approx(tuple(b[:3]), abs=1e-6)
        assert rotate(q, tuple(a[3:6])) == pytest.approx(tuple(b[3:6]), abs=1e-6)
        assert abs(np.dot(multiply(q, tuple(a[6:10])), b[6:10])) == pytest.approx(1.0, abs=1e-9)
    assert (plain[:, 10:] == turned[:, 10:]).all()


def test_an_upright_or_upside_down_sensor_levels() -> None:
    for attitude in ((0.0, math.pi / 2, 0.0), (0.0, -math.pi / 2, 0.0), (0.0, 0.0, math.pi)):
        q = tuple(rows_of(estimate(tilted(2.0, *attitude)))[-1, 6:10].tolist())
        expected = from_yaw_pitch_roll(*attitude)
        assert rotate(q, (1.0, 0.0, 0.0))[2] == pytest.approx(rotate(expected, (1.0, 0.0, 0.0))[2], abs=1e-6)
        assert rotate(q, (0.0, 0.0, 1.0))[2] == pytest.approx(rotate(expected, (0.0, 0.0, 1.0))[2], abs=1e-6)
