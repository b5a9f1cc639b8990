"""Heart: a path decimated for drawing, in pieces that never change, coarser the older they are."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.compiled import kernel
from app.motion import Floats, Trail, TrailPiece

Segments = NDArray[np.float32]  # [k, 2, 3]

#: Segments in a piece, and how far apart points are: fresh, older, old. Metres.
PIECE = 512
STEPS_M = (0.02, 0.10, 0.50)
#: A level with more pieces than this merges its oldest MERGED into one of the next level.
PIECES = 8
MERGED = 4

EMPTY: Segments = np.empty((0, 2, 3), np.float32)


@kernel
def thin_rows(rows: Floats, last: Floats, step_m: float, kept: Floats) -> int:
    """Points at least ``step_m`` apart: rows [k, ≥3] → ``kept`` [k, 3], from ``last`` [3] on; how many."""
    count = 0
    for i in range(rows.shape[0]):
        x, y, z = rows[i, 0] - last[0], rows[i, 1] - last[1], rows[i, 2] - last[2]
        if x * x + y * y + z * z >= step_m * step_m:
            for axis in range(3):
                last[axis] = rows[i, axis]
                kept[count, axis] = rows[i, axis]
            count += 1
    return count


@kernel
def thin_segments(segments: Any, step_m: float, kept: Any) -> int:
    """Join segments [k, 2, 3] that hang together into ones of at least ``step_m``; how many."""
    count = 0
    start = 0
    for i in range(segments.shape[0]):
        dx = segments[i, 1, 0] - segments[start, 0, 0]
        dy = segments[i, 1, 1] - segments[start, 0, 1]
        dz = segments[i, 1, 2] - segments[start, 0, 2]
        broken = i + 1 == segments.shape[0]
        if not broken:
            for axis in range(3):
                broken = broken or segments[i, 1, axis] != segments[i + 1, 0, axis]
        if broken or dx * dx + dy * dy + dz * dz >= step_m * step_m:
            for axis in range(3):
                kept[count, 0, axis] = segments[start, 0, axis]
                kept[count, 1, axis] = segments[i, 1, axis]
            count += 1
            start = i + 1
    return count


def coarser(segments: Segments, step_m: float) -> Segments:
    """The same path with longer segments; ends and breaks stay."""
    kept = np.empty_like(segments)
    return kept[: thin_segments(segments, step_m, kept)].copy()


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
        self._name = name
        self._made = 0
        self._levels: list[list[TrailPiece]] = [[] for _ in STEPS_M]
        self._growing = np.empty((PIECE, 2, 3), np.float32)
        self._count = 0
        self._shown: Segments = EMPTY
        self._last: Floats | None = None

    def add(self, rows: Floats) -> None:
        """More settled rows [k, ≥3], contiguous in time with those before."""
        if not len(rows):
            return
        if self._last is None:
            self._last = rows[0, :3].copy()
        kept = np.empty((len(rows) + 1, 3))
        kept[0] = self._last
        count = thin_rows(rows, self._last, STEPS_M[0], kept[1:])
        self._append(segments_of(kept[: count + 1]))

    def lift_pen(self) -> None:
        """A new segment of time: the next row is not joined to the last."""
        self._last = None

    def seed(self, pieces: tuple[TrailPiece, ...]) -> None:
        """Put older pieces, of another builder, in front."""
        self._levels[-1] = [*pieces, *self._levels[-1]]

    def turn(self, name: str, angle_rad: float) -> None:
        """Turn all of it clockwise, seen from above, about the start; its pieces get new keys."""
        self._name = name
        self._levels = [
            [TrailPiece(f"{name}/{p.key}", _turned(p.segments, angle_rad)) for p in level]
            for level in self._levels
        ]
        self._growing, self._shown = _turned(self._growing, angle_rad), EMPTY
        if self._last is not None:
            self._last = _turned(self._last, angle_rad)

    def finished(self) -> tuple[TrailPiece, ...]:
        """All of it as settled pieces, the growing one too."""
        growing = TrailPiece(
            f"{self._name}.growing{self._made}.{self._count}", self._growing[: self._count].copy()
        )
        return (*self.pieces, growing)

    @property
    def pieces(self) -> tuple[TrailPiece, ...]:
        """All settled pieces, oldest first."""
        return tuple(piece for level in reversed(self._levels) for piece in level)

    def trail(self, provisional: Floats) -> Trail:
        """What there is to draw; ``provisional`` [k, ≥3] are the rows after the settled ones."""
        if len(self._shown) != self._count:
            self._shown = self._growing[: self._count].copy()
        tail = provisional[:, :3]
        if self._last is not None:
            tail = np.concatenate([self._last[None], tail])
        return Trail(self.pieces, self._shown, segments_of(tail))

    def _append(self, segments: Segments) -> None:
        while len(segments):
            part = segments[: PIECE - self._count]
            self._growing[self._count : self._count + len(part)] = part
            self._count += len(part)
            segments = segments[len(part) :]
            if self._count == PIECE:
                self._put(0, self._growing.copy())
                self._count = 0
                self._shown = EMPTY

    def _put(self, level: int, segments: Segments) -> None:
        self._made += 1
        self._levels[level].append(TrailPiece(f"{self._name}.{self._made}", segments))
        if level + 1 < len(STEPS_M) and len(self._levels[level]) > PIECES:
            merged = [self._levels[level].pop(0).segments for _ in range(MERGED)]
            self._put(level + 1, coarser(np.concatenate(merged), STEPS_M[level + 1]))
