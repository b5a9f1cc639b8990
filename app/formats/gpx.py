"""Heart: a GPX track as a way on the floor: metres north and east of its first point.

Expat reads it, a piece at a time; a document type, which is how XML is made to explode, is refused.
"""

from __future__ import annotations

import math
from typing import NamedTuple
from xml.parsers import expat

import numpy as np

from app.motion.basics import Floats, InputError
from app.motion.status import Reference

_A, _E2 = 6378137.0, 6.69437999014e-3  # WGS 84
MOST_POINTS = 1_000_000
#: Tracks are drawn near the walk: what leaves this is another place.
FARTHEST_M = 100_000.0
_POINTS = ("trkpt", "rtept")


class GpxTrack(NamedTuple):
    """A track's name and its pieces: each [k, 2] metres, magnetic north and east of the first point."""

    name: str
    pieces: tuple[Floats, ...]

    @property
    def length_m(self) -> float:
        """Along all pieces."""
        return sum(float(np.hypot(*np.diff(piece, axis=0).T).sum()) for piece in self.pieces)


def reference_of(track: GpxTrack) -> Reference:
    """The track as the page draws it."""
    segments = [np.stack([piece[:-1], piece[1:]], axis=1) for piece in track.pieces]
    return Reference(track.name, np.concatenate(segments).astype(np.float32), track.length_m)


def turned(reference: Reference, declination_rad: float) -> Reference:
    """The same track where magnetic north lies ``declination_rad`` east of true north."""
    turn = _to_magnetic(declination_rad - reference.declination_rad)
    segments = (reference.segments @ turn.T).astype(np.float32)
    return reference._replace(segments=segments, declination_rad=declination_rad)


def _to_magnetic(angle_rad: float) -> Floats:
    """True north and east into magnetic ones."""
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[cosine, sine], [-sine, cosine]])


def recognises(data: bytes) -> bool:
    """Whether the bytes begin as a GPX file does."""
    return b"<gpx" in data[:4096]


def read(name: str, data: bytes, declination_rad: float = 0.0) -> GpxTrack:
    """The track in a GPX file; ``InputError``, one line, if there is none.

    ``declination_rad``: how far magnetic north lies east of true north (the walk's north is magnetic).
    """
    found = _Points(name)
    parser = expat.ParserCreate()
    parser.StartElementHandler = found.begin
    parser.EndElementHandler = found.end
    parser.CharacterDataHandler = found.text
    parser.StartDoctypeDeclHandler = found.refuse
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise InputError(f"{name}: no GPX ({error}), expected an XML file with track points") from None
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{name}: no GPX ({error}), expected an XML file with track points") from None
    pieces = [piece for piece in found.pieces if piece]
    if not pieces:
        raise InputError(f"{name}: no track point in it, expected a GPX track or route")
    return GpxTrack(found.title.strip() or name, _on_floor(name, pieces, declination_rad))


class _Points:
    """What the parser's events come to."""

    def __init__(self, name: str) -> None:
        self.pieces: list[list[tuple[float, float]]] = [[]]
        self.title = ""
        self._name, self._path = name, [""]
        self._count = 0
        self._named = False  # a second track's name is not added to the first's

    def refuse(self, *_: object) -> None:
        raise InputError(f"{self._name}: it declares a document type, expected plain GPX")

    def begin(self, tag: str, attributes: dict[str, str]) -> None:
        self._path.append(tag.rpartition(":")[2])
        if self._path[-1] in ("trkseg", "rte"):
            self.pieces.append([])
        if self._path[-1] in _POINTS:
            self._count += 1
            if self._count > MOST_POINTS:
                raise InputError(f"{self._name}: more than {MOST_POINTS} points, expected fewer")
            self.pieces[-1].append(self._place(attributes))

    def _place(self, attributes: dict[str, str]) -> tuple[float, float]:
        try:
            latitude, longitude = float(attributes["lat"]), float(attributes["lon"])
        except (KeyError, ValueError):
            latitude = math.nan
        if not (abs(latitude) <= 89.0 and abs(longitude) <= 180.0):
            raise InputError(f"{self._name}: point {self._count} is at no latitude and longitude in degrees")
        return latitude, longitude

    def end(self, tag: str) -> None:
        left = self._path.pop()
        self._named = self._named or (left == "name" and bool(self.title))

    def text(self, data: str) -> None:
        if (
            not self._named
            and self._path[-1] == "name"
            and self._path[-2] in ("trk", "rte")
            and len(self.title) < 100
        ):
            self.title = (self.title + data)[:100]


def _on_floor(
    name: str, pieces: list[list[tuple[float, float]]], declination_rad: float
) -> tuple[Floats, ...]:
    """Degrees into metres round the first point; good to centimetres over kilometres."""
    origin = np.array(pieces[0][0])
    latitude = math.radians(origin[0])
    root = math.sqrt(1.0 - _E2 * math.sin(latitude) ** 2)
    metres = np.radians([_A * (1.0 - _E2) / root**3, _A / root * math.cos(latitude)])
    turn = _to_magnetic(declination_rad)
    placed = []
    for piece in pieces:
        away = np.array(piece) - origin
        away[:, 1] = (away[:, 1] + 180.0) % 360.0 - 180.0
        placed.append((away * metres) @ turn.T)
    if any(np.abs(piece).max() > FARTHEST_M for piece in placed):
        raise InputError(f"{name}: it reaches more than {FARTHEST_M / 1000:g} km, expected a walk")
    return tuple(placed)
