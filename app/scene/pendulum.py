"""Edge, scene: a sensor on a rod: where the estimate has it, and where it truly is."""

from __future__ import annotations

from dataclasses import replace

import trimesh
import viser

from app.motion import Quaternion, Role, Snapshot, Vector
from app.scene import private
from app.scene.colours import FOOT, TRUTH, Rgb
from app.scene.guard import unit
from app.scene.shoe import SENSOR_HEIGHT_M

#: The lowest point of the swing above the floor, m.
CLEAR_M = 0.12
THIN_M, THICK_M = 0.008, 0.013


class Pendulum:
    """Two rods at one pivot: estimate and truth. Only their attitude moves."""

    def __init__(self, scene: viser.SceneApi, rod_m: float) -> None:
        self.rod_m = rod_m
        pivot = (0.0, 0.0, SENSOR_HEIGHT_M - CLEAR_M - rod_m)
        self._root = scene.add_frame("/ned/pendulum", show_axes=False, position=pivot)
        self._estimate = _rod(scene, "/ned/pendulum/estimate", rod_m, THICK_M, FOOT[Role.FOOT], 0.0)
        self._truth = _rod(scene, "/ned/pendulum/truth", rod_m, THIN_M, TRUTH, 0.09)

    def draw(self, snapshot: Snapshot) -> Vector:
        """Turn the rods as the first sensor of the snapshot is turned; returns what to look at."""
        for foot in snapshot.main.feet[:1]:
            _turn(self._estimate, foot.q_nb)
            if foot.true_q_nb is not None:
                _turn(self._truth, foot.true_q_nb)
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
    """A rod that hangs down (z), the sensor at its end, ``behind_m`` to the side so that both are seen."""
    frame = scene.add_frame(name, show_axes=False)
    rod = trimesh.creation.cylinder(radius_m, segment=[(0.0, behind_m, 0.0), (0.0, behind_m, rod_m)])
    bob = trimesh.creation.box((0.10, 0.07, 0.05))
    bob.apply_translation((0.0, behind_m, rod_m))
    both = trimesh.util.concatenate([rod, bob])
    scene.add_mesh_simple(f"{name}/rod", both.vertices, both.faces, color=colour, flat_shading=True)
    return frame


def _turn(frame: viser.FrameHandle, q_nb: Quaternion) -> None:
    private.force_pose(frame, unit(q_nb), (0.0, 0.0, 0.0))
