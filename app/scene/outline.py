"""Edge, scene: what a recording tells of itself while its samples are read: trails, shoes at their start."""

from __future__ import annotations

import math

import numpy as np
import viser
from numpy.typing import NDArray

from app.motion.basics import Role
from app.motion.source import Outline
from app.rotation import from_yaw
from app.scene.colours import FOOT, blend
from app.scene.guard import finite_segments
from app.scene.ribbon import ribbon
from app.scene.shoe import SENSOR_HEIGHT_M, Shadow, Shoe
from app.scene.walkers import GREY, origin

Segments = NDArray[np.float32]

#: The edges alone, a pixel wide: an hour in one room is a thousand ways over each other and the shoes.
PIXELS = 0.0
#: A foot that has come so far from its start shows which way it set out.
SET_OUT_M = 0.6


def outline_nodes(scene: viser.SceneApi, outline: Outline) -> list[viser.SceneNodeHandle]:
    """Every foot's trail, and its shoe where the walk will begin; level, as nothing is estimated yet."""
    two_feet = {Role.LEFT, Role.RIGHT} <= {role for role, _ in outline.ways}
    nodes: list[viser.SceneNodeHandle] = []
    for number, (role, segments) in enumerate(outline.ways):
        if len(good := finite_segments(segments)):
            name = f"/ned/outline/{number}"
            nodes.append(scene.add_frame(name, show_axes=False, position=origin(role, two_feet, 0.0)))
            _draw(scene, name, role, good)
    return nodes


def _draw(scene: viser.SceneApi, name: str, role: Role, way: Segments) -> None:
    file = ribbon(way, blend(FOOT[role], GREY, 0.35), PIXELS)
    scene.add_glb(f"{name}/way", file, cast_shadow=False, receive_shadow=False)
    north, east, down = way[0, 0].tolist()
    yaw_rad = setting_out_rad(way)
    Shoe(scene, f"{name}/shoe", role).pose(from_yaw(yaw_rad), (north, east, down))
    Shadow(scene, f"{name}/shadow", role).lie((north, east, down), yaw_rad, down + SENSOR_HEIGHT_M)


def setting_out_rad(way: Segments) -> float:
    """Which way a path of segments [k, 2, 3] leaves its start: NED yaw, rad; 0 where it goes nowhere."""
    from_start = way[:, 1, :2] - way[0, 0, :2]
    length = np.linalg.norm(from_start, axis=1)
    far = np.flatnonzero(length >= SET_OUT_M)
    north, east = from_start[far[0] if len(far) else int(np.argmax(length))].tolist()
    return math.atan2(east, north)
