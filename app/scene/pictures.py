"""Edge, scene: pictures of a sensor's poses, drawn as boxes with their axes, as SVG."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Half sizes of the box along toe, right and sole.
HALF = np.array([1.5, 0.9, 0.45])
COLOURS = ("#d55e00", "#009e73", "#0072b2")
#: Where body x, y, z point in the room (north, east, down) for each pose.
POSES: dict[str, tuple[tuple[float, ...], ...]] = {
    "z+": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "z-": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
    "y+": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "y-": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "x-": ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
    "x+": ((0, 0, 1), (0, 1, 0), (-1, 0, 0)),
    "y*": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "x*": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
}
FACES = (((0, 1, 2), 1), ((0, 1, 2), -1), ((1, 2, 0), 1), ((1, 2, 0), -1), ((2, 0, 1), 1), ((2, 0, 1), -1))
_NAMES = {"z+": "flat, z down", "z-": "on its back, z up", "y+": "y down", "y-": "y up", "x+": "x down",
          "x-": "x up", "y*": "a round about y", "x*": "a round about x"}  # fmt: skip


def pose(name: str) -> str:
    """The picture of a pose; a round has a curved arrow and the way to north."""
    axes = np.array(POSES.get(name, POSES["z+"]), float)
    shapes = [_face(axes, face, side) for face, side in sorted(FACES, key=lambda f: _depth(axes, *f))]
    shapes += [_axis(axes[i], i) for i in range(3)]
    extra = _round(axes["xyz".index(name[0])]) if name.endswith("*") else ""
    table = '<polygon class="ss-table-top" points="-92,30 20,86 92,44 -18,-8"/>'
    floor = "" if name.endswith("*") else table
    label = _NAMES.get(name, "")
    return (
        f'<svg class="ss-pose" viewBox="-100 -78 200 168" role="img" aria-label="{label}">'
        f"{floor}{''.join(shapes)}{extra}</svg>"
    )


def _seen(point: Array) -> tuple[float, float]:
    """A point (north, east, down) on the paper: looked at from the south-east and above."""
    north, east, down = point
    return 26.0 * (east * 0.9 - north * 0.62) + 26.0 * north * 1.24, 26.0 * (
        down - 0.55 * north + 0.28 * east
    )


def _depth(axes: Array, face: tuple[int, int, int], side: int) -> float:
    normal = axes[face[0]] * side
    return float(normal @ np.array([-0.5, 0.45, -0.75]))


def _face(axes: Array, face: tuple[int, int, int], side: int) -> str:
    i, j, k = face
    corners = [
        axes[i] * HALF[i] * side + axes[j] * HALF[j] * a + axes[k] * HALF[k] * b
        for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))
    ]
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(_seen, corners))
    lit = 0.35 + 0.25 * (1.0 - float((axes[i] * side)[2])) / 2.0 + 0.2 * abs(float((axes[i] * side)[1]))
    return f'<polygon points="{points}" style="fill:rgba(120,140,165,{lit:.2f})" class="ss-side"/>'


def _axis(direction: Array, index: int) -> str:
    x, y = _seen(direction * (HALF[index] + 0.9))
    x0, y0 = _seen(direction * HALF[index])
    tip_x, tip_y = _seen(direction * (HALF[index] + 1.25))
    colour, letter = COLOURS[index], "xyz"[index]
    return (
        f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x:.1f}" y2="{y:.1f}" stroke="{colour}" stroke-width="3.5"/>'
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{colour}"/>'
        f'<text x="{tip_x:.1f}" y="{tip_y + 4:.1f}" fill="{colour}">{letter}</text>'
    )


def _round(axis: Array) -> str:
    """A circle about an axis with an arrow head."""
    other = np.cross(axis, [0.0, 0.0, 1.0])
    third = np.cross(axis, other)
    angles = np.radians(np.arange(20, 321, 10))
    path = [_seen(2.0 * (math.cos(a) * other + math.sin(a) * third)) for a in angles]
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in path)
    (x0, y0), (x1, y1) = path[-2], path[-1]
    turn = math.degrees(math.atan2(y1 - y0, x1 - x0))
    return (
        f'<polyline points="{points}" class="ss-round"/>'
        f'<polygon points="9,0 -4,-6 -4,6" class="ss-head-of-arrow" '
        f'transform="translate({x1:.1f},{y1:.1f}) rotate({turn:.0f})"/>'
    )


def sky(directions: frozenset[int], bands: int = 6, sectors: int = 12) -> str:
    """Which directions of the field were seen: two discs, the upper and the lower half of all directions."""
    rings = bands // 2
    discs = []
    for half, name in enumerate(("upper", "lower")):
        for ring in range(rings):
            band = ring if half == 0 else bands - 1 - ring
            discs += [
                _cell(half, ring, sector, sectors, band * sectors + sector in directions, rings)
                for sector in range(sectors)
            ]
        discs.append(f'<text x="{-48 + 96 * half}" y="56">{name} half</text>')
    return f'<svg class="ss-sky" viewBox="-98 -44 196 104" role="img">{"".join(discs)}</svg>'


def _cell(half: int, ring: int, sector: int, sectors: int, seen: bool, rings: int) -> str:
    inner, outer = 40.0 * math.sqrt(ring / rings), 40.0 * math.sqrt((ring + 1) / rings)
    a, b = math.tau * sector / sectors, math.tau * (sector + 1) / sectors
    x, y = -48.0 + 96.0 * half, 0.0
    corners = [(inner, a), (outer, a), (outer, b), (inner, b)]
    points = " ".join(f"{x + r * math.cos(t):.1f},{y + r * math.sin(t):.1f}" for r, t in corners)
    return f'<polygon points="{points}" class="{"ss-seen" if seen else "ss-unseen"}"/>'
