"""Edge, scene: trails: settled pieces are sent once, the open end again as it grows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import viser
from numpy.typing import NDArray

from app.motion.basics import Vector
from app.motion.snapshot import Trail
from app.scene.colours import Rgb
from app.scene.guard import finite_segments

Segments = NDArray[np.float32]

#: What an empty line is drawn as: viser's page wants at least one segment.
NOTHING: Segments = np.zeros((1, 2, 3), dtype=np.float32)
DASH_M = 0.035


@dataclass(frozen=True)
class Look:
    """How a trail is drawn. ``provisional`` is the colour of the newest stride, dashed."""

    colour: Rgb
    provisional: Rgb
    thickness: float  # screen pixels


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
    """One trail under ``/ned/trail/<name>``, moved aside by ``offset``."""

    def __init__(self, scene: viser.SceneApi, name: str, look: Look, offset: Vector) -> None:
        self._scene, self._look = scene, look
        self._root = scene.add_frame(f"/ned/trail/{name}", show_axes=False, position=offset)
        self._prefix = f"/ned/trail/{name}"
        self._pieces: dict[str, viser.LineSegmentsHandle] = {}
        self._made = 0
        self._growing = self._line("growing", NOTHING, look.colour)
        self._provisional = self._line("provisional", NOTHING, look.provisional)
        self._drawn: Trail | None = None

    def draw(self, trail: Trail) -> None:
        """Make the page show this trail; what is the same object as last time costs nothing."""
        last, self._drawn = self._drawn, trail
        if last is None or last.pieces is not trail.pieces:
            self._draw_pieces(trail)
        if last is None or last.growing is not trail.growing:
            self._show(self._growing, trail.growing)
        if last is None or last.provisional is not trail.provisional:
            self._show(self._provisional, dashes(finite_segments(trail.provisional)))

    def _draw_pieces(self, trail: Trail) -> None:
        wanted = {piece.key: piece for piece in trail.pieces}
        gone, new = changes(set(self._pieces), set(wanted))
        for key in gone:
            self._pieces.pop(key).remove()
        for key in sorted(new):
            self._made += 1
            segments = finite_segments(wanted[key].segments)
            self._pieces[key] = self._line(f"piece_{self._made}", segments, self._look.colour)

    def _line(self, name: str, segments: Segments, colour: Rgb) -> viser.LineSegmentsHandle:
        return self._scene.add_line_segments(
            f"{self._prefix}/{name}", segments if len(segments) else NOTHING, colour,
            thickness=self._look.thickness, thickness_units="screen",
        )  # fmt: skip

    def _show(self, line: viser.LineSegmentsHandle, segments: Segments) -> None:
        good = finite_segments(segments)
        line.points = good if len(good) else NOTHING

    def remove(self) -> None:
        """Take the whole trail off the page."""
        self._root.remove()
