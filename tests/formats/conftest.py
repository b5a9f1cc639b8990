"""What the format tests share: some seconds of a foot that stands, then swings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest

from app.motion.basics import Floats


@dataclass(frozen=True)
class Foot:
    """Body axes, SI: times [n] s, force and rate [n, 3], field [n, 3] µT."""

    t_s: Floats
    force: Floats
    rate: Floats
    field: Floats

    def csv(self, header: str, columns: Sequence[Floats]) -> bytes:
        """A CSV of these columns, numbers with every digit."""
        rows = np.column_stack(list(columns)).tolist()
        return "\n".join([header, *(",".join(map(repr, row)) for row in rows), ""]).encode()


@pytest.fixture
def foot() -> Foot:
    """Four seconds at 100 Hz: one of rest, then a pendulum about y with knocks."""
    t_s = np.arange(400) / 100
    swing = np.where(t_s < 1.0, 0.0, np.sin(2 * np.pi * (t_s - 1.0)))
    noise = np.random.default_rng(1).normal(0.0, 0.01, (400, 9))
    force = noise[:, :3] + np.outer(swing, [6.0, 0.5, 3.0]) + [0.0, 0.0, -9.81]
    rate = noise[:, 3:6] + np.outer(swing, [0.3, 5.0, 0.2])
    return Foot(t_s, force, rate, noise[:, 6:] + [20.0, 1.0, 45.0])
