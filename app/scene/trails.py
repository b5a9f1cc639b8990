"""Edge, scene: trails: settled pieces are ribbons, sent once; their open end is lines, sent as it grows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import viser
from numpy.typing import NDArray

from app.motion.basics import Vector
from app.motion.snapshot import Trail
from app.scene.colours import Rgb
from app.scene.guard import finite_segments
from app.scene.meshes import BOTH_S, Clock, Meshes
from app.scene.ribbon import ribbon

Segments = NDArray[np.float32]

#: What an empty line is drawn as: viser's page wants at least one segment.
NOTHING: Segments = np.zeros((1, 2, 3), dtype=np.float32)
DASH_M = 0.035
#: Segments of a growing piece in one ribbon: three strides or so.
PART = 16
#: Pieces that come at once, as a ghost's do, are one mesh, or few: a mesh costs more than what is in it.
TOGETHER = 64


@dataclass(frozen=True)
class Look:
    """How a trail is drawn. ``provisional`` is the colour of the newest stride, dashed."""

    colour: Rgb
    provisional: Rgb
    thickness: float  # screen pixels
    both_s: float = BOTH_S  # what is replaced stays so long
    above_m: float = 0.0  # the main trail: where both are, the narrower one lies on the broader one


def dashes(segments: Segments, dash_m: float = DASH_M) -> Segments:
    """The same path [k, 2, 3] as dashes with gaps of one length: at most 400 of them."""
    if len(segments) == 0:
        return segments
    points = np.concatenate([segments[:, 0], segments[-1:, 1]])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    count = int(min(400, along[-1] // (2 * dash_m) + 1))
    starts = np.arange(count) * (along[-1] / count if count == 400 else 2 * dash_m)
    ends = np.minimum(starts + dash_m, along[-1])
    at = np.stack([starts, ends], axis=1)
    return np.stack([np.interp(at, along, points[:, i]) for i in range(3)], axis=-1).astype(np.float32)


def changes(drawn: set[str], wanted: set[str]) -> tuple[set[str], set[str]]:
    """Keys to take away and keys to add."""
    return drawn - wanted, wanted - drawn


class TrailNodes:
    """One trail under ``/ned/trail/<name>``, moved aside by ``offset``.

    What is settled is drawn as ribbons; only its end and the newest stride are lines, which cost more.
    """

    def __init__(self, scene: viser.SceneApi, name: str, look: Look, offset: Vector, now: Clock) -> None:
        self._scene, self._look, self._now = scene, look, now
        self._prefix = f"/ned/trail/{name}"
        place = (offset[0], offset[1], offset[2] - look.above_m)
        self._root = scene.add_frame(self._prefix, show_axes=False, position=place)
        self._meshes = Meshes(scene, f"{self._prefix}/piece", look.both_s, now)
        self._keys: set[str] = set()
        self._groups: set[tuple[str, ...]] = set()  # of pieces, each one mesh
        self._parts: list[tuple[Segments, float]] = []  # of the growing piece that are ribbons, since when
        self._growing: Segments = NOTHING[:0]
        self._line = _Line(self._add_line("growing", look.colour), look.both_s, now)
        self._provisional = self._add_line("provisional", look.provisional)
        self._drawn: Trail | None = None

    def draw(self, trail: Trail) -> None:
        """Make the page show this trail; what is the same object as last time costs nothing."""
        last, self._drawn = self._drawn, trail
        self._meshes.tidy()
        if last is None or last.pieces is not trail.pieces:
            self._draw_pieces(trail)
        if last is None or last.growing is not trail.growing:
            self._growing = finite_segments(trail.growing)
            self._draw_parts()
        self._line.show(self._growing, self._parts_there() * PART)
        if last is None or last.provisional is not trail.provisional:
            _show(self._provisional, dashes(finite_segments(trail.provisional)))

    def _draw_pieces(self, trail: Trail) -> None:
        wanted = {piece.key: piece for piece in trail.pieces}
        gone, new = changes(self._keys, set(wanted))
        torn = {group for group in self._groups if not gone.isdisjoint(group)}
        for group in torn:
            self._meshes.drop(group)
        anew = new.union(*torn)
        keys = [piece.key for piece in trail.pieces if piece.key in anew]
        groups = [tuple(keys[i : i + TOGETHER]) for i in range(0, len(keys), TOGETHER)]
        for group in groups:
            self._put(group, np.concatenate([finite_segments(wanted[key].segments) for key in group]))
        self._groups = (self._groups - torn).union(groups)
        was, self._keys = self._keys, set(wanted)
        kept = was & self._keys
        if new and (kept or not was):
            self._line.linger()

    def _draw_parts(self) -> None:
        """Ribbons for all of the growing piece but its end, which still changes."""
        starts = range(0, len(self._growing) - PART, PART)
        wanted = [self._growing[start : start + PART] for start in starts]
        both = zip(self._parts, wanted, strict=False)
        same = next((i for i, ((had, _), has) in enumerate(both) if not np.array_equal(had, has)), None)
        keep = min(len(self._parts), len(wanted)) if same is None else same
        for i in range(keep, len(self._parts)):
            self._meshes.drop(i)
        del self._parts[keep:]
        for i in range(keep, len(wanted)):
            self._put(i, wanted[i])
            self._parts.append((wanted[i], self._now()))

    def _parts_there(self) -> int:
        """How many of them every browser has drawn by now."""
        before = self._now() - self._look.both_s
        return sum(since < before for _, since in self._parts)

    def _put(self, key: tuple[str, ...] | int, segments: Segments) -> None:
        if len(segments):
            self._meshes.put(key, ribbon(segments, self._look.colour, self._look.thickness))

    def _add_line(self, name: str, colour: Rgb) -> viser.LineSegmentsHandle:
        return self._scene.add_line_segments(
            f"{self._prefix}/{name}", NOTHING, colour,
            thickness=self._look.thickness, thickness_units="screen",
        )  # fmt: skip

    def remove(self) -> None:
        """Take the whole trail off the page."""
        self._root.remove()


class _Line:
    """The end of what is settled; also what has just become a ribbon, until that is there."""

    def __init__(self, node: viser.LineSegmentsHandle, both_s: float, now: Clock) -> None:
        self._node, self._both_s, self._now = node, both_s, now
        self._shown: tuple[Segments, int, Segments] = (NOTHING[:0], 0, NOTHING[:0])
        self._rest: Segments = NOTHING[:0]
        self._until_s = 0.0

    def linger(self) -> None:
        """What is shown now stays for a moment."""
        growing, start, rest = self._shown
        self._rest = np.concatenate([rest, growing[start:]])[-2 * PART :]
        self._until_s = self._now() + self._both_s

    def show(self, growing: Segments, start: int) -> None:
        """Draw these from ``start`` on."""
        if len(self._rest) and self._now() > self._until_s:
            self._rest = NOTHING[:0]
        was = self._shown
        if growing is not was[0] or start != was[1] or self._rest is not was[2]:
            self._shown = (growing, start, self._rest)
            _show(self._node, np.concatenate([self._rest, growing[start:]]))


def _show(line: viser.LineSegmentsHandle, segments: Segments) -> None:
    line.points = segments if len(segments) else NOTHING
