"""Heart: motions whose orientation is known, for every attitude method alike, with one sensor's errors."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from app.motion.basics import G_MPS2, Floats
from app.motion.samples import SAMPLE_WIDTH
from app.simulate.foot import rotate_to_body
from app.simulate.options import WalkOptions
from app.simulate.pendulum import Pendulum, read, swing
from app.simulate.sensors import FIELD_N_UT
from app.simulate.walk import simulate

#: Every motion begins with a rest; what a filter does in it is not scored.
STILL_S = 5.0


class Motion(NamedTuple):
    """Samples [n, 10], true orientation q_nb [n, 4], and from which sample on it counts."""

    samples: Floats
    q_nb: Floats
    scored: int


@dataclass(frozen=True)
class Sensor:
    """σ and biases, m/s², rad/s, µT; the same for each axis but for a sign that alternates."""

    rate_hz: float = 100.0
    force_noise: float = 0.033
    rate_noise: float = 0.0076
    field_noise: float = 0.082
    gyro_bias: float = math.radians(0.099)
    seed: int = 2001


def tilt_table(sensor: Sensor) -> Motion:
    """Fig. 8 of the 2001 report: roll between 0 and 45° at 10 °/s, 15 s of rest after each."""
    t = np.arange(round(60.0 * sensor.rate_hz) + 1) / sensor.rate_hz
    corners = np.array([0.0, STILL_S, STILL_S + 4.5, STILL_S + 19.5, STILL_S + 24.0, 60.0])
    roll = np.radians(np.interp(t, corners, [0.0, 0.0, 45.0, 45.0, 0.0, 0.0]))
    q = np.column_stack([np.cos(0.5 * roll), np.sin(0.5 * roll), 0.0 * roll, 0.0 * roll])
    rate = np.zeros((len(t), 3))
    rate[:, 0] = np.gradient(roll, t)
    return _with_errors(sensor, _turning(t, q, rate), q)


def disturbed_table(sensor: Sensor) -> Motion:
    """The same by iron: for half the time the field is turned 20° about the vertical and dips 10° more."""
    motion = tilt_table(perfect(sensor))
    t = motion.samples[:, 0] * 1e-9
    dip = math.atan2(FIELD_N_UT[2], FIELD_N_UT[0]) + math.radians(10.0)
    strength, turn = math.hypot(FIELD_N_UT[0], FIELD_N_UT[2]), math.radians(20.0)
    bent = strength * np.array(
        [math.cos(dip) * math.cos(turn), math.cos(dip) * math.sin(turn), math.sin(dip)]
    )
    near = (t > 10.0) & (t < 40.0)
    samples = motion.samples.copy()
    samples[near, 7:10] = rotate_to_body(motion.q_nb[near], bent)
    return _with_errors(sensor, samples, motion.q_nb)


def perfect(sensor: Sensor) -> Sensor:
    """The same sensor without errors."""
    return Sensor(sensor.rate_hz, 0.0, 0.0, 0.0, 0.0, sensor.seed)


def pendulum(sensor: Sensor) -> Motion:
    """The dissertation's pendulum, held at 10° and let go after 5 s."""
    t = np.arange(round(25.0 * sensor.rate_hz) + 1) / sensor.rate_hz
    body = Pendulum(gravity_mps2=G_MPS2)
    truth = swing(body, 25.0)
    since = np.maximum(t - STILL_S, 0.0)
    samples = read(body, truth, since)
    held = t < STILL_S
    angle = truth(since).angle
    samples[held] = 0.0
    q = np.column_stack([np.cos(0.5 * angle), 0.0 * angle, np.sin(0.5 * angle), 0.0 * angle])
    samples[held] = _turning(t[held], q[held], np.zeros((int(held.sum()), 3)))
    samples[:, 0] = np.rint(t * 1e9)
    return _with_errors(sensor, samples, q)


def walk(sensor: Sensor) -> Motion:
    """A foot around a square of 12 m, smooth model."""
    made = simulate(WalkOptions(path="square", laps=1, still_s=STILL_S, rate_hz=sensor.rate_hz))
    samples = made.recording.sensors[0].matrix
    _, q = made.truth("foot", samples[:, 0] * 1e-9)
    return _with_errors(sensor, samples, q)


MOTIONS = {
    "tilt table": tilt_table,
    "tilt table by iron": disturbed_table,
    "pendulum": pendulum,
    "foot": walk,
}


def _turning(t: Floats, q_nb: Floats, rate_b: Floats) -> Floats:
    """What a sensor reads that turns without going anywhere."""
    samples = np.zeros((len(t), SAMPLE_WIDTH))
    samples[:, 0] = np.rint(t * 1e9)
    samples[:, 1:4] = rotate_to_body(q_nb, np.array([0.0, 0.0, -G_MPS2]))
    samples[:, 4:7] = rate_b
    samples[:, 7:10] = rotate_to_body(q_nb, np.array(FIELD_N_UT))
    return samples


def _with_errors(sensor: Sensor, samples: Floats, q_nb: Floats) -> Motion:
    noise = np.random.default_rng(sensor.seed).standard_normal((len(samples), 9))
    noise *= np.repeat([sensor.force_noise, sensor.rate_noise, sensor.field_noise], 3)
    noisy = samples.copy()
    noisy[:, 1:] += noise
    noisy[:, 4:7] += sensor.gyro_bias * np.array([1.0, -1.0, 1.0])
    return Motion(noisy, q_nb, round(STILL_S * sensor.rate_hz))
