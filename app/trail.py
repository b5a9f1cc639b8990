"""Heart: a path decimated for drawing, in pieces that never change, coarser the older they are."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.compiled import kernel, part
from app.motion.basics import Floats
from app.motion.snapshot import Trail, TrailPiece

Segments = NDArray[np.float32]  # [k, 2, 3]

#: Segments in a piece, and how far from the path a line may lie: fresh, older, old. Metres.
PIECE = 64
TOLERANCES_M = (0.005, 0.03, 0.15)
#: Small pieces, so that what lies out of view is not drawn. A level with more than this merges its oldest
#: MERGED into one of the next level.
PIECES = 24
MERGED = 8
#: Points nearer than this to the one before are left out. Metres.
APART_M = 0.005
#: Points that one straight segment stands for, at most.
SLEEVE = 32

EMPTY: Segments = np.empty((0, 2, 3), np.float32)


@part
def straight(sleeve: Floats, waiting: int, x: float, y: float, z: float, tolerance_m: float) -> bool:
    """Whether the points that wait lie within the tolerance of the segment ``sleeve[0]`` – (x, y, z)."""
    ax, ay, az = x - sleeve[0, 0], y - sleeve[0, 1], z - sleeve[0, 2]
    squared = max(ax * ax + ay * ay + az * az, 1e-12)
    for i in range(1, waiting + 1):
        bx, by, bz = sleeve[i, 0] - sleeve[0, 0], sleeve[i, 1] - sleeve[0, 1], sleeve[i, 2] - sleeve[0, 2]
        share = min(1.0, max(0.0, (ax * bx + ay * by + az * bz) / squared))
        dx, dy, dz = bx - share * ax, by - share * ay, bz - share * az
        if dx * dx + dy * dy + dz * dz > tolerance_m * tolerance_m:
            return False
    return True


@kernel
def thin(
    points: Floats, sleeve: Floats, waiting: int, tolerance_m: float, apart_m: float, kept: Floats
) -> tuple[int, int]:
    """The corners of a path: points [k, ≥3] → ``kept`` [k, 3]; how many, and how many now wait.

    ``sleeve`` [SLEEVE + 1, 3] is the last corner and the ``waiting`` points after it, all near one line.
    """
    count = 0
    for i in range(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        dx, dy, dz = x - sleeve[waiting, 0], y - sleeve[waiting, 1], z - sleeve[waiting, 2]
        if dx * dx + dy * dy + dz * dz < apart_m * apart_m:
            continue
        if waiting == SLEEVE or not straight(sleeve, waiting, x, y, z, tolerance_m):
            for axis in range(3):
                kept[count, axis] = sleeve[0, axis] = sleeve[waiting, axis]
            count += 1
            waiting = 0
        waiting += 1
        sleeve[waiting, 0], sleeve[waiting, 1], sleeve[waiting, 2] = x, y, z
    return count, waiting


def coarser(segments: Segments, tolerance_m: float) -> Segments:
    """The same path with fewer segments; ends and breaks stay."""
    if len(segments) < 2:
        return segments.copy()
    breaks = np.flatnonzero((segments[1:, 0] != segments[:-1, 1]).any(axis=1)) + 1
    return np.concatenate([_straightened(chain, tolerance_m) for chain in np.split(segments, breaks)])


def _straightened(chain: Segments, tolerance_m: float) -> Segments:
    """Segments that hang together, as fewer."""
    sleeve, kept = np.empty((SLEEVE + 1, 3)), np.empty((len(chain) + 2, 3))
    sleeve[0] = kept[0] = chain[0, 0]
    ends = np.ascontiguousarray(chain[:, 1], np.float64)  # as rows are: ``thin`` is compiled for one kind
    count, _ = thin(ends, sleeve, 0, tolerance_m, 0.0, kept[1:])
    kept[count + 1] = chain[-1, 1]
    return segments_of(kept[: count + 2])


def segments_of(points: Floats) -> Segments:
    """The segments that join points [k, 3]."""
    return np.stack([points[:-1], points[1:]], axis=1).astype(np.float32) if len(points) > 1 else EMPTY


def _turned(points: Any, angle_rad: float) -> Any:
    """Points [..., 3] of any float type, turned about down."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return (points @ turn.T).astype(points.dtype)


class TrailBuilder:
    """Takes settled rows in order and hands out pieces."""

    def __init__(self, name: str) -> None:
        """``name`` makes the keys of its pieces unique."""
        self.name = name
        self._made = 0
        self._taken = 0  # rows
        self._levels: list[list[TrailPiece]] = [[] for _ in TOLERANCES_M]
        self._pieces: tuple[TrailPiece, ...] = ()  # all settled ones, oldest first
        self._growing = np.zeros((PIECE, 2, 3), np.float32)
        self._count = 0
        self._shown: Segments = EMPTY
        self._sleeve = np.zeros((SLEEVE + 1, 3))  # the last corner, and the points after it
        self._waiting: int | None = None  # how many; None while the pen is up

    def add(self, rows: Floats) -> None:
        """More settled rows [k, ≥3], contiguous in time with those before."""
        if not len(rows):
            return
        self._taken += len(rows)
        if self._waiting is None:
            self._sleeve[0], self._waiting = rows[0, :3], 0
        kept = np.empty((len(rows) + 1, 3))
        kept[0] = self._sleeve[0]
        count, waiting = thin(rows, self._sleeve, self._waiting, TOLERANCES_M[0], APART_M, kept[1:])
        if count or waiting != self._waiting:
            self._shown, self._waiting = EMPTY, waiting
            self._append(segments_of(kept[: count + 1]))

    def lift_pen(self) -> None:
        """A new segment of time: the next row is not joined to the last."""
        self._append(self._open)
        self._waiting = None

    def seed(self, pieces: tuple[TrailPiece, ...]) -> None:
        """Put older pieces, of another builder, in front."""
        self._levels[-1] = [*pieces, *self._levels[-1]]
        self._tell()

    def turn(self, name: str, angle_rad: float) -> None:
        """Turn all of it clockwise, seen from above, about the start; its pieces get new keys."""
        self.name = name
        self._levels = [
            [TrailPiece(f"{name}/{p.key}", _turned(p.segments, angle_rad)) for p in level]
            for level in self._levels
        ]
        self._growing, self._shown = _turned(self._growing, angle_rad), EMPTY
        self._sleeve = _turned(self._sleeve, angle_rad)
        self._tell()

    def finished(self) -> tuple[TrailPiece, ...]:
        """All of it as settled pieces, the growing one too."""
        return (*self._pieces, TrailPiece(f"{self.name}.growing{self._taken}", self._all_growing()))

    def trail(self, provisional: Floats) -> Trail:
        """What there is to draw; ``provisional`` [k, ≥3] are the rows after the settled ones."""
        if self._shown is EMPTY:
            self._shown = self._all_growing()
        tail = provisional[:, :3]
        if self._waiting is not None:
            tail = np.concatenate([self._sleeve[self._waiting][None], tail])
        return Trail(self._pieces, self._shown, segments_of(tail))

    @property
    def _open(self) -> Segments:
        """From the last corner straight on to where the path is now: no segment yet, but drawn."""
        return segments_of(self._sleeve[[0, self._waiting]]) if self._waiting else EMPTY

    def _all_growing(self) -> Segments:
        return np.concatenate([self._growing[: self._count], self._open])

    def _append(self, segments: Segments) -> None:
        while len(segments):
            part = segments[: PIECE - self._count]
            self._growing[self._count : self._count + len(part)] = part
            self._count += len(part)
            segments = segments[len(part) :]
            if self._count == PIECE:
                self._put(0, self._growing.copy())
                self._count = 0
                self._tell()

    def _put(self, level: int, segments: Segments) -> None:
        self._made += 1
        self._levels[level].append(TrailPiece(f"{self.name}.{self._made}", segments))
        if level + 1 < len(TOLERANCES_M) and len(self._levels[level]) > PIECES:
            merged = [self._levels[level].pop(0).segments for _ in range(MERGED)]
            self._put(level + 1, coarser(np.concatenate(merged), TOLERANCES_M[level + 1]))

    def _tell(self) -> None:
        self._pieces = tuple(piece for level in reversed(self._levels) for piece in level)
