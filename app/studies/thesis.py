"""Heart: the methods of Um's thesis (2007): distance by swing windows, heading by four phases.

He saw each swing five samples late and shifted its window back by five; these windows are not late.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats, Ints
from app.motion.samples import Column
from app.simulate.foot import rotate_to_body

#: Swings closer together than this are one: his figures show no flicker within a swing.
SHORTEST_S = 0.12
#: "Initial": at rest for 0.5 s or longer. A swing that turns by this much is a turning swing.
INITIAL_S, TURNING_RAD = 0.5, math.radians(8.0)


class Phase(IntEnum):
    """The four phases of the thesis."""

    INITIAL = 0
    STANCE = 1
    SWING = 2
    TURNING_SWING = 3


class Walked(NamedTuple):
    """What the thesis' method makes of a walk."""

    distance_m: float  # sum of horizontal strides
    end_n: Floats  # [3] m
    steps: int
    turned_rad: float  # to the right
    phase: Ints  # [n]


def to_navigation(q_nb: Floats, vector_b: Floats) -> Floats:
    """Body vectors [n, 3] in n, Eq. (3.6)."""
    conjugate = q_nb * np.array([1.0, -1.0, -1.0, -1.0])
    return rotate_to_body(conjugate, vector_b)


def walk(samples: Floats, q_nb: Floats, threshold_radps: float, *, compensate: bool = True) -> Walked:
    """Samples [n, 10] with the sensor's own orientation [n, 4] into a walk.

    ``compensate`` off leaves out the zero-velocity compensation (4.8): Table 2.
    """
    t = samples[:, Column.ELAPSED_NS] * 1e-9
    rate_n = to_navigation(q_nb, samples[:, Column.WX : Column.WZ + 1])
    force_n = to_navigation(q_nb, samples[:, Column.FX : Column.FZ + 1])
    gravity = np.mean(force_n[t < t[0] + INITIAL_S], axis=0)
    windows = swing_windows(t, np.hypot(rate_n[:, 0], rate_n[:, 1]), threshold_radps)
    lengths, end = [], np.zeros(3)
    for first, last in windows:
        begin = max(0, first - 1)
        stride = travelled(t[begin : last + 1], (force_n - gravity)[begin : last + 1], compensate=compensate)
        lengths.append(float(np.hypot(stride[0], stride[1])))
        end = end + stride
    turned, phase = heading(t, rate_n[:, 2], windows)
    return Walked(sum(lengths), end, len(windows), turned, phase)


def swing_windows(t: Floats, rate: Floats, threshold_radps: float) -> list[tuple[int, int]]:
    """First and last + 1 of each swing: where |ω_xy| is above the threshold, short gaps and blips aside."""
    edges = np.flatnonzero(np.diff((rate > threshold_radps).astype(np.int8), prepend=0, append=0))
    windows: list[tuple[int, int]] = []
    for first, last in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if windows and t[first] - t[windows[-1][1] - 1] < SHORTEST_S:
            windows[-1] = (windows[-1][0], last)
        else:
            windows.append((first, last))
    return [(first, last) for first, last in windows if t[last - 1] - t[first] > SHORTEST_S]


def travelled(t: Floats, acceleration_n: Floats, *, compensate: bool) -> Floats:
    """The way [3] of one swing by (4.1), (4.2) and, unless left out, (4.8)."""
    half = 0.5 * np.diff(t)[:, np.newaxis]
    velocity = np.vstack([np.zeros(3), np.cumsum(half * (acceleration_n[1:] + acceleration_n[:-1]), axis=0)])
    if compensate:
        velocity = velocity - np.outer((t - t[0]) / (t[-1] - t[0]), velocity[-1])
    way: Floats = np.sum(half * (velocity[1:] + velocity[:-1]), axis=0)
    return way


def heading(t: Floats, rate_down: Floats, windows: list[tuple[int, int]]) -> tuple[float, Ints]:
    """The angle turned and each sample's phase, (4.9)–(4.12).

    The angle is kept at zero while the foot rests (its mean there is drift, and goes), and a swing may
    change it only if it is a turning swing.
    """
    step = 0.5 * np.diff(t) * (rate_down[1:] + rate_down[:-1])
    angle = np.concatenate([[0.0], np.cumsum(step)])
    phase = np.full(len(t), int(Phase.STANCE))
    held = 0.0
    rests = [0, *(last for _, last in windows)], [*(first for first, _ in windows), len(t)]
    means = []
    for begin, end in zip(*rests, strict=True):
        means.append(float(np.mean(angle[begin : max(end, begin + 1)])))
        if end > begin and t[end - 1] - t[begin] >= INITIAL_S:
            phase[begin:end] = Phase.INITIAL
    for (first, last), before, after in zip(windows, means[:-1], means[1:], strict=True):
        turning = abs(after - before) > TURNING_RAD
        phase[first:last] = Phase.TURNING_SWING if turning else Phase.SWING
        if turning:
            held += after - before
    return held, phase
