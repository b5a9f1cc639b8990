"""Benchmarks: how far an estimate is from the truth: mirrored, turned and shifted first, nothing else."""

from __future__ import annotations

import numpy as np

from app.motion.basics import Floats

#: The path of a densely sampled truth is taken from every so many-th row, or its noise would lengthen it.
PATH_EVERY = 10


def mirrored(truth: Floats) -> Floats:
    """A truth [n, 2 or 3] whose y (and z, if it points up) make a left-handed frame: y negated."""
    flipped: Floats = truth * np.array([1.0, -1.0, 1.0])[: truth.shape[1]]
    return flipped


def aligned(estimate: Floats, truth: Floats) -> Floats:
    """``estimate`` [n, 2 or 3] after the least-squares yaw and translation onto ``truth``."""
    e, t = estimate - estimate.mean(axis=0), truth - truth.mean(axis=0)
    cosine = float(np.sum(e[:, 0] * t[:, 0] + e[:, 1] * t[:, 1]))
    sine = float(np.sum(e[:, 0] * t[:, 1] - e[:, 1] * t[:, 0]))
    yaw = np.arctan2(sine, cosine)
    turned = e.copy()
    turned[:, 0] = np.cos(yaw) * e[:, 0] - np.sin(yaw) * e[:, 1]
    turned[:, 1] = np.sin(yaw) * e[:, 0] + np.cos(yaw) * e[:, 1]
    onto: Floats = turned + truth.mean(axis=0)
    return onto


def rmse_m(estimate: Floats, truth: Floats) -> float:
    """Root mean square distance, m, after ``aligned``; both [n, 2 or 3] in right-handed frames, z up."""
    away = aligned(estimate, truth) - truth
    return float(np.sqrt(np.mean(np.sum(away * away, axis=1))))


def path_m(truth: Floats, every: int = 1) -> float:
    """Horizontal length of a path [n, 2 or 3] through every ``every``-th point."""
    return float(np.sum(np.linalg.norm(np.diff(truth[::every, :2], axis=0), axis=1)))


def up(position_n: Floats) -> Floats:
    """North, east, down [n, 3] as x, y, z of a right-handed frame with z up: north, west, up."""
    turned: Floats = position_n * np.array([1.0, -1.0, -1.0])
    return turned


#: PyShoe's metric sets the yaw where the truth is first this far from the start, m.
PYSHOE_YAW_AT_M = 0.8


def pyshoe_m(estimate: Floats, truth: Floats) -> float:
    """The error as PyShoe's authors publish it: 2-D, start pinned, yaw set at 0.8 m, mean distance / √2."""
    e, t = estimate[:, :2] - estimate[0, :2], truth[:, :2] - truth[0, :2]
    far = int(np.argmax(np.linalg.norm(t, axis=1) > PYSHOE_YAW_AT_M))
    yaw = float(np.arctan2(t[far, 1], t[far, 0]) - np.arctan2(e[far, 1], e[far, 0]))
    c, s = np.cos(yaw), np.sin(yaw)
    away = e @ np.array([[c, s], [-s, c]]) - t
    return float(np.mean(np.linalg.norm(away, axis=1)) / np.sqrt(2.0))
