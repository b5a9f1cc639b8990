"""The gait profiles against their own derivatives, the papers' Table I and printed numbers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, quad
from scipy.special import erf

from app.motion.basics import Floats
from app.simulate.gait import (
    ROUNDING,
    Gait,
    Profile,
    minimum_jerk,
    papers_gait,
    papers_reach,
    rounded_ramp,
    smooth_gait,
)

JUMPS_S = np.array([0.0, 0.1, 0.5, 0.6])


def at(gait: Gait, *t_s: float) -> Profile:
    return gait(np.array(t_s), 1.0, 0.25)


def test_table_1_in_the_middle_of_each_phase() -> None:
    assert at(papers_gait, -0.2, 0.05, 0.2, 0.4, 0.55, 0.7).pitch_radps.tolist() == [
        0,
        -7.5,
        3.5,
        3.5,
        -6.5,
        0,
    ]


def test_the_foot_tips_43_degrees_down_37_up_and_comes_back() -> None:
    pitch = at(papers_gait, 0.0, 0.1, 0.5, 0.6).pitch_rad
    np.testing.assert_allclose(pitch, [0.0, -0.75, 0.65, 0.0], atol=1e-15)


def test_a_jump_reads_the_middle_of_its_sides() -> None:
    profile = at(papers_gait, *JUMPS_S)
    np.testing.assert_allclose(profile.pitch_radps, [-3.75, -2.0, -1.5, -3.25])
    inside = at(papers_gait, 0.1 + 2e-9, 0.5 - 2e-9).advance_acceleration
    np.testing.assert_allclose(profile.advance_acceleration[1:3], 0.5 * inside, rtol=1e-6)


def test_forward_velocity_is_eq_14_less_its_value_at_the_edge() -> None:
    t = np.linspace(0.1, 0.5, 101)
    eq_14 = np.exp(-((t - 0.3) ** 2) / (2 * 0.05**2)) / (0.05 * np.sqrt(2 * np.pi))
    np.testing.assert_allclose(papers_gait(t, 1.0, 0.25).advance_rate, eq_14 - eq_14[0], atol=1e-12)


def test_the_gaussians_jump_costs_a_ninth_of_a_percent() -> None:
    reach, _ = quad(lambda t: papers_gait(np.array([t]), 1.0, 0.25).advance_rate[0], 0.1, 0.5)
    assert papers_reach() == pytest.approx(reach, rel=1e-9)
    assert at(papers_gait, 0.5).advance[0] == pytest.approx(papers_reach(), rel=1e-12)
    eq_14_alone = erf(0.2 / 0.05 / np.sqrt(2))
    assert 100 * (1 - eq_14_alone) == pytest.approx(0.0063, abs=1e-4)
    assert 100 * (1 - papers_reach() / eq_14_alone) == pytest.approx(0.107, abs=1e-3)


def test_the_lift_is_eq_15_level_with_the_floor() -> None:
    t = np.linspace(0.1, 0.5, 101)
    eq_15 = 0.25 * np.exp(-((t - 0.3) ** 2) / (2 * 0.05**2))
    lift = papers_gait(t, 1.0, 0.25).lift_m
    np.testing.assert_allclose(lift, eq_15 - eq_15[0], atol=1e-15)
    assert eq_15[0] == pytest.approx(84e-6, rel=0.01)


def test_the_vertical_acceleration_leaves_13_mm_per_s_which_the_ground_takes() -> None:
    kept, _ = quad(lambda t: papers_gait(np.array([t]), 1.0, 0.25).lift_mps2[0], 0.1, 0.5)
    just_inside = at(papers_gait, 0.1 + 2e-9, 0.5 - 2e-9).lift_mps
    assert kept == pytest.approx(-0.013418, abs=1e-6)
    np.testing.assert_allclose(just_inside, [-0.5 * kept, 0.5 * kept], rtol=1e-6)


def test_fig_76_on_the_grid_of_table_6() -> None:
    """L = 1.8 m, lift 0.25 m, 50 Hz: the trapezoid rule twice gives the printed 179.91 and 0.176 cm."""
    swing = np.linspace(0.5, 0.9, 20)
    t = np.concatenate([np.arange(0, 25) / 50, swing, np.arange(46, 51) / 50])
    inside = papers_gait(
        np.clip(swing - 0.4, 0.1 + 2e-9, 0.5 - 2e-9), 1.0, 0.25
    )  # the full value at its edges
    end_m = {
        name: cumulative_trapezoid(
            cumulative_trapezoid(np.concatenate([np.zeros(25), a, np.zeros(5)]), t, initial=0), t, initial=0
        )[-1]
        for name, a in {"x": 1.8 * inside.advance_acceleration, "z": inside.lift_mps2}.items()
    }
    assert 100 * end_m["x"] == pytest.approx(179.910, abs=0.001)
    assert 100 * end_m["z"] == pytest.approx(-0.176, abs=0.001)


@pytest.mark.parametrize("gait", [papers_gait, smooth_gait])
@pytest.mark.parametrize("cycle_s", [0.8, 1.0, 1.7])
def test_rates_are_derivatives(gait: Gait, cycle_s: float) -> None:
    t, h = np.random.default_rng(1).uniform(-0.2, 0.8, 2000) * cycle_s, 1e-5
    t = t[np.abs(t[:, np.newaxis] / cycle_s - JUMPS_S).min(axis=1) > 1e-3]
    before, now, after = (gait(t + d, cycle_s, 0.2) for d in (-h, 0.0, h))
    pairs = [
        ("pitch_rad", "pitch_radps"),
        ("advance", "advance_rate"),
        ("advance_rate", "advance_acceleration"),
        ("lift_m", "lift_mps"),
        ("lift_mps", "lift_mps2"),
        ("turn", "turn_rate"),
    ]
    for value, rate in pairs:
        slope = (getattr(after, value) - getattr(before, value)) / (2 * h)
        np.testing.assert_allclose(slope, getattr(now, rate), atol=1e-4, err_msg=value)


def largest_step(gait: Gait, rate_hz: float) -> dict[str, float]:
    profile = gait(np.arange(-0.2, 0.8, 1 / rate_hz), 1.0, 0.1)
    return {name: np.abs(np.diff(getattr(profile, name))).max() for name in
            ("pitch_radps", "advance_acceleration", "lift_mps2")}  # fmt: skip


def test_smooth_is_twice_differentiable_and_the_papers_is_not() -> None:
    """A continuous quantity sampled ten times finer moves ten times less; a jump stays."""
    for name, coarse in largest_step(smooth_gait, 1e4).items():
        assert largest_step(smooth_gait, 1e5)[name] < 0.11 * coarse, name
    for name, coarse in largest_step(papers_gait, 1e4).items():
        assert largest_step(papers_gait, 1e5)[name] > 0.11 * coarse, name


def test_smooth_keeps_the_papers_pitch_between_the_rounded_corners() -> None:
    t = np.linspace(-0.2, 0.8, 1001)
    far = np.abs(t[:, np.newaxis] - JUMPS_S).min(axis=1) >= ROUNDING
    np.testing.assert_allclose(
        smooth_gait(t, 1.0, 0.1).pitch_rad[far], papers_gait(t, 1.0, 0.1).pitch_rad[far], atol=1e-14
    )


def test_smooth_is_exactly_still_while_flat() -> None:
    t = np.concatenate([np.linspace(-0.4 + 0.04, -0.04, 50), np.linspace(0.64, 0.96, 50)])
    profile = smooth_gait(t, 1.0, 0.1)
    moving = [value for name, value in profile._asdict().items() if name not in ("advance", "turn")]
    assert not np.any(moving)
    assert set(profile.advance) == {0.0, 1.0}


@pytest.mark.parametrize("x", [-2.0, -1.0, -0.7, -0.1, 0.0, 0.4, 0.99, 1.0, 3.0])
def test_a_rounded_ramp_is_the_average_of_a_ramp(x: float) -> None:
    average, _ = quad(
        lambda y: max(0.0, x - y) * 15 / 16 * (1 - y * y) ** 2, -1, 1, points=[min(1, max(-1, x))]
    )
    assert rounded_ramp(np.array([x]))[0][0] == pytest.approx(average, abs=1e-9)


def test_minimum_jerk_rests_at_both_ends() -> None:
    x: Floats = np.array([-1.0, 0.0, 0.5, 1.0, 2.0])
    value, rate, acceleration = minimum_jerk(x)
    assert value.tolist() == [0, 0, 0.5, 1, 1]
    assert rate.tolist() == [0, 0, 1.875, 0, 0]
    assert acceleration.tolist() == [0, 0, 0, 0, 0]
