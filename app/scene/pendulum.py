"""Edge, scene: a sensor on a rod: where the estimate and a candidate have it, and where it truly is."""

from __future__ import annotations

from dataclasses import replace

import trimesh
import viser

from app.motion.basics import Quaternion, Role, Vector
from app.motion.snapshot import Snapshot
from app.scene import private
from app.scene.colours import CANDIDATE, FOOT, TRUTH, Rgb
from app.scene.guard import is_turn, unit
from app.scene.shoe import SENSOR_HEIGHT_M

#: The lowest point of the swing above the floor, m.
CLEAR_M = 0.12
THIN_M, THICK_M = 0.008, 0.013
#: Beside each other, so that all are seen.
BEHIND_M = 0.09


class Pendulum:
    """Rods at one pivot. Only their attitude moves."""

    def __init__(self, scene: viser.SceneApi, rod_m: float) -> None:
        self.rod_m = rod_m
        pivot = (0.0, 0.0, SENSOR_HEIGHT_M - CLEAR_M - rod_m)
        self._root = scene.add_frame("/ned/pendulum", show_axes=False, position=pivot)
        self._estimate = _rod(scene, "estimate", rod_m, THICK_M, FOOT[Role.FOOT], 0.0)
        self._truth = _rod(scene, "truth", rod_m, THIN_M, TRUTH, BEHIND_M)
        self._candidate = _rod(scene, "candidate", rod_m, THIN_M, CANDIDATE, -BEHIND_M)

    def draw(self, snapshot: Snapshot) -> Vector:
        """Turn the rods as the snapshot has them; returns what to look at."""
        if snapshot.pendulum is not None:
            _turn(self._estimate, snapshot.pendulum.q_nb)
            _turn(self._truth, snapshot.pendulum.true_q_nb)
        ghosts = snapshot.candidate.feet if snapshot.candidate else ()
        self._candidate.visible = bool(ghosts)
        for ghost in ghosts[:1]:
            _turn(self._candidate, ghost.q_nb)
        return (0.0, 0.0, -0.5 * self.rod_m)

    def remove(self) -> None:
        """Take it off the page."""
        self._root.remove()


def no_feet(snapshot: Snapshot) -> Snapshot:
    """The same without a walk."""
    return replace(snapshot, main=snapshot.main._replace(feet=()), candidate=None, truth={})


def _rod(
    scene: viser.SceneApi, name: str, rod_m: float, radius_m: float, colour: Rgb, behind_m: float
) -> viser.FrameHandle:
    """A rod that hangs down (z), the sensor at its end, ``behind_m`` to the side."""
    frame = scene.add_frame(f"/ned/pendulum/{name}", show_axes=False)
    rod = trimesh.creation.cylinder(radius_m, segment=[(0.0, behind_m, 0.0), (0.0, behind_m, rod_m)])
    bob = trimesh.creation.box((0.10, 0.07, 0.05))
    bob.apply_translation((0.0, behind_m, rod_m))
    both = trimesh.util.concatenate([rod, bob])
    scene.add_mesh_simple(
        f"/ned/pendulum/{name}/rod", both.vertices, both.faces, color=colour, flat_shading=True
    )
    return frame


def _turn(frame: viser.FrameHandle, q_nb: Quaternion) -> None:
    if is_turn(q_nb):
        private.force_pose(frame, unit(q_nb), (0.0, 0.0, 0.0))
