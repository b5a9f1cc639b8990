"""Simulated readings: what an ideal sensor reads, and that every error is the one asked for."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.motion.basics import Floats
from app.motion.samples import Column, Samples
from app.simulate.foot import Motion
from app.simulate.options import WalkOptions
from app.simulate.sensors import FIELD_N_UT, Iron, field_of, ideal_readings, saturation_bits
from app.simulate.walk import simulate

FORCE, RATE, FIELD = slice(1, 4), slice(4, 7), slice(7, 10)
STANDING: dict[str, object] = {"still_s": 300.0, "strides": 1}


def samples(**options: object) -> Samples:
    return simulate(WalkOptions(**options)).recording.sensors[0]  # type: ignore[arg-type]


def errors(**options: object) -> Floats:
    """What the sensor reads more than the ideal one."""
    plain = {
        k: v for k, v in options.items() if k in ("still_s", "strides", "rate_hz", "model", "feet", "path")
    }
    return samples(**options).matrix - samples(**plain).matrix


@pytest.mark.parametrize(
    "options", [WalkOptions(model="papers"), WalkOptions(path="eight"), WalkOptions(path="stairs")]
)
def test_turned_into_n_and_gravity_added_a_reading_is_the_acceleration(options: WalkOptions) -> None:
    walk = simulate(options)
    matrix = walk.recording.sensors[0].matrix
    motion = walk.feet["foot"].at(matrix[:, 0] * 1e-9)
    turned = Rotation.from_quat(motion.q_nb[:, [1, 2, 3, 0]]).apply(matrix[:, FORCE])
    np.testing.assert_allclose(turned + [0.0, 0.0, options.gravity_mps2], motion.acceleration_n, atol=1e-11)


def test_at_rest_the_force_points_up() -> None:
    np.testing.assert_array_equal(samples().matrix[0, 1:7], [0.0, 0.0, -9.80665, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("pitch", [-0.75, 0.0, 0.65])
def test_the_field_is_eq_4_12(pitch: float) -> None:
    zero = np.zeros((1, 3))
    q = np.array([[math.cos(pitch / 2), 0.0, math.sin(pitch / 2), 0.0]])
    field = ideal_readings(Motion(zero, zero, zero, q, zero), 9.8, None)[0, 6:]
    dip = math.radians(60.483)
    np.testing.assert_allclose(
        field, [48.6 * math.cos(dip + pitch), 0.0, 48.6 * math.sin(dip + pitch)], atol=1e-12
    )


def test_noise_is_table_2() -> None:
    spread = errors(noise=1.0, **STANDING)[:, 1:].std(axis=0)
    np.testing.assert_allclose(spread, np.repeat([0.033, 0.0076, 0.082], 3), rtol=0.02)


def test_noise_scales_without_changing_its_shape() -> None:
    np.testing.assert_allclose(errors(noise=10.0)[:, 1:], 10.0 * errors(noise=1.0)[:, 1:], atol=1e-9)


def test_bias_is_table_2() -> None:
    constant = errors(bias=-2.0)[:, 1:]
    np.testing.assert_allclose(
        constant, np.tile(np.repeat([-0.1962, -1.45e-5, -0.48], 3), (len(constant), 1)), atol=1e-9
    )


def test_a_sensors_own_error_goes_before_table_2() -> None:
    own = errors(bias=1.0, noise=1.0, gyro_bias_radps=(0.1, 0.0, -0.2), gyro_noise_radps=0.0,
                 magnetometer_bias_gauss=(-0.0024,) * 3, magnetometer_noise_gauss=0.0)  # fmt: skip
    np.testing.assert_allclose(own[:, RATE], np.tile([0.1, 0.0, -0.2], (len(own), 1)), atol=1e-12)
    np.testing.assert_allclose(own[:, FIELD], -0.24, atol=1e-12)
    assert own[:, FORCE].mean() == pytest.approx(0.0981, abs=0.002)


def test_every_sensor_errs_in_its_own_way() -> None:
    walk = simulate(WalkOptions(noise=1.0, feet=2, strides=1, still_s=60.0))
    still = np.hstack([s.matrix[:5000, 1:] for s in walk.recording.sensors])
    assert np.abs(np.corrcoef(still.T) - np.eye(18)).max() < 0.1


def test_one_error_more_leaves_the_others_alone() -> None:
    np.testing.assert_array_equal(
        errors(noise=1.0)[:, FORCE], errors(noise=1.0, gyro_noise_radps=0.0)[:, FORCE]
    )


def test_past_its_range_a_channel_is_clipped_and_flagged() -> None:
    free, tight = (
        samples(model="papers"),
        samples(model="papers", accelerometer_range_g=5.0, gyro_range_dps=300.0),
    )
    most = np.repeat([5 * 9.80665, math.radians(300.0), math.inf], 3)
    np.testing.assert_array_equal(tight.matrix[:, 1:], np.clip(free.matrix[:, 1:], -most, most))
    flagged = (tight.saturation[:, np.newaxis] >> np.arange(9)) & 1
    np.testing.assert_array_equal(flagged, np.abs(free.matrix[:, 1:]) >= most)
    assert flagged[:, [0, 2, 4]].any(axis=0).all()
    assert not free.saturation.any()


def test_saturation_bits_count_from_the_force() -> None:
    raw = np.diag(np.arange(1.0, 10.0))
    assert saturation_bits(raw, np.arange(1.0, 10.0)).tolist() == [1 << i for i in range(9)]


def test_lost_samples_leave_gaps_and_nothing_else_changes() -> None:
    every, some = samples(noise=1.0, still_s=100.0), samples(noise=1.0, still_s=100.0, lost_fraction=0.2)
    kept = np.isin(every.matrix[:, 0], some.matrix[:, 0])
    np.testing.assert_array_equal(every.matrix[kept], some.matrix)
    assert kept[0]
    assert kept.mean() == pytest.approx(0.8, abs=0.02)
    assert set(np.diff(some.matrix[:, 0])) >= {10e6, 20e6, 30e6}


def test_the_first_sample_always_arrives() -> None:
    """Truth is asked by the seconds since the first sample."""
    starts = [samples(strides=1, lost_fraction=0.9, seed=seed).matrix[0, 0] for seed in range(20)]
    assert not any(starts)


def test_rounded_readings_lie_on_the_grid_and_near() -> None:
    fine, coarse = samples(noise=1.0), samples(noise=1.0, decimals=3)
    grid = np.array([1e-3] * 6 + [1e-1] * 3)  # 1 mG is 0.1 µT
    np.testing.assert_allclose(coarse.matrix[:, 1:] / grid, np.rint(coarse.matrix[:, 1:] / grid), atol=1e-6)
    assert np.abs((coarse.matrix - fine.matrix)[:, 1:] / grid).max() <= 0.5 + 1e-6


def test_the_same_seed_gives_the_same_bytes() -> None:
    once, again, other = (
        samples(noise=1.0, lost_fraction=0.1, seed=seed).matrix.tobytes() for seed in (5, 5, 6)
    )
    assert once == again
    assert once != other


def test_without_a_magnetometer_the_field_is_nan() -> None:
    off = samples(magnetometer=False, magnetometer_range_gauss=0.01)
    assert np.isnan(off.matrix[:, Column.MX :]).all()
    assert np.isfinite(off.matrix[:, : Column.MX]).all()
    assert not off.saturation.any()


def test_iron_is_a_dipole() -> None:
    """Its field is minus the gradient of k m·r / r³."""
    iron, h = Iron(np.array([1.0, 2.0, 0.5]), 7.0), 1e-5
    at = np.random.default_rng(7).uniform(-3, 3, (200, 3))

    def potential(position: Floats) -> Floats:
        away = position - iron.position_n
        return iron.strength * away[:, 1] / np.linalg.norm(away, axis=1) ** 3

    gradient = np.column_stack([(potential(at + h * e) - potential(at - h * e)) / (2 * h) for e in np.eye(3)])
    field = field_of(iron, at)
    assert np.abs(field + gradient).max() < 1e-5 * np.abs(field).max()


def test_iron_bends_the_field_only_near_it() -> None:
    bent = samples(iron_gauss_m3=0.1, iron_along=0.5, iron_beside_m=1.0)
    strange = np.linalg.norm(bent.matrix[:, FIELD] - samples().matrix[:, FIELD], axis=1)
    assert 9.0 < strange.max() < 21.0  # 0.1 gauss = 10 µT at 1 m, twice that at its poles
    assert 40.0 < bent.matrix[strange.argmax(), 0] * 1e-9 < 65.0  # half-way
    assert strange[0] < 0.001


def test_both_feet_pass_the_same_iron() -> None:
    """Beside it, on the axis of its poles, the field is 2 k / r³; one foot is 0.9 m away, the other 1.1 m."""
    bent, straight = (simulate(WalkOptions(feet=2, iron_gauss_m3=k)).recording.sensors for k in (0.1, 0.0))
    for foot, plain, away_m in zip(bent, straight, (1.1, 0.9), strict=True):
        strange = np.linalg.norm(foot.matrix[:, FIELD] - plain.matrix[:, FIELD], axis=1)
        assert strange.max() == pytest.approx(20.0 / away_m**3, rel=0.03)


def test_the_field_is_the_papers() -> None:
    assert np.linalg.norm(FIELD_N_UT) == pytest.approx(48.6)
