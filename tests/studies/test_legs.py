"""Walks made of legs: the sensor's readings integrate to where the legs lead."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson
from scipy.spatial.transform import Rotation

from app.studies.legs import Leg, Sensor, leg, walk_legs

CLEAN = Sensor(rate_hz=400.0, noise=0.0, bias=0.0)
WALKS = {
    "straight": [leg(2.0, 4, 1.2)],
    "corner": [leg(2.0, 2, 1.0), leg(1.0, 2, 0.6, math.pi / 2), leg(0.0, 2, 1.0)],
    "stairs": [leg(2.0, 3, 0.5, climb_m=0.6), Leg(0.5, (0.5, 0.25), (0.0, 0.0), (0.4, 0.2))],
}


@pytest.mark.parametrize("name", WALKS)
def test_readings_integrate_to_the_end(name: str) -> None:
    made = walk_legs(WALKS[name], CLEAN, 0)
    t = made.samples.matrix[:, 0] * 1e-9
    pose, poses = Rotation.identity(), []
    rates = made.samples.matrix[:, 4:7]
    turns = Rotation.from_rotvec(0.5 * (rates[1:] + rates[:-1]) * np.diff(t)[:, None])
    for turn in [Rotation.identity(), *turns]:
        pose = pose * turn
        poses.append(pose)
    acceleration = Rotation.concatenate(poses).apply(made.samples.matrix[:, 1:4]) + [0.0, 0.0, 9.80665]
    velocity = cumulative_simpson(acceleration, x=t, axis=0, initial=0.0)
    position = cumulative_simpson(velocity, x=t, axis=0, initial=0.0)
    np.testing.assert_allclose(position[-1], made.end_n, atol=0.04)  # 10 s without a correction
    yaw, pitch, roll = poses[-1].as_euler("ZYX")
    assert math.remainder(yaw - made.turned_rad, math.tau) == pytest.approx(0.0, abs=1e-4)
    np.testing.assert_allclose([pitch, roll], 0.0, atol=1e-4)


def test_lengths_and_turns_add_up() -> None:
    made = walk_legs(WALKS["corner"], CLEAN, 0)
    assert made.distance_m == pytest.approx(5.2)
    assert made.turned_rad == pytest.approx(math.pi / 2)


def test_the_foot_stands_in_every_pause() -> None:
    made = walk_legs([leg(2.0, 2, 1.0), leg(3.0, 2, 1.0)], CLEAN, 0)
    rate = np.linalg.norm(made.samples.matrix[:, 4:7], axis=1)
    quiet = np.flatnonzero(np.diff(np.flatnonzero(rate > 1e-9)) > 2.9 * 400)
    assert len(quiet) == 1


def test_a_seed_is_a_walk() -> None:
    noisy = Sensor()
    a, b, c = (walk_legs(WALKS["straight"], noisy, seed).samples.matrix for seed in (1, 1, 2))
    np.testing.assert_array_equal(a, b)
    assert not np.array_equal(a, c)
