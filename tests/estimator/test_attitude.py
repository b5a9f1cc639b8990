"""Orientation: the FQA against SciPy, the complementary filter against its closed forms."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.estimator.attitude import (
    complementary,
    fqa_tilt,
    fqa_yaw,
    half_angle,
    own_yaw,
    share_of,
    static_quaternion,
    turn_between,
)
from app.motion.basics import Quaternion, Vector
from app.rotation import exponential, from_yaw_pitch_roll, multiply, rotate, yaw_of

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)
NO_YAW: Quaternion = (0.0, 0.0, 0.0, 0.0)
NO_FIELD = (math.nan, math.nan, math.nan)
G = 9.80665
PI = math.pi
# The FQA takes half angles from cosines, which near 1 know an angle to √ε only.
ROUNDING = 1e-7

angles = st.floats(-PI, PI)
pitches = st.floats(-PI / 2, PI / 2)


def apart(p: Quaternion, q: Quaternion) -> float:
    """The angle between two orientations, rad; ±q are the same."""
    a, b = Rotation.from_quat(np.roll(p, -1)), Rotation.from_quat(np.roll(q, -1))
    return float((a.inv() * b).magnitude())


def seen_from(q_nb: Rotation, vector_n: Vector) -> Vector:
    x, y, z = q_nb.inv().apply(vector_n).tolist()
    return x, y, z


def fqa(
    force_b: Vector, field_b: Vector, estimate: Quaternion = IDENTITY, north_rad: float = 0.0
) -> Quaternion:
    tilt = fqa_tilt(force_b)
    return static_quaternion(tilt, fqa_yaw(tilt, field_b, north_rad), estimate)


def tilted(angle_rad: float) -> Quaternion:
    return fqa_tilt((G * math.sin(angle_rad), 0.0, -G * math.cos(angle_rad)))


@given(angles, pitches, angles, st.floats(-1.4, 1.4), st.floats(-PI, PI))
@example(0.5, 0.1, PI, 1.0, 0.0)
@example(0.5, 0.1, -PI, 1.0, 0.0)
@example(PI, 0.0, PI, 1.0, 0.0)
@example(-PI, 0.3, 0.0, -1.0, 2.0)
@example(1.0, PI / 2, 0.7, 1.0, 0.0)
@example(1.0, -PI / 2, -2.0, 1.0, 0.0)
@example(0.0, 0.0, 0.0, 0.0, 0.0)
def test_fqa_finds_any_orientation(yaw: float, pitch: float, roll: float, dip: float, north: float) -> None:
    truth = Rotation.from_euler("ZYX", [yaw, pitch, roll])
    field_n = (50 * math.cos(dip) * math.cos(north), 50 * math.cos(dip) * math.sin(north), 50 * math.sin(dip))
    found = fqa(seen_from(truth, (0.0, 0.0, -G)), seen_from(truth, field_n), north_rad=north)
    w_last = truth.as_quat()
    # Where cos(pitch) is tiny, roll is a quotient of tiny numbers.
    slack = ROUNDING + 1e-15 / max(1e-9, abs(math.cos(pitch))) if abs(math.cos(pitch)) > 1e-9 else 1e-6
    assert apart(found, tuple(np.roll(w_last, 1).tolist())) < slack


def test_a_foot_upside_down_keeps_its_roll() -> None:
    """sgn(0) is +1: with 0 the roll quaternion would vanish at 180°."""
    q = fqa_tilt((0.0, 0.0, G))
    assert math.hypot(*q) == pytest.approx(1.0)
    assert rotate(q, (0.0, 0.0, G)) == pytest.approx((0.0, 0.0, -G))
    assert half_angle(0.0, -1.0) == (0.0, 1.0)
    assert half_angle(-0.0, -1.0) == (0.0, 1.0)


@given(st.floats(-1e-9, 1e-9), st.sampled_from([1.0, -1.0]), st.sampled_from([1.0, -1.0, 0.0]))
def test_a_cosine_past_one_is_clamped(past: float, cosine: float, sine: float) -> None:
    c, s = half_angle(sine, cosine + past)
    assert c * c + s * s == pytest.approx(1.0)


@given(st.tuples(*[st.floats(-1e6, 1e6)] * 3), st.tuples(*[st.floats(-1e6, 1e6)] * 3))
@example((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
@example((5e-324, 0.0, 0.0), (0.0, 5e-324, 0.0))
@example((1e-160, 1e-160, -1e-160), (1.0, 0.0, 0.0))
def test_fqa_is_always_a_unit_quaternion(force_b: Vector, field_b: Vector) -> None:
    q = fqa(force_b, field_b)
    assert math.hypot(*q) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("field_b", [NO_FIELD, (0.0, 0.0, 0.0), (0.0, 0.0, 40.0), (math.nan, 1.0, 1.0)])
def test_without_a_usable_field_the_yaw_is_the_estimates_own(field_b: Vector) -> None:
    estimate = from_yaw_pitch_roll(0.7, 0.0, 0.0)
    level = (0.0, 0.0, -G)
    assert fqa_yaw(fqa_tilt(level), field_b, 0.0) == NO_YAW
    assert fqa(level, field_b, estimate) == pytest.approx(estimate)


@given(angles, pitches, angles, angles, pitches, angles)
def test_the_sign_is_the_one_nearer_the_estimate(
    a: float, b: float, c: float, d: float, e: float, f: float
) -> None:
    estimate = from_yaw_pitch_roll(a, b, c)
    truth = Rotation.from_euler("ZYX", [d, e, f])
    q = fqa(seen_from(truth, (0.0, 0.0, -G)), seen_from(truth, (20.0, 0.0, 40.0)), estimate)
    assert np.dot(q, estimate) >= 0.0


@given(angles, st.floats(-1.4, 1.4), st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(-1.0, 1.0))
def test_its_own_yaw_turns_nothing_about_down(
    yaw: float, pitch: float, roll: float, pitch_error: float, roll_error: float
) -> None:
    """The correction from estimate to static quaternion has no part about the vertical."""
    truth = Rotation.from_euler("ZYX", [yaw, pitch, roll])
    tilt = fqa_tilt(seen_from(truth, (0.0, 0.0, -G)))
    wrong = tuple(
        np.roll((truth * Rotation.from_euler("YX", [pitch_error, roll_error])).as_quat(), 1).tolist()
    )
    static = static_quaternion(tilt, NO_YAW, wrong)
    correction = multiply(static, (wrong[0], -wrong[1], -wrong[2], -wrong[3]))
    assert abs(correction[3]) < ROUNDING
    assert rotate(static, seen_from(truth, (0.0, 0.0, -G))) == pytest.approx((0.0, 0.0, -G), abs=1e-5)


def test_own_yaw_of_an_opposite_tilt_is_defined() -> None:
    assert own_yaw(IDENTITY, (0.0, 1.0, 0.0, 0.0)) == IDENTITY


# --- the complementary filter -----------------------------------------------------------------------


def filtered(
    q: Quaternion, rate_b: Vector, tilt: Quaternion, gain: float, dt_s: float, steps: int
) -> Quaternion:
    turn = turn_between(rate_b, rate_b, dt_s)
    for _ in range(steps):
        q = complementary(q, turn, tilt, NO_YAW, share_of(gain, dt_s))
    return q


@pytest.mark.parametrize("gain", [0.1, 1.05, 10.0])
@pytest.mark.parametrize("rate_hz", [25, 400])
def test_a_step_decays_as_e_to_the_minus_kt(gain: float, rate_hz: int) -> None:
    """(3.33): time constant 1/k, whatever the sample rate."""
    start = 1e-3
    for constants in (1, 3):
        steps = round(constants / gain * rate_hz)
        q = filtered(tilted(start), (0.0, 0.0, 0.0), tilted(0.0), gain, 1.0 / rate_hz, steps)
        assert apart(q, tilted(0.0)) == pytest.approx(start * math.exp(-gain * steps / rate_hz), rel=1e-4)


@pytest.mark.parametrize("gain", [0.5, 1.05, 5.0])
def test_a_constant_rate_error_leaves_an_angle_of_bias_over_gain(gain: float) -> None:
    """(3.45), (3.47): δ/k."""
    bias, dt_s = 1e-3, 1e-3
    q = filtered(IDENTITY, (0.0, bias, 0.0), IDENTITY, gain, dt_s, round(12 / gain / dt_s))
    assert apart(q, IDENTITY) == pytest.approx(bias / gain, rel=0.6 * gain * dt_s + 1e-4)


def test_gain_0_drifts_as_bias_times_time() -> None:
    q = filtered(IDENTITY, (0.0, 1e-3, 0.0), IDENTITY, 0.0, 0.01, 10_000)
    assert apart(q, IDENTITY) == pytest.approx(1e-3 * 100.0, rel=1e-9)


@given(st.floats(0.0, 1e6), st.floats(1e-4, 0.25))
def test_no_gain_is_unstable(gain: float, dt_s: float) -> None:
    """A step never overshoots, however large k·dt."""
    error = [
        apart(filtered(tilted(0.5), (0.0, 0.0, 0.0), IDENTITY, gain, dt_s, n), IDENTITY) for n in range(4)
    ]
    assert all(later <= earlier + ROUNDING for earlier, later in pairwise(error))


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_full_turn_comes_back_to_plus_or_minus_itself(axis: int) -> None:
    rate: Vector = (2 * PI * (axis == 0), 2 * PI * (axis == 1), 2 * PI * (axis == 2))
    start = from_yaw_pitch_roll(0.3, -0.2, 0.1)
    q = filtered(start, rate, IDENTITY, 0.0, 0.01, 100)
    assert apart(q, start) < 1e-7
    assert q == pytest.approx([-x for x in start])


@given(st.tuples(*[st.floats(-30, 30)] * 3), st.tuples(*[st.floats(-30, 30)] * 3), st.floats(1e-4, 0.02))
def test_the_turn_between_two_samples_is_that_of_their_mean_rate(a: Vector, b: Vector, dt_s: float) -> None:
    mean = tuple(0.5 * (x + y) * dt_s for x, y in zip(a, b, strict=True))
    expected = np.roll(Rotation.from_rotvec(mean).as_quat(), 1)
    assert abs(np.dot(turn_between(a, b, dt_s), expected)) == pytest.approx(1.0, abs=1e-12)


def test_gravity_holds_no_heading_and_the_compass_does() -> None:
    """Without a field a wrong yaw stays; with one it decays as a tilt does."""
    wrong, tilt = from_yaw_pitch_roll(0.2, 0.0, 0.0), fqa_tilt((0.0, 0.0, -G))
    share = share_of(2.0, 0.01)
    free, held = wrong, wrong
    for _ in range(300):
        free = complementary(free, IDENTITY, tilt, NO_YAW, share)
        held = complementary(held, IDENTITY, tilt, fqa_yaw(tilt, (20.0, 0.0, 40.0), 0.0), share)
    assert yaw_of(free) == pytest.approx(0.2, abs=1e-9)
    assert yaw_of(held) == pytest.approx(0.2 * math.exp(-6.0), rel=0.02)


def test_the_exponential_is_what_the_filter_turns_by() -> None:
    assert complementary(IDENTITY, exponential((0.1, 0.2, 0.3)), IDENTITY, NO_YAW, 0.0) == pytest.approx(
        exponential((0.1, 0.2, 0.3))
    )
