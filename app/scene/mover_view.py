"""Edge, scene: where the world stands so that a walker sees it, and the light that marks a target. Pure."""

from __future__ import annotations

import math

import numpy as np

from app.motion.basics import Quaternion, Vector
from app.rotation import multiply
from app.scene.follow import NED_WXYZ
from app.scene.glb import Part, glb

BEACON_M = 7.0
_GOLD = (1.0, 0.72, 0.16)


def in_view(north: float, east: float, heading_rad: float, eye_m: float) -> tuple[Quaternion, Vector]:
    """The pose of ``/world`` for a camera that stays at viser's origin and looks along its y.

    The world turns and moves the other way: R = R_camᵀ, t = −R_camᵀ p (viser is x east, y north, z up).
    """
    turn: Quaternion = (math.cos(0.5 * heading_rad), 0.0, 0.0, math.sin(0.5 * heading_rad))
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    return multiply(turn, NED_WXYZ), (-(c * east - s * north), -(s * east + c * north), -eye_m)


def beacon(radius_m: float, sections: int = 40) -> bytes:
    """A ring on the ground, a column of light that fades upwards, a turned square on top: in *n*."""
    turn = np.linspace(0.0, 2.0 * np.pi, sections + 1)
    rim = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
    levels = [
        (radius_m, -0.16, 0.0),
        (radius_m, -0.2, 0.5),
        (radius_m, -1.2, 0.2),
        (radius_m, -BEACON_M, 0.0),
    ]
    column = _rings(rim, levels, "column")
    ring = _rings(rim, [(radius_m - 0.28, -0.16, 0.75), (radius_m, -0.16, 0.95)], "ring")
    disc = _rings(rim, [(0.01, -0.15, 0.12), (radius_m, -0.15, 0.3)], "disc")
    return glb([column, ring, disc, _gem()])


def _rings(rim: np.ndarray, levels: list[tuple[float, float, float]], name: str) -> Part:
    """Circles of (radius, down, opacity) joined one to the next."""
    count = len(rim)
    vertices = np.concatenate([rim * [r, r, 0.0] + [0.0, 0.0, down] for r, down, _ in levels])
    colours = np.concatenate([np.tile([*_GOLD, clear], (count, 1)) for *_, clear in levels])
    faces = []
    for level in range(len(levels) - 1):
        for i in range(count - 1):
            a, b = level * count + i, (level + 1) * count + i
            faces += [[a, a + 1, b], [a + 1, b + 1, b]]
    return Part(
        name, vertices.astype(np.float32), np.array(faces, np.uint32), colours.astype(np.float32), clear=True
    )


def _gem() -> Part:
    """An octahedron above the column, each of its sides in its own shade."""
    way = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], dtype=np.float64) * 0.42
    vertices, colours = [], []
    for i in range(4):
        for tip, shade in ((-0.62, 1.0), (0.62, 0.72)):
            corners = [way[i], way[(i + 1) % 4], np.array([0.0, 0.0, tip])]
            vertices += corners if tip > 0.0 else corners[::-1]
            colours += [[*(shade * (1.0 - 0.1 * (i % 2)) * c for c in _GOLD), 1.0]] * 3
    at = np.array(vertices) + [0.0, 0.0, -3.1]
    return Part("gem", at.astype(np.float32), np.arange(24, dtype=np.uint32).reshape(-1, 3),
                np.array(colours, np.float32), clear=True)  # fmt: skip
