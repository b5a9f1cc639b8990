"""Tool: models the shoe and writes assets/shoe.npz, the right one, part by part.

The page reads plain arrays, because loading trimesh would double its start.

Run ``python tools/make_shoe.py [PATH]``. Axes are the shoe's (x toe, y right, z down) with the
origin in the sensor on the instep, metres. Each part is one named geometry, so that the scene can
colour it; the left shoe is the mirror image. Widths and heights are read off a running shoe, EU 42.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

Floats = NDArray[np.float64]

LENGTH_M = 0.295
SENSOR_M = (0.158, 0.0, 0.112)  # forward of the heel, right of the middle, above the floor
PATH = Path(__file__).resolve().parents[1] / "assets" / "shoe.npz"


def curve(*points: tuple[float, float]) -> PchipInterpolator:
    """A smooth curve through (fraction of the length, metres)."""
    x, y = zip(*points, strict=True)
    return PchipInterpolator(x, y)


LATERAL = curve(
    (0, 0.001), (0.004, 0.009), (0.012, 0.0155), (0.03, 0.0225), (0.1, 0.031), (0.2, 0.034), (0.35, 0.035),
    (0.5, 0.040), (0.65, 0.048), (0.75, 0.049), (0.86, 0.041), (0.94, 0.024), (0.985, 0.008), (1, -0.004),
)  # fmt: skip
MEDIAL = curve(
    (0, -0.001), (0.004, 0.008), (0.012, 0.015), (0.03, 0.0220), (0.1, 0.031), (0.2, 0.032), (0.35, 0.029),
    (0.5, 0.031), (0.65, 0.041), (0.75, 0.046), (0.86, 0.044), (0.94, 0.033), (0.985, 0.017), (1, 0.004),
)  # fmt: skip
BOTTOM = curve((0, 0.007), (0.08, 0.001), (0.18, 0), (0.68, 0), (0.82, 0.004), (0.93, 0.013), (1, 0.022))
MIDSOLE_TOP = curve((0, 0.036), (0.25, 0.034), (0.5, 0.030), (0.75, 0.028), (0.9, 0.031), (1, 0.037))
UPPER_TOP = curve(
    (0, 0.086), (0.025, 0.099), (0.07, 0.104), (0.2, 0.108), (0.38, 0.114), (0.46, 0.111), (0.6, 0.094),
    (0.74, 0.075), (0.86, 0.064), (0.94, 0.056), (0.985, 0.046), (1, 0.038),
)  # fmt: skip
OPENING = curve(
    (0, 0), (0.03, 0), (0.045, 0.55), (0.11, 0.97), (0.25, 1.1), (0.34, 0.98), (0.41, 0.55), (0.435, 0),
    (1, 0),
)  # fmt: skip


def stations(count: int, start: float = 0.0, stop: float = 1.0) -> Floats:
    """Fractions of the length, closer together at heel and toe."""
    turn = np.linspace(np.arccos(1 - 2 * start), np.arccos(1 - 2 * stop), count)
    return 0.5 * (1 - np.cos(turn))


def strip(grid: Floats, closed: bool = False) -> trimesh.Trimesh:
    """A mesh over a grid of points [a, b, 3]; ``closed`` joins the last column to the first."""
    a, b = grid.shape[:2]
    columns = b if closed else b - 1
    i, j = (m.ravel() for m in np.meshgrid(np.arange(a - 1), np.arange(columns), indexing="ij"))
    k = (j + 1) % b
    corners = np.stack([i * b + j, (i + 1) * b + j, (i + 1) * b + k, i * b + k], axis=1)
    faces = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    mesh = trimesh.Trimesh(grid.reshape(-1, 3), faces, process=False)
    mesh.update_faces(mesh.area_faces > 1e-10)
    mesh.merge_vertices()
    return mesh


def tube(path: Floats, radius_m: Floats | float, sides: int = 6, closed: bool = False) -> trimesh.Trimesh:
    """A round bar along a path [n, 3]."""
    ahead = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    if not closed:
        ahead[0], ahead[-1] = path[1] - path[0], path[-1] - path[-2]
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    across = np.cross(ahead, np.array([0.0, 0.0, 1.0]))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    above = np.cross(across, ahead)
    angle = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    radius = np.broadcast_to(np.asarray(radius_m), len(path))[:, None, None]
    ring = np.cos(angle)[None, :, None] * across[:, None] + np.sin(angle)[None, :, None] * above[:, None]
    grid = path[:, None] + radius * ring
    if closed:
        grid = np.concatenate([grid, grid[:1]])
    return strip(grid, closed=True)


def outline(s: Floats, height_m: Floats | float, inset_m: float = 0.0) -> Floats:
    """The sole's edge [2n, 3]: up the right side from the heel, back down the left."""
    x = LENGTH_M * s
    x = x + inset_m * (1 - 2 * s)
    right = np.stack([x, np.maximum(LATERAL(s) - inset_m, 0), np.broadcast_to(height_m, s.shape)], axis=1)
    left = np.stack([x, -np.maximum(MEDIAL(s) - inset_m, 0), np.broadcast_to(height_m, s.shape)], axis=1)
    right[-1, 1], left[-1, 1] = LATERAL(1.0), -MEDIAL(1.0)
    return np.concatenate([right, left[::-1]])


def capped(rings: list[Floats]) -> trimesh.Trimesh:
    """Rings joined into a wall, the last one closed by a lid across the shoe."""
    wall = strip(np.stack(rings), closed=True)
    last = rings[-1]
    half = len(last) // 2
    lid = strip(np.stack([last[:half], last[half:][::-1]], axis=1))
    return trimesh.util.concatenate([wall, lid])


def outsole() -> trimesh.Trimesh:
    """The dark tread: from 7 mm up the wall down to the floor."""
    s = stations(18)
    low = BOTTOM(s)
    return capped([outline(s, low + 0.008), outline(s, low + 0.002, 0.0005), outline(s, low, 0.004)])


def midsole() -> trimesh.Trimesh:
    """The pale foam, bulging a little, with a ledge on top where the upper begins."""
    s = stations(18)
    low, high = BOTTOM(s) + 0.008, MIDSOLE_TOP(s)
    return capped([
        outline(s, low, 0.0005), outline(s, 0.5 * (low + high), -0.002), outline(s, high - 0.002, 0.0015),
        outline(s, high, 0.005),
    ])  # fmt: skip


def shell(s: Floats, angle: Floats) -> Floats:
    """Points of the upper: at each station an arch from the midsole (±90°) to the ridge (0°)."""
    lateral, medial = LATERAL(s) - 0.004, MEDIAL(s) - 0.004
    half = np.where(angle > 0, lateral, medial)
    base, top = MIDSOLE_TOP(s) - 0.003, UPPER_TOP(s)
    lean = np.abs(np.sin(angle)) ** np.interp(s, [0, 0.3, 0.6, 1], [0.55, 0.75, 0.95, 0.8])
    rise = np.abs(np.cos(angle)) ** np.interp(s, [0, 0.3, 0.6, 1], [1.0, 0.95, 0.8, 0.7])
    x = LENGTH_M * (0.014 + 0.972 * s)
    return np.stack([x, np.sign(angle) * np.maximum(half, 0.0) * lean, base + (top - base) * rise], axis=-1)


def side(s: Floats, sign: float, count: int = 6) -> trimesh.Trimesh:
    """One side of the upper, up to the ridge or the edge of the opening."""
    low = OPENING(s)[:, None]
    part = np.linspace(0, 1, count)[None]
    angle = np.maximum(low + (0.5 * np.pi - low) * (1 - part), 1e-6)
    return facing(strip(shell(np.broadcast_to(s[:, None], angle.shape), sign * angle)), sign)


def facing(mesh: trimesh.Trimesh, sign: float) -> trimesh.Trimesh:
    """The left half turned inside out: it was made as the mirror image of the right one."""
    if sign < 0:
        mesh.invert()
    return mesh


def upper() -> trimesh.Trimesh:
    """Both sides, joined where they meet."""
    s = np.unique(np.concatenate([stations(17), np.linspace(0.03, 0.435, 8)]))
    mesh = trimesh.util.concatenate([side(s, 1.0), side(s, -1.0)])
    mesh.merge_vertices(digits_vertex=5)
    return mesh


def rim() -> Floats:
    """The edge of the ankle opening [n, 3], once round."""
    s = np.concatenate([[0.032, 0.04], np.linspace(0.055, 0.433, 11)])
    angle = np.maximum(OPENING(s), 1e-6)
    return np.concatenate([shell(s, angle), shell(s, -angle)[::-1][1:-1]])


def collar() -> trimesh.Trimesh:
    """The padded rim of the ankle opening."""
    return tube(rim(), 0.0052, 5, closed=True)


def lining() -> trimesh.Trimesh:
    """What one sees inside: a dark funnel under the rim."""
    edge = rim()
    centre = edge.mean(axis=0)
    inner = centre + (edge - centre) * [0.8, 0.75, 1.0]
    inner[:, 2] = 0.062
    floor = np.broadcast_to(centre * [1, 1, 0] + [0, 0, 0.06], edge.shape)
    return strip(np.stack([edge, inner, floor]), closed=True)


def tongue() -> trimesh.Trimesh:
    """A padded flap that stands up out of the opening."""
    along = np.linspace(0, 1, 6)
    x = LENGTH_M * (0.50 - 0.155 * along)
    z = np.interp(along, [0, 0.4, 0.75, 1], [0.103, 0.117, 0.130, 0.139])
    width = np.interp(along, [0, 0.5, 0.9, 1], [0.012, 0.019, 0.021, 0.015])
    across = np.linspace(-1, 1, 7)
    y = width[:, None] * across
    bend = -0.008 * across**2
    front = np.stack([np.broadcast_to(x[:, None], y.shape), y, z[:, None] + bend], axis=-1)
    back = front + [-0.006, 0.0, -0.004]
    edge = np.concatenate([front, back[:, ::-1]], axis=1)
    top = strip(np.stack([front[-1], back[-1]]))
    return trimesh.util.concatenate([strip(edge, closed=True), top])


def laces() -> trimesh.Trimesh:
    """Bars across the vamp, each lying on the upper."""
    bars = []
    for s in np.linspace(0.475, 0.70, 5):
        angle = np.linspace(-0.62, 0.62, 5)
        path = shell(np.full(5, s), angle) + [0.0, 0.0, 0.0015]
        bars.append(tube(path, 0.0026, 4))
    return trimesh.util.concatenate(bars)


def toe_cap() -> trimesh.Trimesh:
    """The rand round the toe, a hair outside the upper."""
    s = stations(8, 0.78, 1.0)
    part = np.linspace(0, 1, 4)[None]
    top = np.interp(s, [0.78, 0.86, 1.0], [1.5, 1.25, 0.98])[:, None]
    angle = top + (0.5 * np.pi - top) * part
    s_grid = np.broadcast_to(s[:, None], angle.shape)
    out = np.array([1.004, 1.025, 1.012])
    return trimesh.util.concatenate([
        facing(strip(shell(s_grid, sign * angle) * out), sign) for sign in (1.0, -1.0)
    ])  # fmt: skip


def stripe() -> trimesh.Trimesh:
    """A slanting band on either side."""
    part = np.linspace(0, 1, 6)
    angle = 1.36 - 0.78 * part
    out = np.array([1.0, 1.035, 1.004])
    bands = []
    for sign in (1.0, -1.0):
        for start in (0.50, 0.575):
            front = shell(start + 0.035 - 0.11 * part, sign * angle) * out
            back = shell(start - 0.11 * part, sign * angle) * out
            bands.append(strip(np.stack([front, back])))
    return trimesh.util.concatenate(bands)


def sensor() -> trimesh.Trimesh:
    """The sensor: a small rounded box on the laces, its middle in the origin."""
    box = trimesh.creation.box((0.040, 0.030, 0.013))
    lid = trimesh.creation.box((0.034, 0.024, 0.016))
    box = trimesh.util.concatenate([box, lid])
    return box.apply_translation(SENSOR_M)


def light() -> trimesh.Trimesh:
    """The sensor's lamp, on its lid towards the toe."""
    lamp = trimesh.creation.icosphere(0, 0.0035)
    return lamp.apply_translation(np.array(SENSOR_M) + [0.011, 0.0, 0.008])


def to_body(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """From heel-and-floor axes (z up) to the shoe's (z down), the sensor in the origin."""
    vertices = (mesh.vertices - SENSOR_M) * [1.0, 1.0, -1.0]
    return trimesh.Trimesh(vertices, mesh.faces[:, ::-1], process=False)


def shoe() -> dict[str, trimesh.Trimesh]:
    """The right shoe's parts by name."""
    parts = {
        "outsole": outsole(), "midsole": midsole(), "upper": upper(), "toe_cap": toe_cap(),
        "stripe": stripe(), "collar": collar(), "lining": lining(), "tongue": tongue(), "laces": laces(),
        "sensor": sensor(), "light": light(),
    }  # fmt: skip
    return {name: to_body(mesh) for name, mesh in parts.items()}


def main(path: Path) -> None:
    """Write each part's vertices (float32 [n, 3]) and faces (uint32 [m, 3])."""
    arrays: dict[str, Any] = {}
    for name, mesh in shoe().items():
        arrays[f"{name}.vertices"] = mesh.vertices.astype(np.float32)
        arrays[f"{name}.faces"] = mesh.faces.astype(np.uint32)
    np.savez_compressed(path, **arrays)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else PATH)
