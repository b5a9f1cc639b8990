"""Heart: a simulator's truth beside the walk: its trail, and how far the estimate is off."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from app.blocks import Blocks
from app.estimator.turns import Turns
from app.motion.basics import Floats, Quaternion
from app.motion.estimate import ATTITUDE, POSITION
from app.motion.snapshot import Trail
from app.motion.source import Truth
from app.rotation import from_yaw, multiply, yaw_of
from app.settings import Settings
from app.trail import TrailBuilder

#: The truth is looked at so many times a second, and for so many seconds at once: it costs closed forms.
TRUTH_HZ = 25.0
TOGETHER_S = 0.2
#: Points that are kept for a graph of ten seconds.
KEPT = 250


class TruePlace(NamedTuple):
    """Where a foot truly was, and how it was turned, at one of its samples."""

    row: int
    t_s: float  # since the first sample
    position_n: Floats  # [3], from where it was at the first sample
    q_nb: Quaternion


class Times(Protocol):
    """When a sensor's samples were taken: ``stores.SensorStore``."""

    samples: Blocks

    def time_ns(self, row: int) -> float:
        """Nanoseconds from the first sample to this one."""
        ...

    def rate_hz(self) -> float:
        """Samples a second."""
        ...


class TrueWalk:
    """One sensor's truth, from the place and to the heading that the main track starts with.

    The closed form has its own start and heading; without a magnetometer the estimate starts at
    ``start_heading_rad``, with one its north lies there.
    """

    def __init__(self, name: str, truth: Truth, sensor: str, begin_s: float = 0.0) -> None:
        """``name`` makes the keys of its trail's pieces unique; the first sample came at ``begin_s``."""
        self._name, self._truth, self._sensor, self._begin_s = name, truth, sensor, begin_s
        self._turned: tuple[float, bool] | None = None
        self._begin(())

    def _begin(self, turned: tuple[float, bool] | tuple[()]) -> None:
        self._turned = turned or None
        self._next = 0  # row to look at
        self._builder = TrailBuilder(f"{self._name}.{turned}")
        self.recent: deque[TruePlace] = deque(maxlen=KEPT)

    def look(self, times: Times, settings: Settings) -> TruePlace:
        """Bring the trail up to the newest sample; the newest true place known."""
        turned = (settings.start_heading_rad, settings.magnetometer)
        if turned != self._turned:
            self._begin(turned)
        apart = max(1, round(times.rate_hz() / TRUTH_HZ))
        if times.samples.end - self._next > TOGETHER_S * TRUTH_HZ * apart or not self.recent:
            rows = range(max(self._next, times.samples.start), times.samples.end, apart)
            places, newest = self._at(rows, times, settings)
            self._builder.add(places)
            self.recent.extend(newest)
            self._next = rows[-1] + apart
        return self.recent[-1]

    def at(self, rows: Sequence[int], times: Times, settings: Settings) -> list[TruePlace]:
        """The truth at some of the samples, at most ``KEPT``."""
        return self._at(rows, times, settings)[1]

    def trail(self) -> Trail:
        """What was looked at so far."""
        return self._builder.trail(np.empty((0, 3)))

    def _at(self, rows: Sequence[int], times: Times, settings: Settings) -> tuple[Floats, list[TruePlace]]:
        """All places [n, 3], and the newest few with how the foot was turned."""
        t_s = [times.time_ns(row) * 1e-9 for row in rows]
        position_n, q_nb = self._truth(self._sensor, self._begin_s + np.append(0.0, t_s))
        start = 0.0 if settings.magnetometer else yaw_of(tuple(q_nb[0].tolist()))
        angle = settings.start_heading_rad - start
        turn, c, s = from_yaw(angle), math.cos(angle), math.sin(angle)
        places = (position_n[1:] - position_n[0]) @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        newest = range(max(0, len(rows) - KEPT), len(rows))
        turned = {k: multiply(turn, tuple(q_nb[k + 1].tolist())) for k in newest}
        return places, [TruePlace(rows[k], t_s[k], places[k], turned[k]) for k in newest]


def thinned(first: int, last: int) -> list[int]:
    """Some rows from ``first`` to ``last`` (exclusive), as many as are kept at most, the newest with them."""
    rows: list[int] = np.linspace(first, last - 1, min(KEPT, last - first)).astype(int).tolist()
    return rows


def errors(recent: Iterable[TruePlace], rows: Blocks, turns: Turns) -> Floats:
    """Seconds, metres from the truth, pitch of the estimate's ``rows`` and of the truth: [k, 4]."""
    known = [true for true in recent if rows.start <= true.row < rows.end]
    if not known:
        return np.empty((0, 4))
    found = np.array([block[place] for block, place in (rows.block(true.row) for true in known)])
    found = turns.of(found, np.array([true.row for true in known]))
    away = np.linalg.norm(np.array([true.position_n for true in known]) - found[:, POSITION], axis=1)
    t_s, true_q_nb = [true.t_s for true in known], np.array([true.q_nb for true in known])
    return np.stack([t_s, away, pitches(found[:, ATTITUDE]), pitches(true_q_nb)], axis=1)


def pitches(q_nb: Floats) -> Floats:
    """Elevation of body x above the horizontal plane, rad [k], of unit quaternions [k, 4]."""
    w, x, y, z = q_nb.T
    up: Floats = np.arcsin(np.clip(2.0 * (w * y - x * z), -1.0, 1.0))
    return up


def error_m(true: TruePlace, rows: Blocks, turns: Turns) -> float:
    """How far one of the estimate's rows, turned, is from the truth."""
    row = turns.of(rows.table(true.row, true.row + 1), np.array([true.row]))[0]
    return float(np.linalg.norm(true.position_n - row[POSITION]))


def attitude(true: TruePlace, rows: Blocks) -> Quaternion:
    """How the estimate has the foot turned there."""
    block, place = rows.block(true.row)
    w, x, y, z = block[place, ATTITUDE].tolist()
    return (w, x, y, z)
