"""The pendulum obeys its equation, loses the energy its damping takes, and its sensor reads the geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.simulate.pendulum import Pendulum, read, swing
from app.simulate.sensors import DIP_RAD

T = np.linspace(0.0, 10.0, 2001)


@pytest.mark.parametrize("pendulum", [
    Pendulum(), Pendulum(damping=5.95), Pendulum(length_m=0.4, start_deg=120.0, damping=0.0),
])  # fmt: skip
def test_rate_and_acceleration_are_derivatives_and_energy_only_goes_into_damping(pendulum: Pendulum) -> None:
    truth, h = swing(pendulum, 11.0), 1e-5
    now, before, after = truth(T[1:]), truth(T[1:] - h), truth(T[1:] + h)
    np.testing.assert_allclose((after.angle - before.angle) / (2 * h), now.rate, atol=1e-5)
    np.testing.assert_allclose((after.rate - before.rate) / (2 * h), now.acceleration, atol=1e-4)
    p, at = pendulum, truth(T)
    energy = 0.5 * p.mass_kg * (p.length_m * at.rate) ** 2
    energy = energy - p.mass_kg * p.gravity_mps2 * p.length_m * np.cos(at.angle)
    power = p.damping * p.length_m * at.rate**2
    lost = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(T))])
    np.testing.assert_allclose(energy + lost, energy[0], atol=2e-3)


def test_a_small_swing_is_the_linear_oscillator() -> None:
    p = Pendulum(start_deg=0.01)
    decay = p.damping / 2.0
    omega = math.sqrt(9.81 - decay**2)
    linear = np.exp(-decay * T) * (np.cos(omega * T) + decay / omega * np.sin(omega * T))
    np.testing.assert_allclose(np.degrees(swing(p, 10.0)(T).angle), 0.01 * linear, atol=1e-7)


def test_the_accelerometer_feels_the_second_derivative_of_its_place_less_gravity() -> None:
    p, h = Pendulum(start_deg=40.0), 1e-4
    truth = swing(p, 11.0)

    def place(t: np.ndarray) -> np.ndarray:
        angle = truth(t).angle
        return p.length_m * np.column_stack([np.sin(angle), 0.0 * angle, np.cos(angle)])

    t = T[1:]
    acceleration_n = (place(t + h) - 2 * place(t) + place(t - h)) / h**2
    turn = Rotation.from_rotvec(truth(t).angle[:, np.newaxis] * [0.0, 1.0, 0.0])
    force_b = turn.inv().apply(acceleration_n - [0.0, 0.0, p.gravity_mps2])
    np.testing.assert_allclose(read(p, truth, t)[:, 1:4], force_b, atol=1e-4)


def test_field_and_gravity_at_rest_are_those_of_the_pose() -> None:
    p = Pendulum(damping=50.0, start_deg=30.0)
    samples = read(p, swing(p, 1.0), np.zeros(1), motion=False)[0]
    turn = Rotation.from_euler("y", math.radians(30.0))
    np.testing.assert_allclose(turn.apply(samples[1:4]), [0.0, 0.0, -9.81], atol=1e-12)
    field = 48.6 * np.array([math.cos(DIP_RAD), 0.0, math.sin(DIP_RAD)])
    np.testing.assert_allclose(turn.apply(samples[7:10]), field, atol=1e-12)


def test_at_release_gravity_seems_to_lie_along_the_rod() -> None:
    p = Pendulum(damping=0.0, start_deg=25.0)
    samples = read(p, swing(p, 1.0), np.zeros(1))[0]
    assert samples[1] == pytest.approx(0.0, abs=1e-12)


def test_biases_are_added() -> None:
    p = Pendulum()
    truth = swing(p, 10.0)
    plain = read(p, truth, T)
    biased = read(p, truth, T, gyro_bias_radps=(1.0, 2.0, 3.0), force_bias_mps2=(4.0, 5.0, 6.0))
    expected = np.array([0, 4, 5, 6, 1, 2, 3, 0, 0, 0], dtype=float)
    np.testing.assert_allclose(biased - plain, np.tile(expected, (len(T), 1)), atol=1e-12)
