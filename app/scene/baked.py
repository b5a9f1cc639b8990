"""Edge, scene: meshes whose light is painted on, by which way each face looks, and flat lines. Pure.

viser's lit material looks up the environment map at every point of the screen that it covers: without a
graphics card one shoe then costs more than the rest of the page. What is painted on costs nothing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.scene.colours import Rgb

Floats = NDArray[np.float32]
Faces = NDArray[np.uint32]

#: Where light comes from in the shoe's axes (toe, right, down): the sky above, a lamp ahead to the right.
SKY, LAMP = (0.0, 0.0, -1.0), (0.55, 0.45, -0.70)
#: How much of a colour is left where no light falls, and what each light adds.
SHADE, BY_SKY, BY_LAMP = 0.46, 0.30, 0.34


def linear(colour: Rgb) -> Floats:
    """An sRGB colour, 0 to 255, as linear light [3], 0 to 1 (IEC 61966-2-1)."""
    c = np.array(colour, dtype=np.float64) / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4).astype(np.float32)


def normals(vertices: Floats, faces: Faces) -> Floats:
    """The way out at each vertex [n, 3], unit: the mean of the faces around it by their size."""
    a, b, c = (vertices[faces[:, i]].astype(np.float64) for i in range(3))
    out = np.cross(b - a, c - a)
    total = np.zeros((len(vertices), 3))
    for i in range(3):
        np.add.at(total, faces[:, i], out)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return (total / np.where(length > 0.0, length, 1.0)).astype(np.float32)


def lit(vertices: Floats, faces: Faces, colour: Rgb) -> Floats:
    """The linear colour [n, 3] of each vertex of a mesh in this colour, under the sky and the lamp."""
    out = normals(vertices, faces)
    lamp = np.array(LAMP) / np.linalg.norm(LAMP)
    light = SHADE + BY_SKY * (0.5 + 0.5 * out @ np.array(SKY)) + BY_LAMP * np.maximum(out @ lamp, 0.0)
    painted: Floats = (light[:, None] * linear(colour)).astype(np.float32)
    return painted


def apart(vertices: Floats, faces: Faces) -> tuple[Floats, Faces]:
    """The same mesh with three vertices of its own for each face, so that its edges stay sharp."""
    return vertices[faces.ravel()], np.arange(faces.size, dtype=np.uint32).reshape(-1, 3)


def ribbons(segments: Floats, width_m: float | Floats) -> tuple[Floats, Faces]:
    """Segments [k, 2, 3] that lie level, as flat strips: vertices [4 k, 3] and faces [2 k, 3].

    ``width_m``: of all, or of each end [k, 2]. Each strip is longer by half its width at both ends, so that
    strokes meet in corners. An end keeps its order: vertices 4 i and 4 i + 1 are the first end of segment i.
    """
    way = segments[:, 1, :2] - segments[:, 0, :2]
    length = np.linalg.norm(way, axis=1, keepdims=True)
    way = way / np.where(length > 0.0, length, 1.0)
    half = 0.5 * np.broadcast_to(np.asarray(width_m, np.float32), segments.shape[:2])[..., None]
    side = np.stack([-way[:, 1], way[:, 0]], axis=1)[:, None] * half
    ahead = np.stack([-way, way], axis=1) * half
    corners = np.repeat(segments[:, :, None], 2, axis=2)  # [segment, end, side, 3]
    corners[..., :2] += np.stack([side, -side], axis=2) + ahead[:, :, None]
    first = 4 * np.arange(len(segments), dtype=np.uint32)[:, None]
    faces = np.concatenate([first + (0, 1, 2), first + (1, 3, 2)], axis=1).reshape(-1, 3)
    return corners.reshape(-1, 3).astype(np.float32), faces.astype(np.uint32)
