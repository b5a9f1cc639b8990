"""Heart: a simulator's truth beside the walk: its trail, and how far the estimate is off."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.motion import Floats, Trail, Truth
from app.rotation import from_yaw, rotate, yaw_of
from app.settings import Settings
from app.trail import TrailBuilder

#: The truth is looked at so many times a second, and for so many seconds at once: it costs closed forms.
TRUTH_HZ = 25.0
TOGETHER_S = 0.2


class TruePlace(NamedTuple):
    """Where a foot truly was at one of its samples."""

    row: int
    position_n: Floats  # [3]


class TrueWalk:
    """One sensor's truth, turned to the start heading that the main track has.

    The closed form starts at its own heading; without a magnetometer the estimate starts at
    ``start_heading_rad``, with one its north lies there.
    """

    def __init__(self, name: str, truth: Truth, sensor: str) -> None:
        """``name`` makes the keys of its trail's pieces unique."""
        self._name, self._truth, self._sensor = name, truth, sensor
        self._turned: tuple[float, bool] | None = None
        self._begin(())

    def _begin(self, turned: tuple[float, bool] | tuple[()]) -> None:
        self._turned = turned or None
        self._done = 0  # points looked at
        self._builder = TrailBuilder(f"{self._name}.{turned}")
        self._newest: TruePlace | None = None

    def look(self, row: int, elapsed_s: float, settings: Settings) -> TruePlace:
        """Bring the trail up to the newest sample, number ``row``; the newest true place known."""
        turned = (settings.start_heading_rad, settings.magnetometer)
        if turned != self._turned:
            self._begin(turned)
        end = int(elapsed_s * TRUTH_HZ) + 1
        if end - self._done >= TOGETHER_S * TRUTH_HZ or self._newest is None:
            t_s = np.append(np.arange(self._done, end) / TRUTH_HZ, elapsed_s)
            position_n = self._positions(t_s, settings)
            self._builder.add(position_n[:-1])
            self._newest = TruePlace(row, position_n[-1])
            self._done = end
        return self._newest

    def trail(self) -> Trail:
        """What was looked at so far."""
        return self._builder.trail(np.empty((0, 3)))

    def _positions(self, t_s: Floats, settings: Settings) -> Floats:
        position_n, q_nb = self._truth(self._sensor, np.append(0.0, t_s))
        start = 0.0 if settings.magnetometer else yaw_of(tuple(q_nb[0].tolist()))
        turn = from_yaw(settings.start_heading_rad - start)
        if turn == (1.0, 0.0, 0.0, 0.0):
            return position_n[1:]
        return np.array([rotate(turn, tuple(p)) for p in position_n[1:].tolist()])
