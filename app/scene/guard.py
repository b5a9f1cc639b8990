"""Edge, scene: what is not a finite number stops here: viser would send a NaN to every browser."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import Quaternion
from app.motion.snapshot import FootView, OwnView

#: Further away than this is a filter that ran off, not a walk; single precision ends here too.
FAR_M = 1e5


def drawable(foot: FootView | OwnView) -> bool:
    """Whether the shoe can be put where this says."""
    numbers = (*foot.position_n, *foot.q_nb)
    if not all(map(math.isfinite, numbers)):
        return False
    return max(map(abs, foot.position_n)) < FAR_M and _norm(foot.q_nb) > 0.5


def is_turn(q: Quaternion) -> bool:
    """Whether something can be turned so."""
    return 0.5 < _norm(q) < 2.0  # a NaN is not


def unit(q: Quaternion) -> Quaternion:
    """The quaternion at length 1: viser does not see to it."""
    norm = _norm(q)
    return (q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm)


def _norm(q: Quaternion) -> float:
    return math.sqrt(sum(c * c for c in q))


def finite_segments(segments: NDArray[np.float32]) -> NDArray[np.float32]:
    """The line segments [k, 2, 3] all of whose ends are finite and near enough to draw."""
    good = (np.abs(segments) < FAR_M).all(axis=(1, 2))  # a NaN is not below anything
    return segments if good.all() else segments[good]


def finite_rows(columns: tuple[NDArray[np.float64], ...]) -> tuple[NDArray[np.float64], ...]:
    """Columns of one length without the rows in which any of them is not finite."""
    good = np.all([np.isfinite(column) for column in columns], axis=0)
    return columns if good.all() else tuple(column[good] for column in columns)
