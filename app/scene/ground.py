"""Edge, scene: metre grid, compass rose, start mark, light."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import viser
from numpy.typing import NDArray

from app.motion.basics import Vector
from app.scene.baked import linear, ribbons
from app.scene.colours import Rgb, blend, theme
from app.scene.glb import Part, glb, joined
from app.scene.shoe import SENSOR_HEIGHT_M

#: How far the bold lines go, and the others: far ones melt together, and cost more to draw than a shoe.
REACH_M, NEAR_M = 20, 10
BOLD_M, PIECE_M = 5, 5
#: A line of the grid is twice as wide at this distance from the walker.
WIDER_M = 3.0

#: Strokes of the letters on the floor, x right and y up, one unit high.
GLYPHS: dict[str, tuple[tuple[tuple[float, float], ...], ...]] = {
    "N": (((0, 0), (0, 1), (0.7, 0), (0.7, 1)),),
    "E": (((0.6, 0), (0, 0), (0, 1), (0.6, 1)), ((0, 0.5), (0.5, 0.5))),
    "S": (((0.65, 0.85), (0.5, 1), (0.15, 1), (0, 0.85), (0, 0.65), (0.15, 0.5), (0.5, 0.5), (0.65, 0.35),
           (0.65, 0.15), (0.5, 0), (0.15, 0), (0, 0.15)),),
    "W": (((0, 1), (0.2, 0), (0.45, 0.7), (0.7, 0), (0.9, 1)),),
    "m": (((0, 0), (0, 0.6)), ((0, 0.5), (0.12, 0.6), (0.28, 0.6), (0.38, 0.5), (0.38, 0)),
          ((0.38, 0.5), (0.5, 0.6), (0.66, 0.6), (0.76, 0.5), (0.76, 0))),
    "1": (((0.05, 0.8), (0.28, 1), (0.28, 0)),),
    "5": (((0.6, 1), (0.08, 1), (0.03, 0.56), (0.35, 0.62), (0.58, 0.48), (0.62, 0.25), (0.48, 0.04),
           (0.2, 0), (0, 0.13)),),
    "0": (((0.3, 0), (0.06, 0.15), (0, 0.5), (0.06, 0.85), (0.3, 1), (0.54, 0.85), (0.6, 0.5), (0.54, 0.15),
           (0.3, 0)),),
    "2": (((0.02, 0.8), (0.15, 0.97), (0.42, 0.98), (0.58, 0.8), (0.5, 0.55), (0, 0), (0.62, 0)),),
}  # fmt: skip


def strokes(text: str, middle: tuple[float, float], height_m: float) -> NDArray[np.float32]:
    """Line segments [k, 2, 3] in *n*, flat on the floor, that read as ``text`` seen from the south."""
    lines: list[list[tuple[float, float]]] = []
    width = 0.0
    for letter in text:
        if letter in GLYPHS:
            lines += [[(width + x, y - 0.5) for x, y in line] for line in GLYPHS[letter]]
            width += max(x for line in GLYPHS[letter] for x, _ in line)
        width += 0.25
    offset = 0.5 * (width - 0.25)
    pairs = [(a, b) for line in lines for a, b in pairwise(line)]
    flat = np.array([[(y, x - offset) for x, y in pair] for pair in pairs]) * height_m + np.array(middle)
    return on_floor(flat)


def on_floor(flat: NDArray[np.float64], above_m: float = 0.004) -> NDArray[np.float32]:
    """North and east [k, 2, 2] → points [k, 2, 3] just above the floor."""
    down = np.full((*flat.shape[:-1], 1), SENSOR_HEIGHT_M - above_m)
    return np.concatenate([flat, down], axis=-1).astype(np.float32)


def circle(radius_m: float, count: int = 48) -> NDArray[np.float64]:
    """A circle round the start as segments [count, 2, 2]."""
    angle = np.linspace(0, 2 * math.pi, count + 1)
    points = radius_m * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.stack([points[:-1], points[1:]], axis=1)


def ticks(inner_m: float, outer_m: float, every_deg: float) -> NDArray[np.float64]:
    """Short radial lines as segments [k, 2, 2]."""
    angle = np.radians(np.arange(0, 360, every_deg))
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.stack([inner_m * way, outer_m * way], axis=1)


def rose() -> NDArray[np.float32]:
    """The compass rose without its north: segments [k, 2, 3]."""
    letters = [("E", (0.0, 0.76)), ("S", (-0.76, 0.0)), ("W", (0.0, -0.76))]
    parts = [on_floor(circle(0.62)), on_floor(ticks(0.58, 0.62, 10)), on_floor(ticks(0.54, 0.62, 30)),
             on_floor(circle(0.05, 12)), *(strokes(letter, at, 0.12) for letter, at in letters)]  # fmt: skip
    return np.concatenate(parts)


def north() -> NDArray[np.float32]:
    """The rose's north: the letter and an arrow from the start."""
    arrow = np.array([[[0.05, 0.0], [0.5, 0.0]], [[0.5, 0.0], [0.43, 0.03]], [[0.5, 0.0], [0.43, -0.03]]])
    return np.concatenate([strokes("N", (0.78, 0.0), 0.15), on_floor(arrow)])


def ruler() -> NDArray[np.float32]:
    """Metre marks along the north line: how far the bold grid lines are."""
    return np.concatenate([strokes(f"{m} m", (m - 0.2, 0.4), 0.16) for m in (1, 2, 5, 10, 15, 20)])


def fading(segments: NDArray[np.float32], ink: Rgb, into: Rgb, reach_m: float) -> NDArray[np.float32]:
    """A linear colour for each end [k, 2, 3]: full in the middle, the sky's at ``reach_m``."""
    away = np.clip(distance(segments)[..., None] / reach_m, 0.0, 1.0)
    mixed: NDArray[np.float32] = (linear(ink) * (1.0 - away) + linear(into) * away).astype(np.float32)
    return mixed


def distance(segments: NDArray[np.float32]) -> NDArray[np.float32]:
    """How far from the middle each end [k, 2] is, m."""
    away: NDArray[np.float32] = np.linalg.norm(segments[..., :2], axis=-1)
    return away


def grid(every_m: int, reach_m: int, but_not_m: int | None = None) -> NDArray[np.float32]:
    """Lines north and east through a disc round the walker, in pieces that can fade: [k, 2, 3]."""
    lines = []
    for across in range(-reach_m, reach_m + 1, every_m):
        if but_not_m is not None and across % but_not_m == 0:
            continue
        half = math.sqrt(reach_m**2 - across**2)
        along = np.linspace(-half, half, max(2, 2 * round(half / PIECE_M) + 1))
        line = np.stack([along, np.full(len(along), float(across))], axis=1)
        pieces = np.stack([line[:-1], line[1:]], axis=1)
        lines += [pieces, pieces[..., ::-1]]
    return on_floor(np.concatenate(lines), above_m=0.0)


class Ground:
    """All that never moves, under ``/ned``; only the grid comes along, by whole bold squares.

    Light to draw on a tablet or without a graphics card: flat strips in plain colours, no shader over the
    whole floor, no shadow maps, no environment map. The sky is the page's own style.
    """

    def __init__(self, scene: viser.SceneApi, dark: bool) -> None:
        self._scene = scene
        self._at = (0.0, 0.0, 0.0)
        self._frame = scene.add_frame("/ned/ground", show_axes=False)
        scene.configure_default_lights(True, cast_shadow=False)
        scene.configure_environment_map(None)
        self.recolour(dark)

    def recolour(self, dark: bool) -> None:
        """Draw it in the theme's colours."""
        colours = theme(dark)
        self._lay("/ned/ground/grid", [
            fading_lines("metres", grid(1, NEAR_M, BOLD_M), colours.cell, colours.horizon, NEAR_M, 0.004),
            fading_lines("bold", grid(BOLD_M, REACH_M), colours.section, colours.horizon, REACH_M, 0.006),
        ])  # fmt: skip
        self._lay("/ned/compass", [
            lines("rose", rose(), colours.ink, 0.007), lines("north", north(), colours.accent, 0.011),
            lines("ruler", ruler(), blend(colours.ink, colours.horizon, 0.3), 0.010),
        ])  # fmt: skip

    def reach(self, centre: Vector) -> None:
        """Keep the grid round the walker; its lines stay on whole metres."""
        north_m, east_m = (BOLD_M * round(c / BOLD_M) for c in centre[:2])
        at = (float(north_m), float(east_m), 0.0)
        if at != self._at:
            self._at = at
            self._frame.position = at

    def _lay(self, name: str, parts: list[Part]) -> None:
        self._scene.add_glb(name, glb([joined("lines", parts)]), cast_shadow=False, receive_shadow=False)


def lines(name: str, segments: NDArray[np.float32], ink: Rgb, width_m: float) -> Part:
    """Segments as strips on the floor in one colour."""
    vertices, faces = ribbons(segments, width_m)
    return Part(name, vertices, faces, np.tile(linear(ink), (len(vertices), 1)), open=True)


def fading_lines(
    name: str, segments: NDArray[np.float32], ink: Rgb, into: Rgb, reach_m: float, width_m: float
) -> Part:
    """The same, fading into the sky; wider far away, where a strip would else be less than a point wide."""
    vertices, faces = ribbons(segments, width_m * (1.0 + distance(segments) / WIDER_M))
    colours = np.repeat(fading(segments, ink, into, reach_m), 2, axis=1).reshape(-1, 3)
    return Part(name, vertices, faces, colours, open=True)
