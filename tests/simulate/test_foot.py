"""One foot's motion: every quantity is the derivative of the one before, SciPy agreeing on rotations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.simulate.foot import FootMotion, rotate_to_body
from app.simulate.options import WalkOptions
from app.simulate.walk import simulate

WALKS = [
    WalkOptions(model="papers", strides=5, heading_deg=50.0),
    WalkOptions(path="eight", laps=1, feet=2),
    WalkOptions(path="square", laps=1, cadence_spm=90.0),
    WalkOptions(path="stairs", feet=2),
]
FEET = [
    (options, sensor)
    for options in WALKS
    for sensor in (("foot",) if options.feet == 1 else ("left", "right"))
]


def foot(options: WalkOptions, sensor: str) -> FootMotion:
    return simulate(options).feet[sensor]


def instants(options: WalkOptions, moving: FootMotion) -> np.ndarray:
    """Random instants, for the papers' model away from its jumps."""
    t = np.random.default_rng(3).uniform(0.0, simulate(options).recording.duration_s, 3000)
    if options.model == "smooth":
        return t
    phase = np.mod(t - moving.timing.heel_off_s, 1.0)
    return t[np.abs(phase[:, np.newaxis] - [0.0, 0.1, 0.5, 0.6, 1.0]).min(axis=1) > 1e-3]


def scipy_rotation(q_nb: np.ndarray) -> Rotation:
    return Rotation.from_quat(q_nb[:, [1, 2, 3, 0]])


@pytest.mark.parametrize(("options", "sensor"), FEET)
def test_velocity_and_acceleration_are_derivatives(options: WalkOptions, sensor: str) -> None:
    moving, h = foot(options, sensor), 1e-5
    t = instants(options, moving)
    before, now, after = (moving.at(t + d) for d in (-h, 0.0, h))
    np.testing.assert_allclose((after.position_n - before.position_n) / (2 * h), now.velocity_n, atol=1e-4)
    np.testing.assert_allclose(
        (after.velocity_n - before.velocity_n) / (2 * h), now.acceleration_n, atol=0.02
    )


@pytest.mark.parametrize(("options", "sensor"), FEET)
def test_the_gyro_reads_the_derivative_of_the_orientation(options: WalkOptions, sensor: str) -> None:
    moving, h = foot(options, sensor), 1e-5
    t = instants(options, moving)
    turned = scipy_rotation(moving.at(t - h).q_nb).inv() * scipy_rotation(moving.at(t + h).q_nb)
    np.testing.assert_allclose(turned.as_rotvec() / (2 * h), moving.at(t).angular_rate_b, atol=1e-4)


@pytest.mark.parametrize(("options", "sensor"), FEET)
def test_the_flat_foot_is_exactly_still_on_its_footprint(options: WalkOptions, sensor: str) -> None:
    moving = foot(options, sensor)
    for k in range(moving.strides + 1):
        flat = moving.timing.heel_off_s + (k + np.linspace(-0.35, -0.05, 20)) * moving.timing.cycle_s
        still = moving.at(flat)
        assert not still.velocity_n.any()
        assert not still.acceleration_n.any()
        assert not still.angular_rate_b.any()
        np.testing.assert_allclose(still.position_n, np.tile(moving.position_n[k], (20, 1)), atol=1e-9)
        yaw, pitch, roll = scipy_rotation(still.q_nb).as_euler("ZYX").T
        np.testing.assert_allclose(np.exp(1j * yaw), np.exp(1j * moving.heading_rad[k]), atol=1e-9)
        np.testing.assert_allclose([pitch, roll], 0.0, atol=1e-15)


def largest_jumps(rate_hz: float) -> list[float]:
    now = foot(WALKS[2], "foot").at(np.arange(1.0, 5.0, 1 / rate_hz))
    return [np.abs(np.diff(x, axis=0)).max() for x in (now.acceleration_n, now.angular_rate_b, now.q_nb)]


def test_stride_follows_stride_without_a_jump() -> None:
    """What is continuous moves ten times less between samples that lie ten times closer."""
    for coarse, fine in zip(largest_jumps(1e3), largest_jumps(1e4), strict=True):
        assert fine < 0.11 * coarse


def test_before_the_first_stride_and_after_the_last_nothing_moves() -> None:
    moving = foot(WALKS[1], "left")
    around = moving.at(np.array([-100.0, 0.0, 1e3, 1e6]))
    assert not around.velocity_n.any()
    np.testing.assert_array_equal(around.position_n[:2], 0.0)
    np.testing.assert_allclose(around.position_n[2:], np.tile(moving.position_n[-1], (2, 1)))


@pytest.mark.parametrize(("options", "sensor"), FEET)
def test_quaternions_are_unit(options: WalkOptions, sensor: str) -> None:
    moving = foot(options, sensor)
    np.testing.assert_allclose(
        np.linalg.norm(moving.at(instants(options, moving)).q_nb, axis=1), 1.0, rtol=1e-14
    )


def test_rotating_to_the_body_is_scipys_inverse() -> None:
    generator = np.random.default_rng(4)
    q, v = generator.normal(size=(100, 4)), generator.normal(size=(100, 3))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    np.testing.assert_allclose(rotate_to_body(q, v), scipy_rotation(q).inv().apply(v), atol=1e-14)


def test_the_sole_stays_above_the_floor_but_for_a_brief_dip() -> None:
    """The shoe tips about its toe: without the early lift its toe would dig 12 cm into the floor."""
    moving = foot(WalkOptions(strides=2), "foot")
    now = moving.at(np.linspace(2.0, 5.0, 3001))
    for point_b in ([0.18, 0.0, 0.06], [-0.1, 0.0, 0.06]):  # tip of the sole and heel, from the sensor
        down = now.position_n[:, 2] + scipy_rotation(now.q_nb).apply(np.array(point_b))[:, 2] - 0.06
        assert 0.0 <= down.max() < 0.06
