"""Edge, scene: the shoe: its parts from assets/shoe.npz, coloured, left or right, solid or ghost."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import viser
from numpy.typing import NDArray

from app.motion.basics import Quaternion, Role, Vector
from app.motion.estimate import Toe
from app.rotation import from_yaw
from app.scene import private
from app.scene.baked import apart, lit
from app.scene.colours import FOOT, Rgb, shade
from app.scene.glb import Part, glb, joined

ASSET = Path(__file__).resolve().parents[2] / "assets" / "shoe.npz"
#: The sensor's height above the floor while the shoe stands flat (tools/make_shoe.py).
SENSOR_HEIGHT_M = 0.112
#: Of points so close along the sole only the outermost is on its edge.
NEAR_M = 0.005
#: How much of a ghost is there.
SHEER = 0.32

Mesh = tuple[NDArray[np.float32], NDArray[np.uint32]]


@cache
def parts(mirrored: bool) -> dict[str, Mesh]:
    """Vertices [n, 3] in the shoe's axes and faces [m, 3] of each part; mirrored is the left shoe."""
    side = -1 if mirrored else 1
    flip = np.array([1.0, side, 1.0])
    with np.load(ASSET) as made:
        names = dict.fromkeys(key.partition(".")[0] for key in made)
        return {
            name: (
                (made[f"{name}.vertices"] * flip).astype(np.float32),
                np.ascontiguousarray(made[f"{name}.faces"][:, ::side]),
            )
            for name in names
        }


def paint(colour: Rgb) -> dict[str, Rgb]:
    """What colour each part has on a shoe of this colour."""
    return {
        "outsole": (38, 42, 50), "midsole": (240, 242, 245), "upper": colour, "toe_cap": shade(colour, 0.78),
        "stripe": (246, 248, 250), "collar": shade(colour, 0.68), "lining": (30, 35, 43),
        "tongue": shade(colour, 0.84), "laces": (240, 242, 244), "sensor": (36, 40, 48),
        "light": (130, 255, 170),
    }  # fmt: skip


@cache
def solid(role: Role) -> bytes:
    """The shoe in the colour of its foot, as binary glTF: one mesh."""
    made = []
    for name, (vertices, faces) in parts(role is Role.LEFT).items():
        mesh = apart(vertices, faces) if name == "sensor" else (vertices, faces)
        made.append(Part(name, *mesh, lit(*mesh, paint(FOOT[role])[name]), open=True))
    return glb([joined("shoe", made)])


@cache
def sheer(role: Role, colour: Rgb) -> bytes:
    """The shoe in one colour that lets what is behind it shine through: a ghost, without small parts."""
    made = []
    for name, mesh in parts(role is Role.LEFT).items():
        if name not in ("lining", "light", "stripe", "laces"):
            colours = np.pad(lit(*mesh, colour), ((0, 0), (0, 1)), constant_values=SHEER)
            made.append(Part(name, *mesh, colours, clear=True))
    return glb([joined("ghost", made)])


@cache
def dark(role: Role) -> bytes:
    """The soft dark patch under a shoe, as binary glTF: three flat soles, each smaller and darker."""
    outline, faces = sole(role is Role.LEFT)
    centre, layers = outline[:1], []
    for i, (wider, opacity) in enumerate(((1.3, 0.10), (1.1, 0.18), (0.92, 0.30))):
        place = centre + (outline - centre) * wider - np.array([0.0, 0.0, 0.001 * i], np.float32)
        black = np.tile(np.array([0.0, 0.0, 0.0, opacity], np.float32), (len(place), 1))
        layers.append(Part(f"layer_{i}", place.astype(np.float32), faces, black, clear=True))
    return glb([joined("shadow", layers)])


class Shadow:
    """A soft dark patch on the floor under a shoe: a mesh of its own, for it lies level."""

    def __init__(self, scene: viser.SceneApi, name: str, role: Role) -> None:
        self.frame = scene.add_frame(name, show_axes=False)
        self._last: tuple[float, Vector] | None = None
        scene.add_glb(f"{name}/soft", dark(role), cast_shadow=False, receive_shadow=False)

    def lie(self, position: Vector, yaw_rad: float, floor_down_m: float) -> None:
        """Under a shoe that is at ``position``, on a floor at ``floor_down_m``."""
        place = (position[0], position[1], floor_down_m - 0.005)
        if (yaw_rad, place) != self._last:
            private.force_pose(self.frame, from_yaw(yaw_rad), place)
            self._last = (yaw_rad, place)

    def remove(self) -> None:
        """Take it off the page."""
        self.frame.remove()


def yaw(q: Quaternion) -> float:
    """Which way the toe points: NED yaw of a unit quaternion, rad."""
    w, x, y, z = q
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


class Shoe:
    """One shoe under a frame ``name``; a ghost is one colour and lets the light through."""

    def __init__(self, scene: viser.SceneApi, name: str, role: Role, ghost: Rgb | None = None) -> None:
        self.frame = scene.add_frame(name, show_axes=False, axes_length=0.09, axes_radius=0.0022)
        self._last: tuple[Quaternion, Vector] | None = None
        made = solid(role) if ghost is None else sheer(role, ghost)
        self._body = scene.add_glb(f"{name}/body", made, cast_shadow=False, receive_shadow=False)
        self._toe: Toe | None = None

    def pose(self, q_nb: Quaternion, position: Vector) -> None:
        """Where it is now; nothing is sent while it has not moved."""
        if (q_nb, position) != self._last:
            private.force_pose(self.frame, q_nb, position)
            self._last = (q_nb, position)

    def point(self, toe: Toe | None) -> None:
        """Turn the shoe under its sensor, whose axes stay."""
        if toe != self._toe:
            self._toe = toe
            self._body.wxyz = toe.q_bs if toe else (1.0, 0.0, 0.0, 0.0)

    def show_axes(self, on: bool) -> None:
        """The sensor's axes: x (red) toe, y (green) right, z (blue) down."""
        self.frame.show_axes = on

    def remove(self) -> None:
        """Take it off the page."""
        self.frame.remove()


@cache
def sole(mirrored: bool) -> Mesh:
    """The print of the sole: a flat fan, in the shoe's x and y, around the sensor."""
    x, y = parts(mirrored)["outsole"][0][:, :2].astype(np.float64).T
    at = 0.5 * (x.min() + x.max()) - 0.5 * (x.max() - x.min()) * np.cos(np.linspace(0.1, np.pi - 0.1, 13))
    right, left = (_edge(x, y * side, at) * side for side in (1.0, -1.0))
    edge = np.concatenate([np.stack([at, right], axis=1), np.stack([at, left], axis=1)[::-1]])
    centre = edge.mean(axis=0)
    vertices = np.concatenate([[centre], edge])
    turn = np.arange(len(edge))
    faces = np.stack([np.zeros_like(turn), turn + 1, (turn + 1) % len(edge) + 1], axis=1)
    return np.pad(vertices, ((0, 0), (0, 1))).astype(np.float32), faces.astype(np.uint32)


def _edge(x: NDArray[np.float64], y: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far to the right the outline reaches at each of ``at``."""
    near = np.abs(x[:, None] - x) < NEAR_M
    outer = np.flatnonzero(y >= np.where(near, y, -np.inf).max(axis=1))
    order = outer[np.argsort(x[outer])]
    return np.interp(at, x[order], y[order])
