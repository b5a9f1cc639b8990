"""Heart: sums of minimum-jerk steps: any gesture's path, with its rate and acceleration in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats
from app.simulate.gait import minimum_jerk


class Step(NamedTuple):
    """One channel changes by ``size`` from ``start_s`` on, in ``width_s``, at rest before and after."""

    start_s: float
    width_s: float
    size: float


class Course(NamedTuple):
    """Value, rate and acceleration at n instants, each [n]."""

    value: Floats
    rate: Floats
    acceleration: Floats


@dataclass(frozen=True)
class Steps:
    """Steps of one channel, in order of their starts; they may overlap."""

    start_s: Floats  # [k]
    width_s: Floats  # [k]
    size: Floats  # [k]

    def at(self, t_s: Floats) -> Course:
        """The sum of all steps at these seconds [n], in any order."""
        order = np.argsort(t_s, kind="stable")
        t = np.asarray(t_s, dtype=np.float64)[order]
        first = np.searchsorted(t, self.start_s, side="left")
        after = np.searchsorted(t, self.start_s + self.width_s, side="left")
        value, rate, acceleration = (np.zeros(len(t)) for _ in range(3))
        done = np.bincount(np.minimum(after, len(t)), self.size, len(t) + 1)[: len(t)]
        under_way = after - first
        which = np.repeat(np.arange(len(self.size)), under_way)
        within = np.arange(len(which)) - np.repeat(np.cumsum(under_way) - under_way, under_way)
        sample = first[which] + within
        share, slope, bend = minimum_jerk((t[sample] - self.start_s[which]) / self.width_s[which])
        size, width = self.size[which], self.width_s[which]
        value[order] = np.cumsum(done) + np.bincount(sample, size * share, len(t))
        rate[order] = np.bincount(sample, size * slope / width, len(t))
        acceleration[order] = np.bincount(sample, size * bend / width**2, len(t))
        return Course(value, rate, acceleration)


def sum_of(steps: list[Step]) -> Steps:
    """The steps of one channel, sorted."""
    table = np.array(sorted(steps), dtype=np.float64).reshape(-1, 3)
    return Steps(table[:, 0], table[:, 1], table[:, 2])
