"""Benchmarks: a bare viser loop to compare with: one frame, moved and flushed at 60 Hz, behind our door.

``python -m benchmarks.bare DOOR_PORT SETS_FILE [--shoe]``: prints viser's own port; ``--shoe`` puts our
page's ground and shoe into its scene, so that a browser has as much to render.
"""

from __future__ import annotations

import argparse
import signal
import time
from pathlib import Path
from types import FrameType

import numpy as np

from app.door.access import Access
from app.door.front import Door
from app.motion.basics import Role
from app.scene import private
from app.scene.ground import Ground
from app.scene.page import NED_WXYZ
from app.scene.shoe import Shoe

FRAME_S = 1 / 60
NODE = "/ned/foot"


def main() -> None:
    """Set the pose until SIGINT or SIGTERM; then write when each was set."""
    parser = argparse.ArgumentParser()
    parser.add_argument("port", type=int)
    parser.add_argument("sets", type=Path)
    parser.add_argument("--shoe", action="store_true")
    asked = parser.parse_args()
    stopped: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        stopped.append(number)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, stop)
    server = private.open_server("bare")
    server.scene.add_frame("/ned", wxyz=NED_WXYZ, show_axes=False)
    if asked.shoe:
        ground = Ground(server.scene, dark=True)  # noqa: F841  (kept, or its nodes might go)
        frame = Shoe(server.scene, NODE, Role.FOOT).frame
    else:
        frame = server.scene.add_frame(NODE, show_axes=True)
    server.initial_camera.position, server.initial_camera.look_at = (1.25, -1.75, 1.05), (0.0, 0.15, 0.05)
    door = Door(Access(port=asked.port), viser_port=server.get_port(), rules=dict, health=dict)
    door.start()
    print(server.get_port(), flush=True)
    sets: list[tuple[float, ...]] = []
    due = time.monotonic()
    while not stopped:
        x = 0.3 * np.sin(len(sets) * 0.1) + 1e-7 * len(sets)  # never the same twice
        sets.append((time.monotonic_ns(), x, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0))
        frame.position = (x, 0.0, 0.0)
        server.flush()
        due = max(due + FRAME_S, time.monotonic() - FRAME_S)
        time.sleep(max(0.0, due - time.monotonic()))
    np.savez(asked.sets, samples=np.array(sets), drawn=np.empty((0, 2)))
    door.stop()
    private.close_server(server)


if __name__ == "__main__":
    main()
