"""Tool, town: faces with colours in batches; light is baked in when all of them stand.

Metres; x east, y north, z up. A face has corners counter-clockwise from outside. Colours are linear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import trimesh
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Rgb = tuple[float, float, float]
Point = tuple[float, float, float]


def linear(text: str) -> Rgb:
    """``#rrggbb`` as linear light."""
    srgb = np.array([int(text[i : i + 2], 16) / 255.0 for i in (1, 3, 5)])
    r, g, b = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4).tolist()
    return r, g, b


def mix(one: Rgb, other: Rgb, part: float) -> Rgb:
    """From ``one`` (0) to ``other`` (1)."""
    a, b, c = ((1.0 - part) * x + part * y for x, y in zip(one, other, strict=True))
    return a, b, c


def times(colour: Rgb, factor: float) -> Rgb:
    """Brighter or darker."""
    r, g, b = (factor * c for c in colour)
    return r, g, b


@dataclass
class Batch:
    """Vertices that become one draw call. ``lit_at`` is where each one's light is looked for."""

    places: list[Floats] = field(default_factory=list)
    normals: list[Floats] = field(default_factory=list)
    colours: list[Floats] = field(default_factory=list)
    lit_at: list[Floats] = field(default_factory=list)
    shine: list[Floats] = field(default_factory=list)  # 1: takes light, 0: has its own
    faces: list[NDArray[np.int64]] = field(default_factory=list)
    count: int = 0

    def quad(
        self, corners: Sequence[Point], colour: Rgb | Sequence[Rgb], out_m: float = 0.05,
        own_light: bool = False, normal: Point | None = None,
    ) -> None:  # fmt: skip
        """Four corners; one colour or one each. Light is taken ``out_m`` in front of the face."""
        at = np.array(corners, dtype=np.float64)
        turned = np.cross(at[1] - at[0], at[3] - at[0])
        if np.linalg.norm(turned) < 1e-12:
            turned = np.cross(at[2] - at[1], at[3] - at[1])
        facing = turned / np.linalg.norm(turned)
        toward = facing if normal is None else np.array(normal)
        paint = np.array(colour if isinstance(colour[0], Sequence) else [colour] * 4, dtype=np.float64)
        self._add(at, np.tile(toward, (4, 1)), paint, at + out_m * toward, own_light, [[0, 1, 2], [0, 2, 3]])

    def box(self, low: Point, high: Point, colour: Rgb, top: Rgb | None = None, floor: bool = False) -> None:
        """An upright box without (or with) its underside."""
        (a, b, c), (d, e, f) = low, high
        self.quad([(a, b, c), (d, b, c), (d, b, f), (a, b, f)], colour)
        self.quad([(d, e, c), (a, e, c), (a, e, f), (d, e, f)], colour)
        self.quad([(d, b, c), (d, e, c), (d, e, f), (d, b, f)], colour)
        self.quad([(a, e, c), (a, b, c), (a, b, f), (a, e, f)], colour)
        self.quad([(a, b, f), (d, b, f), (d, e, f), (a, e, f)], top or colour)
        if floor:
            self.quad([(a, e, c), (d, e, c), (d, b, c), (a, b, c)], colour)

    def mesh(
        self, shape: trimesh.Trimesh, colour: Rgb | Floats, soft: bool = True, out_m: float = 0.1
    ) -> None:
        """Any mesh: soft shares vertices and their normals, hard has flat faces."""
        if not soft:
            shape = trimesh.Trimesh(
                shape.vertices[shape.faces].reshape(-1, 3), np.arange(3 * len(shape.faces)).reshape(-1, 3),
                process=False,
            )  # fmt: skip
        at, normals = np.asarray(shape.vertices), np.asarray(shape.vertex_normals)
        paint = np.broadcast_to(np.asarray(colour, dtype=np.float64), at.shape)
        self._add(at, normals, paint, at + out_m * normals, False, shape.faces)

    def _add(
        self, at: Floats, normals: Floats, paint: Floats, lit_at: Floats, own_light: bool, faces: object
    ) -> None:
        self.places.append(at)
        self.normals.append(normals)
        self.colours.append(np.array(paint))
        self.lit_at.append(lit_at)
        self.shine.append(np.full(len(at), 0.0 if own_light else 1.0))
        self.faces.append(np.asarray(faces, dtype=np.int64) + self.count)
        self.count += len(at)
