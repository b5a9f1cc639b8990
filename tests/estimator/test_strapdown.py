"""Strapdown and the zero-velocity update against their closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import scipy.integrate
from hypothesis import given
from hypothesis import strategies as st

from app.estimator.strapdown import bias_of_swing, motion_acceleration, trapezoid, without_bias
from app.estimator.tracker import Tracker, track
from app.motion.basics import Floats, Role, Vector
from app.motion.samples import SAMPLE_WIDTH, Samples
from app.rotation import from_yaw_pitch_roll, rotate
from app.settings import Settings
from tests.estimator.walks import G, estimate, foot, rows_of, samples_of, still, walk

ZERO: Vector = (0.0, 0.0, 0.0)


def integral_of(values: Floats, t_s: Floats) -> Floats:
    """SciPy's trapezoids, as a second opinion."""
    total: Any = scipy.integrate.cumulative_trapezoid
    integral: Floats = total(values, t_s, axis=0, initial=0)
    return integral


def integrated(acceleration: Floats, dt_s: float) -> tuple[Vector, Vector]:
    """Velocity and position after accelerations [n, 3], by the step's own trapezoids."""
    velocity = position = ZERO
    for before, now in zip(acceleration.tolist(), acceleration[1:].tolist(), strict=False):
        was = velocity
        velocity = trapezoid(velocity, tuple(before), tuple(now), dt_s)
        position = trapezoid(position, was, velocity, dt_s)
    return velocity, position


@given(st.floats(-3, 3), st.floats(-1.5, 1.5), st.floats(-3, 3), st.tuples(*[st.floats(-50, 50)] * 3))
def test_motion_acceleration_undoes_what_a_sensor_reads(a: float, b: float, c: float, moved: Vector) -> None:
    """f = Rᵀ(a − g): at rest it reads (0, 0, −g)."""
    q = from_yaw_pitch_roll(a, b, c)
    force = rotate((q[0], -q[1], -q[2], -q[3]), (moved[0], moved[1], moved[2] - G))
    assert motion_acceleration(q, force, G) == pytest.approx(moved, abs=1e-12)


def test_constant_acceleration_is_exact() -> None:
    velocity, position = integrated(np.tile([0.3, -0.2, 0.1], (101, 1)), 0.01)
    assert velocity == pytest.approx((0.3, -0.2, 0.1))
    assert position == pytest.approx((0.15, -0.1, 0.05))


def test_the_velocity_of_a_linear_acceleration_is_exact() -> None:
    t_s = np.arange(101) * 0.01
    velocity, _ = integrated(np.outer(t_s, [2.0, 0.0, -1.0]), 0.01)
    assert velocity == pytest.approx((1.0, 0.0, -0.5))


@pytest.mark.parametrize("steps", [50, 100, 200])
def test_a_sinusoid_errs_with_the_square_of_the_step(steps: int) -> None:
    """One period of a·sin: velocity back at 0, position a·T²/2π."""
    t = np.linspace(0.0, 1.0, steps + 1)
    velocity, position = integrated(np.outer(np.sin(2 * math.pi * t), [3.0, 0.0, 0.0]), 1.0 / steps)
    assert velocity == pytest.approx(ZERO, abs=1e-12)
    error = abs(position[0] - 3.0 / (2 * math.pi))
    assert error == pytest.approx(3.0 / (2 * math.pi) * (math.pi**2 / 3) / steps**2, rel=0.02)


@given(st.tuples(*[st.floats(-2, 2)] * 3), st.integers(2, 100))
def test_the_update_removes_a_constant_bias_exactly(bias: Vector, steps: int) -> None:
    """(8)–(10): a foot that stood still and read a bias has gone nowhere."""
    dt_s = 0.01
    velocity, position = integrated(np.tile(bias, (steps + 1, 1)), dt_s)
    found = bias_of_swing(velocity, steps * dt_s)
    assert found == pytest.approx(bias, abs=1e-12)
    assert without_bias(position, found, steps * dt_s) == pytest.approx(ZERO, abs=1e-12)


# --- through the whole step -------------------------------------------------------------------------


def swing(bias_n: Vector, rate_hz: float = 200.0, moved_m: float = 1.2) -> Samples:
    """A flat foot that slides ``moved_m`` north in 0.6 s, told as moving by spinning and turning back."""
    t_s = np.arange(round(3 * rate_hz)) / rate_hz
    s = np.clip((t_s - 1.5) / 0.6, 0.0, 1.0)
    force = np.zeros((len(t_s), 3))
    force[:, 0] = moved_m * 2 * math.pi / 0.6**2 * np.sin(2 * math.pi * s) * ((s > 0) & (s < 1))
    force[:, 2] = -G
    moving = (t_s >= 1.5) & (t_s <= 2.1 + 1e-9)
    force += np.where(moving[:, None], bias_n, 0.0)
    # about x and back: a force along x is not turned, and gravity is put where the turn has it
    rate = np.zeros_like(force)
    rate[moving, 2] = 4.0 * np.where(np.arange(moving.sum()) % 2, 1.0, -1.0)
    return samples_of(t_s, force, rate)


def end_of(tracker: Tracker) -> Floats:
    end: Floats = rows_of(tracker)[-1, :3]
    return end


def test_a_swing_of_known_length_is_found() -> None:
    tracker = estimate(swing((0.0, 0.0, 0.0)), gain_stance=0.0)
    assert tracker.stride_count == 1
    assert end_of(tracker) == pytest.approx([1.2, 0.0, 0.0], abs=0.02)


@given(st.tuples(*[st.floats(-2, 2)] * 3))
def test_a_constant_acceleration_bias_changes_no_stride(bias: Vector) -> None:
    """Constant from the lift to the contact, its edges included: ε takes out all of it."""
    plain, biased = (estimate(swing(b), gain_stance=0.0) for b in ((0.0, 0.0, 0.0), bias))
    assert biased.strides[0].length_m == pytest.approx(plain.strides[0].length_m, abs=0.02)
    # what is left is the half sample before the lift, where the bias begins
    uncorrected = 0.5 * abs(bias[0]) * 0.6**2
    assert abs(end_of(biased)[0] - end_of(plain)[0]) <= 0.05 * uncorrected + 1e-9


def test_without_the_update_gain_0_drifts_as_half_b_t_squared() -> None:
    """A swing that never ends: nothing corrects it."""
    t_s = np.arange(1100) / 100.0
    force = np.tile([0.0, 0.0, -G], (1100, 1))
    force[100:, 1] = 0.05
    rate = np.zeros((1100, 3))
    rate[100:, 1] = np.where(np.arange(1000) % 2, 20.0, -20.0)
    tracker = estimate(samples_of(t_s, force, rate), gain_stance=0.0)
    assert tracker.stride_count == 0
    assert end_of(tracker)[1] == pytest.approx(0.5 * 0.05 * 10.0**2, rel=0.01)


def test_at_rest_nothing_moves() -> None:
    tracker = estimate(still(60.0))
    assert not rows_of(tracker)[:, :6].any()
    assert (rows_of(tracker)[:, 6:10] == [1.0, 0.0, 0.0, 0.0]).all()
    assert tracker.strides == []


@pytest.mark.parametrize("query", ["model=papers&rate_hz=50", "rate_hz=400", "rate_hz=100&noise=1"])
def test_corrected_rows_are_an_integral_of_one_another(query: str) -> None:
    """Position is continuous, its derivative is the velocity, and a foot that stands has none."""
    samples = foot(query)
    rows = rows_of(estimate(samples))
    position = integral_of(rows[:, 3:6], samples.matrix[:, 0] * 1e-9)
    assert np.abs(position - rows[:, :3]).max() < 1e-9
    assert not rows[rows[:, 10] == 0.0, 3:6].any()
    assert np.abs(rows[np.flatnonzero(np.diff(rows[:, 10]) < 0), 3:6]).max() < 1e-12


@pytest.mark.parametrize("rate_hz", [50, 100, 400])
def test_without_back_dated_edges_the_walk_falls_short_by_metres(rate_hz: int) -> None:
    """Back-dating: velocity counted only between the machine's late edges, and corrected there."""
    query = f"model=papers&rate_hz={rate_hz}"
    samples = foot(query)
    tracker = estimate(samples, min_duration_s=0.18, gain_stance=0.0)
    truth, _ = walk(query).truth("foot", samples.matrix[-1:, 0] * 1e-9)
    assert abs(end_of(tracker)[0] - truth[0, 0]) < 0.10

    rates = np.linalg.norm(samples.matrix[:, 4:7], axis=1)
    late = round(0.18 * rate_hz)
    moving = np.convolve(rates >= 1.0, np.ones(late), "full")[: len(rates)] >= late  # began Γ late
    ended = np.convolve(rates < 1.0, np.ones(late), "full")[: len(rates)] >= late
    phase, swings = 0, []
    for i in range(len(rates)):
        if not phase and moving[i]:
            phase, begin = 1, i
        elif phase and ended[i]:
            phase = 0
            swings.append((begin, i))
    rows, t_s = rows_of(tracker), samples.matrix[:, 0] * 1e-9
    force_n = np.array(
        [rotate(tuple(r[6:10]), tuple(f)) for r, f in zip(rows, samples.matrix[:, 1:4], strict=True)]
    )
    total = 0.0
    for a, b in swings:
        velocity = integral_of(force_n[a : b + 1, 0], t_s[a : b + 1])
        velocity -= velocity[-1] * (t_s[a : b + 1] - t_s[a]) / (t_s[b] - t_s[a])
        total += integral_of(velocity, t_s[a : b + 1])[-1]
    assert truth[0, 0] - total > 1.0


def test_without_zero_velocity_updates_a_force_bias_grows_as_half_b_t_squared() -> None:
    """A foot at rest whose accelerometer slips by b after level was found: the position is ½·b·t²."""
    bias_mps2, rate_hz, seconds = 0.02, 100, 20
    count = seconds * rate_hz
    matrix = np.zeros((count, SAMPLE_WIDTH))
    matrix[:, 0] = np.arange(count) * 1e9 / rate_hz
    matrix[:, 3] = -9.80665
    slipped = matrix[:, 0] > 1e9
    matrix[slipped, 1] = bias_mps2
    samples = Samples("foot", Role.FOOT, 0, matrix, np.zeros(count, np.uint16))
    free = track(samples, Settings(gain_stance=0.0, gain_swing=0.0, zero_velocity=False))
    held = track(samples, Settings(gain_stance=0.0, gain_swing=0.0))
    north_m = rows_of(free)[:, 0]
    since_s = np.maximum(0.0, matrix[:, 0] * 1e-9 - 1.005)  # the bias is there from half a step earlier on
    assert north_m == pytest.approx(0.5 * bias_mps2 * since_s**2, abs=2e-4)
    assert np.abs(rows_of(held)[:, :3]).max() == 0.0
