"""Edge, scene: footprints on the floor, a mesh for every few, numbers over the newest.

Plain colours, no light: viser's lit mesh costs much more to draw without a graphics card.
"""

from __future__ import annotations

import math

import numpy as np
import viser
from numpy.typing import NDArray

from app.motion.basics import Role, Vector
from app.motion.snapshot import Footprint
from app.scene.baked import linear
from app.scene.colours import FOOT, Rgb, blend, shade
from app.scene.glb import Part, glb
from app.scene.guard import FAR_M
from app.scene.meshes import BOTH_S, Clock, Meshes
from app.scene.shoe import SENSOR_HEIGHT_M, sole

PRINTS = 40  # drawn at most
GROUP = 8  # in a mesh: a stride sends no more than these again
NUMBERED = 8
PALE: Rgb = (120, 130, 142)
PRINT_SHADE = 0.8
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


def grouped(prints: list[Footprint]) -> dict[int, tuple[Footprint, ...]]:
    """Those that share a mesh, by their strides' numbers."""
    keys = sorted({foot.number // GROUP for foot in prints})
    return {key: tuple(foot for foot in prints if foot.number // GROUP == key) for key in keys}


def same(shown: tuple[Footprint, ...], wanted: tuple[Footprint, ...]) -> bool:
    """Whether a mesh may stay: the oldest are not taken away one by one."""
    return bool(wanted) and shown[-len(wanted) :] == wanted


def printed(prints: tuple[Footprint, ...], role: Role) -> bytes:
    """These prints as one mesh, binary glTF."""
    outline, fan = sole(role is Role.LEFT)
    vertices = np.concatenate([placed(outline, foot) for foot in prints])
    faces = np.concatenate([fan + np.uint32(i * len(outline)) for i in range(len(prints))])
    ink = linear(shade(blend(FOOT[role], PALE, 0.3), PRINT_SHADE))
    return glb([Part("soles", vertices, faces, np.tile(ink, (len(vertices), 1)), open=True)])


class Footprints:
    """The prints of one foot, in a frame moved aside by ``offset``."""

    def __init__(self, scene: viser.SceneApi, name: str, role: Role, offset: Vector, now: Clock) -> None:
        self._name, self._role = f"/ned/prints/{name}", role
        self._root = scene.add_frame(self._name, show_axes=False, position=offset)
        self._groups: dict[int, tuple[Footprint, ...]] = {}
        self._meshes = Meshes(scene, f"{self._name}/soles", BOTH_S, now)
        self._labels = [self._label(scene, f"{self._name}/number_{i}") for i in range(NUMBERED)]
        self._drawn: tuple[Footprint, ...] = ()

    def draw(self, footprints: tuple[Footprint, ...]) -> None:
        """Make the page show the newest of these."""
        self._meshes.tidy()
        if footprints is self._drawn or footprints == self._drawn:
            return
        self._drawn = footprints
        newest = [f for f in footprints if finite(f)][-PRINTS:]
        self._draw_groups(newest)
        for i, label in enumerate(self._labels):
            self._draw_number(label, newest[-1 - i] if i < len(newest) else None)

    def _draw_groups(self, prints: list[Footprint]) -> None:
        """Send again only the groups in which something is new."""
        wanted = grouped(prints)
        gone = [key for key, shown in self._groups.items() if not same(shown, wanted.get(key, ()))]
        for key in gone:
            del self._groups[key]
            self._meshes.drop(key)
        for key in wanted.keys() - self._groups.keys():
            self._meshes.put(key, printed(wanted[key], self._role))
            self._groups[key] = wanted[key]

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
