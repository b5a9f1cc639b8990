"""Heart: where simulated feet go by themselves: a way through the streets to a target, as gestures.

It sees where the camera is, as a visitor does, and chooses one gesture after the other.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import dijkstra

from app.motion.basics import Floats, MotionId
from app.world import Place, Town

CELL_M, FINE_M = 2.0, 0.5
CLEAR_M = 0.75  # from every wall
_LOOKS = 12  # calls between two looks for a shorter way


class Wish(NamedTuple):
    """A gesture, and how far to twist."""

    motion: MotionId
    turn_size: float = 1.0


class Streets:
    """The town as cells that can be walked through: fine ones to look along, coarse ones to find a way."""

    def __init__(self, town: Town) -> None:
        self._half = town.half_m
        count = round(2.0 * town.half_m / FINE_M)
        self._open = np.ones((count, count), dtype=np.bool_)  # [north, east]
        for south, west, north, east in town.solid.tolist():
            rows, columns = self._cover(south, north), self._cover(west, east)
            self._open[rows, columns] = False
        edge = math.ceil(CLEAR_M / FINE_M)
        self._open[:edge] = self._open[-edge:] = False
        self._open[:, :edge] = self._open[:, -edge:] = False
        self._count = int(2 * town.half_m / CELL_M) - 1
        self._low = -0.5 * CELL_M * (self._count - 1)
        at = self._low + CELL_M * np.arange(self._count)
        north, east = (g.ravel() for g in np.meshgrid(at, at, indexing="ij"))
        self._free = self.clear(north, east)
        self._graph = self._links()

    def clear(self, north: Floats, east: Floats) -> NDArray[np.bool_]:
        """Which of these places [n] are far enough from every wall."""
        most = len(self._open) - 1
        i, j = (np.clip(((c + self._half) / FINE_M).astype(np.int64), 0, most) for c in (north, east))
        return np.asarray(self._open[i, j])

    def _cover(self, low: float, high: float) -> slice:
        """The fine cells between two coordinates, and a clear distance more."""
        first = math.floor((low - CLEAR_M + self._half) / FINE_M)
        return slice(max(0, first), max(0, math.ceil((high + CLEAR_M + self._half) / FINE_M)))

    def way(self, north: float, east: float, target: Place) -> list[tuple[float, float]]:
        """Points from here to the target; just the target where no way is known."""
        start, end = self._cell(north, east), self._cell(target.north, target.east)
        _, towards = dijkstra(self._graph, indices=[end], return_predecessors=True)
        before = towards[0].tolist()
        points: list[tuple[float, float]] = []
        while start >= 0 and start != end and len(points) < self._count**2:
            points.append(self._middle(start))
            start = before[start]
        return [*points[1:], (target.north, target.east)]

    def straight(self, north: float, east: float, to: tuple[float, float]) -> bool:
        """Whether nothing stands between."""
        length = math.hypot(to[0] - north, to[1] - east)
        part = np.linspace(0.0, 1.0, max(2, math.ceil(2.0 * length)))
        return bool(np.all(self.clear(north + part * (to[0] - north), east + part * (to[1] - east))))

    def _cell(self, north: float, east: float) -> int:
        """The nearest free cell."""
        i, j = ((c - self._low) / CELL_M for c in (north, east))
        free = np.flatnonzero(self._free)
        return int(free[np.argmin(np.hypot(free // self._count - i, free % self._count - j))])

    def _middle(self, cell: int) -> tuple[float, float]:
        return self._low + CELL_M * (cell // self._count), self._low + CELL_M * (cell % self._count)

    def _links(self) -> csr_matrix:
        n = self._count
        free = self._free.reshape(n, n)
        rows: list[NDArray[np.int64]] = []
        columns: list[NDArray[np.int64]] = []
        costs: list[Floats] = []
        number = np.arange(n * n).reshape(n, n)
        for di, dj in ((0, 1), (1, 0), (1, 1), (1, -1)):
            a = (slice(0, n - di), slice(max(0, -dj), n - max(0, dj)))
            b = (slice(di, n), slice(max(0, dj), n + min(0, dj)))
            both = free[a] & free[b]
            one, other = number[a][both], number[b][both]
            rows += [one, other]
            columns += [other, one]
            costs += [np.full(2 * len(one), math.hypot(di, dj))]
        return coo_matrix(
            (np.concatenate(costs), (np.concatenate(rows), np.concatenate(columns))), shape=(n * n, n * n)
        ).tocsr()


class Stroller:
    """Chooses gestures that lead to the target."""

    def __init__(self, town: Town) -> None:
        self._streets = Streets(town)
        self._target: Place | None = None
        self._way: list[tuple[float, float]] = []
        self._calls = 0

    def wish(self, north: float, east: float, heading_rad: float, target: Place | None) -> Wish:
        """What to do now, seen from here."""
        if target is None:
            return Wish(MotionId.NONE)
        if target != self._target:
            self._target, self._way = target, self._streets.way(north, east, target)
        to = self._ahead(north, east)
        error = math.remainder(math.atan2(to[1] - east, to[0] - north) - heading_rad, math.tau)
        size = min(1.0, max(0.3, abs(error) / 0.8))
        if abs(error) > 0.7:
            return Wish(MotionId.TURN_CW if error > 0.0 else MotionId.TURN_CCW, size)
        if abs(error) > 0.17:
            return Wish(MotionId.FORWARD_RIGHT if error > 0.0 else MotionId.FORWARD_LEFT, size)
        return Wish(MotionId.FORWARD)

    def _ahead(self, north: float, east: float) -> tuple[float, float]:
        """The furthest point of the way that lies open; nearer ones are done with."""
        self._calls += 1
        if self._calls % _LOOKS == 0 or math.hypot(self._way[0][0] - north, self._way[0][1] - east) < CELL_M:
            far = min(len(self._way), 30) - 1
            seen = next(
                (i for i in range(far, -1, -1) if self._streets.straight(north, east, self._way[i])), None
            )
            if seen is None and len(self._way) > 1:
                self._target = None  # off the way: another is looked for at the next call
            del self._way[: seen or 0]
        return self._way[0]
