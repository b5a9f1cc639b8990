"""Heart: where a simulated walk goes: paths of straights and arcs, by arc length, in closed form."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats
from app.simulate.options import WalkOptions

#: Lane 7 of the papers (dissertation, ch. V): its length; the straights are a standard track's.
LANE_M = 437.5
_STRAIGHTS_OF_LANE = 2 * 84.39 / LANE_M
#: A stair as they are built: 17 cm up for 28 cm on. A stride takes two treads.
TREAD_M = 0.28
RISER_M = 0.17


class Places(NamedTuple):
    """Points of a course, start at (0, 0, 0): ``position_n`` [n, 3] m, ``heading_rad`` [n], unwrapped."""

    position_n: Floats
    heading_rad: Floats


class Piece(NamedTuple):
    """A straight or an arc, perhaps sloping: ``turn_rad`` is positive to the right."""

    length_m: float
    turn_rad: float = 0.0
    climb_m: float = 0.0


@dataclass(frozen=True)
class Course:
    """Pieces in order. A closed course starts again at its end; on an open one the last piece goes on."""

    pieces: tuple[Piece, ...]
    closed: bool

    @property
    def length_m(self) -> float:
        """One lap, or all pieces."""
        return sum(piece.length_m for piece in self.pieces)

    def places(self, along_m: Floats) -> Places:
        """Position and heading at these arc lengths [n] m; before the start the first piece is prolonged."""
        laps = np.floor(along_m / self.length_m) if self.closed else np.zeros_like(along_m)
        lengths = np.array([piece.length_m for piece in self.pieces])
        turns = np.array([piece.turn_rad for piece in self.pieces])
        starts = np.concatenate(([0.0], np.cumsum(lengths)[:-1]))
        headings = np.concatenate(([0.0], np.cumsum(turns)))
        corners = np.vstack(([[0.0, 0.0, 0.0]], np.cumsum(self._chords(lengths, headings[:-1]), axis=0)))
        within = along_m - laps * self.length_m
        i = np.clip(np.searchsorted(starts, within, side="right") - 1, 0, None)
        last = within - starts[i]
        position = corners[i] + _chord(last, headings[i], turns[i] / lengths[i], self._slopes()[i])
        return Places(position, headings[i] + turns[i] / lengths[i] * last + laps * headings[-1])

    def _chords(self, lengths: Floats, headings: Floats) -> Floats:
        bends = np.array([piece.turn_rad / piece.length_m for piece in self.pieces])
        return _chord(lengths, headings, bends, self._slopes())

    def _slopes(self) -> Floats:
        return np.array([piece.climb_m / piece.length_m for piece in self.pieces])


def _chord(length: Floats, heading: Floats, bend: Floats, slope: Floats) -> Floats:
    """From the start of an arc to its point at ``length``: sinc makes one formula of arc and straight."""
    half = 0.5 * bend * length
    chord = length * np.sinc(half / np.pi)
    return np.column_stack([chord * np.cos(heading + half), chord * np.sin(heading + half), -slope * length])


def course_of(options: WalkOptions) -> Course:
    """The course that the options name."""
    if options.path == "oval":
        return _oval(options.size_m or LANE_M)
    if options.path == "square":
        return _square(options.size_m or 12.0)
    if options.path == "eight":
        return _eight(options.size_m or 8.0)
    if options.path == "stairs":
        return _stairs()
    return Course((Piece(1.0),), closed=False)


def _oval(lap_m: float) -> Course:
    """The track: two straights and two semicircles, counter-clockwise as the papers walked it."""
    straight = 0.5 * _STRAIGHTS_OF_LANE * lap_m
    bend = 0.5 * lap_m - straight
    return Course((Piece(straight), Piece(bend, -math.pi)) * 2, closed=True)


def _square(side_m: float) -> Course:
    """A square with rounded corners, clockwise, from the middle of a side."""
    radius = min(1.5, 0.25 * side_m)
    half = 0.5 * side_m - radius
    corner = Piece(0.5 * math.pi * radius, 0.5 * math.pi)
    return Course((Piece(half), corner, Piece(half)) * 4, closed=True)


def _eight(diameter_m: float) -> Course:
    """A circle to the right, then one to the left."""
    circle = math.pi * diameter_m
    return Course((Piece(circle, 2 * math.pi), Piece(circle, -2 * math.pi)), closed=True)


def _stairs() -> Course:
    """Two flights of ten treads with a half-turn on the landing; every piece is a whole number of treads."""
    flat, flight = Piece(8 * TREAD_M), Piece(10 * TREAD_M, climb_m=10 * RISER_M)
    return Course((flat, flight, Piece(8 * TREAD_M, math.pi), flight, flat), closed=False)
