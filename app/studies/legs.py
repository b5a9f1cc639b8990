"""Heart: walks made of legs with a pause before each: what Um's experiments were, simulated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from app.motion.basics import G_MPS2, Floats, Vector
from app.motion.samples import Samples
from app.simulate.foot import FootMotion, Motion, Swing, Timing, join_footprints
from app.simulate.gait import FLAT_SHARE, smooth_gait
from app.simulate.options import WalkOptions
from app.simulate.sensors import errors_of, ideal_readings, read


class Leg(NamedTuple):
    """Strides without a pause: each turns by so much, to the right, and climbs so much."""

    pause_s: float
    strides_m: tuple[float, ...]
    turns_rad: tuple[float, ...]
    climbs_m: tuple[float, ...]


def leg(pause_s: float, strides: int, stride_m: float, turn_rad: float = 0.0, climb_m: float = 0.0) -> Leg:
    """Equal strides; ``turn_rad`` and ``climb_m`` are of the whole leg, shared out equally."""
    return Leg(
        pause_s, (stride_m,) * strides, (turn_rad / strides,) * strides, (climb_m / strides,) * strides
    )


class Made(NamedTuple):
    """What the sensor read, and what was walked."""

    samples: Samples
    distance_m: float
    end_n: Vector
    turned_rad: float


class Sensor(NamedTuple):
    """The 3DM-GX1 in multiples of its table, and a gyro bias of its own, rad/s."""

    rate_hz: float = 50.0
    noise: float = 1.0
    bias: float = 0.1
    gyro_bias: Vector = (0.0, 0.0, 0.0)


def walk_legs(
    legs: Sequence[Leg], sensor: Sensor, seed: int, cycle_s: float = 1.1, lift_m: float = 0.1
) -> Made:
    """Walk the legs one after the other, from north; two seconds of standing end it."""
    pieces, place, heading = [], np.zeros(3), 0.0
    for part in [*legs, Leg(2.0, (), (), ())]:
        motion, place, heading = _piece(part, place, heading, sensor.rate_hz, cycle_s, lift_m)
        pieces.append(motion)
    whole = Motion(*(np.concatenate(columns) for columns in zip(*pieces, strict=True)))
    elapsed_ns = np.rint(np.arange(len(whole.q_nb)) * (1e9 / sensor.rate_hz))
    errors = errors_of(WalkOptions(noise=sensor.noise, bias=sensor.bias, gyro_bias_radps=sensor.gyro_bias))
    samples = read("foot", elapsed_ns, ideal_readings(whole, G_MPS2, None), errors, seed)
    distance = sum(sum(part.strides_m) for part in legs)
    return Made(samples, distance, (place[0].item(), place[1].item(), place[2].item()), heading)


def _piece(
    part: Leg, place: Floats, heading: float, rate_hz: float, cycle_s: float, lift_m: float
) -> tuple[Motion, Floats, float]:
    """A leg's motion, whole samples long, and where it ends."""
    strides = len(part.strides_m)
    headings = heading + np.concatenate([[0.0], np.cumsum(part.turns_rad)])
    along = headings[:-1] + 0.5 * np.diff(headings)  # a turning foot goes along the chord
    steps = np.column_stack([np.cos(along), np.sin(along), np.zeros(strides)]) * np.array(
        part.strides_m
    ).reshape(-1, 1)
    steps[:, 2] = -np.array(part.climbs_m)
    prints = np.vstack([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    lasts_s = part.pause_s + (strides + FLAT_SHARE) * cycle_s * bool(strides)
    t = np.arange(math.ceil(lasts_s * rate_hz)) / rate_hz
    if strides == 0:
        prints, headings = np.vstack([prints, prints]), np.repeat(headings, 2)
    timing = Timing(part.pause_s + FLAT_SHARE * cycle_s if strides else math.inf, cycle_s)
    foot: FootMotion = join_footprints(prints, headings, timing, Swing(smooth_gait, lift_m, 1.0))
    moved = foot.at(t) if strides else _standing(len(t), float(headings[0]))
    return moved._replace(position_n=moved.position_n + place), place + prints[-1], float(headings[-1])


def _standing(count: int, heading: float) -> Motion:
    zero = np.zeros((count, 3))
    q = np.tile([math.cos(0.5 * heading), 0.0, 0.0, math.sin(0.5 * heading)], (count, 1))
    return Motion(zero, zero, zero, q, zero)
