"""Attitude methods against SciPy: perfect readings give the pose, noisy ones what theory says."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.simulate.sensors import FIELD_N_UT
from app.studies.attitudes import criterion, fqa, full_step, gauss_newton, quest, triad
from app.studies.motions import MOTIONS, Sensor, perfect

METHODS = {
    "TRIAD": lambda samples, out: triad(samples, FIELD_N_UT, out),
    "QUEST": lambda samples, out: quest(samples, FIELD_N_UT, out),
    "FQA": lambda samples, out: fqa(samples, out),
}


def poses(count: int = 200) -> Rotation:
    return Rotation.random(count, rng=np.random.default_rng(7))


def readings(pose: Rotation, noise: float = 0.0) -> np.ndarray:
    samples = np.zeros((len(pose), 10))
    samples[:, 0] = np.arange(len(pose)) * 1e7
    samples[:, 1:4] = pose.inv().apply([0.0, 0.0, -9.81])
    samples[:, 7:10] = pose.inv().apply(FIELD_N_UT)
    spread = noise * np.repeat([9.81, 0.0, 55.0], 3)
    samples[:, 1:] += np.random.default_rng(8).normal(size=(len(pose), 9)) * spread
    return samples


def rotation(q_nb: np.ndarray) -> Rotation:
    return Rotation.from_quat(q_nb[:, [1, 2, 3, 0]])


def found(name: str, samples: np.ndarray) -> Rotation:
    out = np.empty((len(samples), 4))
    METHODS[name](samples, out)
    np.testing.assert_allclose(np.linalg.norm(out, axis=1), 1.0)
    return rotation(out)


@pytest.mark.parametrize("name", METHODS)
def test_perfect_readings_give_the_pose(name: str) -> None:
    error = (found(name, readings(poses())) * poses().inv()).magnitude()
    assert error.max() < 1e-7


def test_quest_is_scipys_wahba_solution() -> None:
    samples = readings(poses(), noise=0.05)
    ours = found("QUEST", samples)
    north = np.array(FIELD_N_UT) / np.linalg.norm(FIELD_N_UT)
    for i in range(0, 200, 20):
        seen = [samples[i, c : c + 3] / np.linalg.norm(samples[i, c : c + 3]) for c in (1, 7)]
        theirs, _ = Rotation.align_vectors([[0.0, 0.0, -1.0], north], seen)
        assert (ours[i] * theirs.inv()).magnitude() < 1e-7


def test_triad_and_fqa_are_one_method_and_keep_gravity_whole() -> None:
    samples = readings(poses(), noise=0.05)
    by_triad, by_fqa = found("TRIAD", samples), found("FQA", samples)
    assert (by_triad * by_fqa.inv()).magnitude().max() < 1e-7
    up = by_triad.apply(samples[:, 1:4])
    np.testing.assert_allclose(up[:, :2], 0.0, atol=1e-12)


def test_the_full_step_goes_all_the_way_for_a_small_error() -> None:
    for i, pose in enumerate(poses(20)):
        error = np.random.default_rng(i).normal(size=3) * 1e-4
        x, y, z, w = (pose * Rotation.from_rotvec(error)).as_quat()
        sample = readings(Rotation.concatenate([pose]))[0]
        force, field = tuple(sample[1:4].tolist()), tuple(sample[7:10].tolist())
        step = full_step((w, x, y, z), force, field, FIELD_N_UT, 0.5)
        np.testing.assert_allclose(step, -0.5 * error, atol=1e-7)


def test_the_criterion_is_zero_at_the_pose_only() -> None:
    sample = readings(Rotation.identity(1))[0]
    force, field = tuple(sample[1:4].tolist()), tuple(sample[7:10].tolist())
    assert criterion((1.0, 0.0, 0.0, 0.0), force, field, FIELD_N_UT) == pytest.approx(0.0, abs=1e-20)
    assert criterion((0.8, 0.0, 0.6, 0.0), force, field, FIELD_N_UT) > 0.1


@pytest.mark.parametrize("every", [1, 4])
def test_the_filter_settles_at_the_pose_whatever_its_correction_rate(every: int) -> None:
    samples = np.repeat(readings(Rotation.identity(1)), 1000, axis=0)
    samples[:, 0] = np.arange(1000) * 1e7
    out = np.empty((1000, 4))
    gauss_newton(samples, FIELD_N_UT, (0.98, 0.12, 0.16, 0.0), 2.0, 1.0, every, out)
    assert rotation(out)[-1].magnitude() < 1e-6
    halfway = rotation(out)[50].magnitude() / rotation(out)[0].magnitude()
    assert halfway == pytest.approx(np.exp(-1.0), rel=0.1)  # steps of 0.04 s at every 4th


@pytest.mark.parametrize("name", MOTIONS)
def test_motions_read_what_they_do(name: str) -> None:
    """The gyro integrates to the true pose; where nothing is bent the field is the Earth's."""
    motion = MOTIONS[name](perfect(Sensor(rate_hz=400.0)))
    true = rotation(motion.q_nb)
    dt = np.diff(motion.samples[:, 0]) * 1e-9
    mean = 0.5 * (motion.samples[1:, 4:7] + motion.samples[:-1, 4:7])
    turned = (true[:-1].inv() * true[1:]).as_rotvec()
    np.testing.assert_allclose(turned, mean * dt[:, None], atol=2e-3)
    rest = slice(0, motion.scored - 2)
    field = true[rest].apply(motion.samples[rest, 7:10])
    np.testing.assert_allclose(field, np.tile(FIELD_N_UT, (motion.scored - 2, 1)), atol=0.01)
    up = true[rest].apply(motion.samples[rest, 1:4])
    np.testing.assert_allclose(up, np.tile([0.0, 0.0, -9.80665], (motion.scored - 2, 1)), atol=1e-6)
