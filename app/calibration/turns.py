"""Heart: scale and axes of a gyro from turns between poses, which gravity itself measures.

Equation (5) of the report believes that a turn was 90°. Here the calibrated accelerometer says how gravity
went from one pose to the next, and the rates in between must carry it there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from app.motion.basics import Floats


class Turn(NamedTuple):
    """From one still pose to the next."""

    before: Floats  # [3] true specific force in the first pose
    after: Floats  # [3]
    rates: Floats  # [n, 3] rad/s, as read
    steps_s: Floats  # [n − 1]


def fit(turns: list[Turn], null_radps: Floats) -> tuple[Floats, float]:
    """The scale [3, 3] that carries gravity through every turn, and the rms left over, rad.

    Nine numbers from two equations a turn: the skew is held near zero where they do not tell it.
    """
    means = [(t.rates[1:] + t.rates[:-1]) / 2.0 - null_radps for t in turns]
    units = [(t.before / np.linalg.norm(t.before), t.after / np.linalg.norm(t.after)) for t in turns]
    held = np.array([1e-3 if i in (0, 4, 8) else 0.2 for i in range(9)])

    def off(p: Floats) -> Floats:
        scale = p.reshape(3, 3)
        missed = [
            _carried(before, means[i] @ scale.T, turns[i].steps_s) - after
            for i, (before, after) in enumerate(units)
        ]
        return np.concatenate([*missed, held * (p - np.eye(3).ravel())])

    found = least_squares(off, np.eye(3).ravel())
    left = found.fun[: 3 * len(turns)]
    return found.x.reshape(3, 3), float(np.sqrt(np.sum(left**2) / len(turns)))


def _carried(down_b: Floats, rates: Floats, steps_s: Floats) -> Floats:
    """A vector that stands still in the room, seen from a body that turns by these rates."""
    return np.asarray(_product(-rates * steps_s[:, np.newaxis]) @ down_b)


def _product(turns: Floats) -> Floats:
    """Rotation vectors [n, 3], one after the other, as one matrix; multiplied in pairs of pairs."""
    angle = np.linalg.norm(turns, axis=1)[:, np.newaxis, np.newaxis]
    cross = np.zeros((len(turns), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -turns[:, 2], turns[:, 1], -turns[:, 0]
    cross -= cross.transpose(0, 2, 1).copy()
    sine, cosine = np.sinc(angle / np.pi), 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2
    matrices = np.eye(3) + sine * cross + cosine * (cross @ cross)
    while len(matrices) > 1:
        if len(matrices) % 2:
            matrices = np.concatenate([matrices, np.eye(3)[np.newaxis]])
        matrices = matrices[1::2] @ matrices[0::2]
    return np.asarray(matrices[0])
