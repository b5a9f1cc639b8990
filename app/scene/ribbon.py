"""Edge, scene: a path as a flat ribbon: the lightest thing that can be drawn of a trail. Pure.

viser's lines are six triangles a segment in a costly shader: without a graphics card they take four times as
long to draw. A ribbon's edges are lines of one pixel, so that it is seen from the side; far away the page's
script makes it broader.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.scene.baked import linear
from app.scene.colours import Rgb
from app.scene.glb import Part, glb, joined

Floats = NDArray[np.float32]

#: How broad a ribbon is beside a line of as many pixels: as that line looks where the page shows the shoe.
WIDTH_M = 0.0025
#: Segments in one mesh: of a long way what is out of view is not drawn.
STRETCH = 512
#: What a byte can tell of a width, in pixels.
MOST_PIXELS = 16.0
HERE = Path(__file__).parent


def script() -> str:
    """What a page runs so that ribbons stay as broad as lines however far away they are seen."""
    text = (HERE / "ribbons.js").read_text(encoding="utf-8")
    return text.replace("HALF_M", f"{0.5 * WIDTH_M:f}").replace("MOST_PIXELS", f"{MOST_PIXELS:f}")


def ribbon(segments: Floats, colour: Rgb, pixels: float) -> bytes:
    """Segments [k, 2, 3] in *n*, at least one, as binary glTF; ``pixels``: of the line that it stands for."""
    stretches = np.split(segments, range(STRETCH, len(segments), STRETCH))
    paint = linear(colour)[None]
    return glb([_stretch(f"ribbon_{i}", part, paint, pixels) for i, part in enumerate(stretches)])


def _stretch(name: str, segments: Floats, paint: Floats, pixels: float) -> Part:
    """Part of the way as one mesh, also where the pen was up."""
    ends = np.flatnonzero((segments[1:, 0] != segments[:-1, 1]).any(axis=1)) + 1
    return joined(name, [_chain(chain, paint, pixels) for chain in np.split(segments, ends)])


def _chain(chain: Floats, paint: Floats, pixels: float) -> Part:
    """Segments that hang together."""
    points = np.concatenate([chain[:, 0], chain[-1:, 1]])
    across = sides(points)
    side = np.stack([-across, across], axis=1).reshape(-1, 3)
    vertices = (np.repeat(points, 2, axis=0) + 0.5 * WIDTH_M * pixels * side).astype(np.float32)
    told = np.pad(side, ((0, 0), (0, 1)), constant_values=pixels / MOST_PIXELS)
    left = 2 * np.arange(len(chain), dtype=np.uint32)[:, None]
    faces = np.concatenate([left + (0, 1, 2), left + (1, 3, 2)], axis=1).reshape(-1, 3)
    lines = np.concatenate([left + (0, 2), left + (1, 3)])
    return Part(
        "chain", vertices, faces.astype(np.uint32), paint, open=True, lines=lines.astype(np.uint32),
        sides=np.rint(127.0 * told).astype(np.int8),
    )  # fmt: skip


def sides(points: Floats) -> Floats:
    """For each point of a path [n, 3] the level unit vector across it [n, 3].

    Where it goes straight up or down it is that of the point before. It never turns over, or the ribbon
    would be twisted.
    """
    way = np.gradient(points[:, :2].astype(np.float64), axis=0)
    length = np.linalg.norm(way, axis=1)
    level = np.flatnonzero(length > 1e-6)
    if not len(level):
        return np.tile(np.array([0.0, 1.0, 0.0], np.float32), (len(points), 1))
    nearest = level[np.maximum(np.searchsorted(level, np.arange(len(points)), side="right") - 1, 0)]
    across = np.stack([-way[:, 1], way[:, 0]], axis=1)[nearest] / length[nearest, None]
    turned = (across[1:] * across[:-1]).sum(axis=1) < 0.0
    across[1:] *= np.where(np.cumsum(turned) % 2, -1.0, 1.0)[:, None]
    return np.pad(across, ((0, 0), (0, 1))).astype(np.float32)
