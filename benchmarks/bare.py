"""Benchmarks: a bare viser loop to compare with: one frame, moved and flushed at 60 Hz, behind our door.

``python -m benchmarks.bare DOOR_PORT SETS_FILE [--shoe | --walk FILE [--town]]``: prints viser's own port.
``--shoe`` puts our walk page's ground and shoe into its scene, so that a browser has as much to render;
``--walk`` moves ``/world`` by the poses of a file, again and again, with ``--town`` our town hangs under it.
"""

from __future__ import annotations

import argparse
import itertools
import math
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

import numpy as np
import viser

from app.door.access import Access
from app.door.front import Door
from app.motion.basics import Role
from app.scene import private, town
from app.scene.follow import NED_WXYZ
from app.scene.ground import Ground
from app.scene.mover_page import FAR_M, FOV_DEG, NEAR_M
from app.scene.shoe import Shoe

FRAME_S = 1 / 60
NODE = "/ned/foot"
Pose = tuple[float, ...]


def walk_page(server: viser.ViserServer, shoe: bool) -> viser.FrameHandle:
    """A frame to move; with our ground, and our shoe on it."""
    server.scene.add_frame("/ned", wxyz=NED_WXYZ, show_axes=False)
    server.initial_camera.position, server.initial_camera.look_at = (1.25, -1.75, 1.05), (0.0, 0.15, 0.05)
    if not shoe:
        return server.scene.add_frame(NODE, show_axes=True)
    Ground(server.scene, dark=True)
    return Shoe(server.scene, NODE, Role.FOOT).frame


def town_page(server: viser.ViserServer, with_town: bool) -> viser.FrameHandle:
    """A world to move before a camera that stands still; with our town and sky in it."""
    scene, camera = server.scene, server.initial_camera
    scene.configure_default_lights(False, cast_shadow=False)
    scene.configure_environment_map(None)
    scene.configure_fog(*town.FOG_M, color=town.haze())
    camera.position, camera.look_at, camera.up = (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    camera.fov, camera.near, camera.far = math.radians(FOV_DEG), NEAR_M, FAR_M
    frame = scene.add_frame("/world", show_axes=False)
    for name, file in (("town", town.town_file()), ("sky", town.sky_file())) if with_town else ():
        scene.add_glb(f"/world/{name}", file, cast_shadow=False, receive_shadow=False)
    return frame


def swaying() -> Iterator[Pose]:
    """To and fro, never the same twice."""
    return ((0.3 * math.sin(0.1 * k) + 1e-7 * k, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0) for k in itertools.count())


def walked(file: Path) -> Iterator[Pose]:
    """The poses of a file, again and again, never the same twice."""
    poses = np.load(file)["poses"]
    for k in itertools.count():
        x, *rest = poses[k % len(poses)].tolist()
        yield (x + 1e-7 * (k // len(poses)), *rest)


def loop(server: viser.ViserServer, frame: viser.FrameHandle, poses: Iterator[Pose]) -> list[Pose]:
    """Set and flush sixty times a second until SIGINT or SIGTERM; when each was set, in nanoseconds."""
    stopped: list[int] = []

    def stop(number: int, where: FrameType | None) -> None:
        stopped.append(number)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, stop)
    sets: list[Pose] = []
    due = time.monotonic()
    while not stopped:
        pose = next(poses)
        sets.append((time.monotonic_ns(), *pose))
        frame.position = np.array(pose[:3])
        frame.wxyz = np.array(pose[3:])
        server.flush()
        due = max(due + FRAME_S, time.monotonic() - FRAME_S)
        time.sleep(max(0.0, due - time.monotonic()))
    return sets


def main() -> None:
    """Serve until SIGINT or SIGTERM; then write when each pose was set."""
    parser = argparse.ArgumentParser()
    parser.add_argument("port", type=int)
    parser.add_argument("sets", type=Path)
    parser.add_argument("--shoe", action="store_true")
    parser.add_argument("--walk", type=Path)
    parser.add_argument("--town", action="store_true")
    asked = parser.parse_args()
    server = private.open_server("bare")
    frame = town_page(server, asked.town) if asked.walk else walk_page(server, asked.shoe)
    door = Door(Access(port=asked.port), viser_port=server.get_port(), rules=dict, health=dict)
    door.start()
    print(server.get_port(), flush=True)
    sets = loop(server, frame, walked(asked.walk) if asked.walk else swaying())
    np.savez(asked.sets, samples=np.array(sets), drawn=np.empty((0, 2)))
    door.stop()
    private.close_server(server)


if __name__ == "__main__":
    main()
