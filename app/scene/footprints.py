"""Edge, scene: footprints: one mesh of all prints on the floor, numbers over the newest."""

from __future__ import annotations

import math

import numpy as np
import viser
from numpy.typing import NDArray

from app.motion.basics import Role, Vector
from app.motion.snapshot import Footprint
from app.scene.colours import FOOT, Rgb, blend, shade
from app.scene.guard import FAR_M
from app.scene.shoe import SENSOR_HEIGHT_M, sole

PRINTS = 40  # drawn at most: 18 kB a stride
NUMBERED = 8
PALE: Rgb = (120, 130, 142)
ABOVE_FLOOR_M = 0.003


def placed(outline: NDArray[np.float32], foot: Footprint) -> NDArray[np.float32]:
    """The sole's outline [n, 3] where this print is, in *n*."""
    cos, sin = math.cos(foot.heading_rad), math.sin(foot.heading_rad)
    x, y = outline[:, 0], outline[:, 1]
    north, east, down = foot.position_n
    level = np.full(len(outline), down + SENSOR_HEIGHT_M - ABOVE_FLOOR_M)
    return np.stack([north + cos * x - sin * y, east + sin * x + cos * y, level], axis=1).astype(np.float32)


def finite(foot: Footprint) -> bool:
    """Whether it can be drawn."""
    return all(abs(v) < FAR_M for v in foot.position_n) and math.isfinite(foot.heading_rad)


class Footprints:
    """The prints of one foot, in a frame moved aside by ``offset``."""

    def __init__(self, scene: viser.SceneApi, name: str, role: Role, offset: Vector) -> None:
        self._root = scene.add_frame(f"/ned/prints/{name}", show_axes=False, position=offset)
        self._outline, fan = sole(role is Role.LEFT)
        faces = np.concatenate([fan + i * len(self._outline) for i in range(PRINTS)])
        self._soles = scene.add_mesh_simple(
            f"/ned/prints/{name}/soles", np.zeros((PRINTS * len(self._outline), 3)), faces,
            color=shade(blend(FOOT[role], PALE, 0.3), 0.8), side="double", cast_shadow=False,
            flat_shading=True,
        )  # fmt: skip
        self._labels = [self._label(scene, f"/ned/prints/{name}/number_{i}") for i in range(NUMBERED)]
        self._drawn: tuple[Footprint, ...] = ()

    def draw(self, footprints: tuple[Footprint, ...]) -> None:
        """Make the page show the newest of these."""
        if footprints is self._drawn or footprints == self._drawn:
            return
        self._drawn = footprints
        newest = [f for f in footprints if finite(f)][-PRINTS:]
        self._draw_soles(newest)
        for i, label in enumerate(self._labels):
            self._draw_number(label, newest[-1 - i] if i < len(newest) else None)

    def _draw_soles(self, prints: list[Footprint]) -> None:
        """Always as many triangles: those of no print are points where the last one is."""
        drawn = [placed(self._outline, foot) for foot in prints]
        point = drawn[-1][:1] if drawn else np.zeros((1, 3), np.float32)
        rest = np.tile(point, ((PRINTS - len(drawn)) * len(self._outline), 1))
        self._soles.vertices = np.concatenate([*drawn, rest])

    def _label(self, scene: viser.SceneApi, name: str) -> viser.LabelHandle:
        return scene.add_label(
            name, "", visible=False, anchor="center-center", font_size_mode="screen", font_screen_scale=0.85
        )

    def _draw_number(self, label: viser.LabelHandle, foot: Footprint | None) -> None:
        label.visible = foot is not None
        if foot is not None:
            north, east, down = foot.position_n
            label.text = str(foot.number)
            label.position = (north, east, down + SENSOR_HEIGHT_M - 0.01)

    def remove(self) -> None:
        """Take them off the page."""
        self._root.remove()
