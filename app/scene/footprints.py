"""Edge, scene: footprints: one batch of prints on the floor, numbers over the newest."""

from __future__ import annotations

import math

import numpy as np
import viser

from app.motion import Footprint, Role, Vector
from app.scene.colours import FOOT, Rgb, blend, linear
from app.scene.guard import FAR_M
from app.scene.shoe import SENSOR_HEIGHT_M, sole

PRINTS = 64  # drawn at most; a fixed batch, since its arrays are sent together
NUMBERED = 8
PALE: Rgb = (128, 138, 150)


def number_step(count: int) -> int:
    """How many of the newest prints carry a number."""
    return min(count, NUMBERED)


class Footprints:
    """The prints of one foot, under the trail's frame so that they share its offset."""

    def __init__(self, scene: viser.SceneApi, name: str, role: Role, offset: Vector) -> None:
        self._root = scene.add_frame(f"/ned/prints/{name}", show_axes=False, position=offset)
        vertices, faces = sole(role is Role.LEFT)
        self._batch = scene.add_batched_meshes_simple(
            f"/ned/prints/{name}/soles", vertices, faces, batched_wxyzs=np.tile([1.0, 0, 0, 0], (PRINTS, 1)),
            batched_positions=np.zeros((PRINTS, 3)), batched_scales=np.zeros(PRINTS),
            batched_colors=linear(blend(FOOT[role], PALE, 0.35)), side="double", cast_shadow=False, receive_shadow=False, lod="off",
        )  # fmt: skip
        self._labels = [
            scene.add_label(
                f"/ned/prints/{name}/number_{i}", "", visible=False, anchor="center-center",
                font_size_mode="screen", font_screen_scale=0.85,
            )
            for i in range(NUMBERED)
        ]  # fmt: skip
        self._drawn: tuple[Footprint, ...] = ()

    def draw(self, footprints: tuple[Footprint, ...]) -> None:
        """Make the page show the newest of these."""
        if footprints is self._drawn or footprints == self._drawn:
            return
        self._drawn = footprints
        newest = [f for f in footprints if _finite(f)][-PRINTS:]
        self._draw_soles(newest)
        for i, label in enumerate(self._labels):
            self._draw_number(label, newest[-1 - i] if i < number_step(len(newest)) else None)

    def _draw_soles(self, prints: list[Footprint]) -> None:
        wxyzs = np.tile(np.array([1, 0, 0, 0], np.float32), (PRINTS, 1))
        positions, scales = np.zeros((PRINTS, 3), np.float32), np.zeros(PRINTS, np.float32)
        for i, foot in enumerate(prints):
            wxyzs[i] = (math.cos(0.5 * foot.heading_rad), 0.0, 0.0, math.sin(0.5 * foot.heading_rad))
            north, east, down = foot.position_n
            positions[i] = (north, east, down + SENSOR_HEIGHT_M - 0.003)
            scales[i] = 1.0
        self._batch.batched_wxyzs = wxyzs
        self._batch.batched_positions = positions
        self._batch.batched_scales = scales

    def _draw_number(self, label: viser.LabelHandle, foot: Footprint | None) -> None:
        label.visible = foot is not None
        if foot is not None:
            north, east, down = foot.position_n
            label.text = str(foot.number)
            label.position = (north, east, down + SENSOR_HEIGHT_M - 0.01)

    def remove(self) -> None:
        """Take them off the page."""
        self._root.remove()


def _finite(foot: Footprint) -> bool:
    return all(abs(v) < FAR_M for v in foot.position_n) and math.isfinite(foot.heading_rad)
