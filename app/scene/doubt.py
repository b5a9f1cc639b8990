"""Edge, scene: the 95 % ellipse on the floor under a shoe: where else it may be."""

from __future__ import annotations

import math

import numpy as np
import viser
from numpy.typing import NDArray

from app.motion.basics import Role, Vector
from app.motion.estimate import Trust
from app.scene.colours import FOOT, Rgb, blend
from app.scene.guard import FAR_M

CORNERS = 48
ABOVE_FLOOR_M = 0.004
#: An ellipse that hardly changed is not sent again.
SAME_SHARE, SAME_M, SAME_RAD = 0.03, 0.002, 0.03
#: What is not to be believed is warned of by colour too; the word stands beside the foot's name.
WARNING: Rgb = (213, 94, 0)

Shape = tuple[float, float, float, str]  # half axes, m; angle, rad; word


def outline(major_m: float, minor_m: float, angle_rad: float) -> NDArray[np.float32]:
    """The ellipse around the origin as line segments [k, 2, 3] on the floor; every third one left out."""
    turn = np.linspace(0.0, 2.0 * math.pi, CORNERS + 1)
    along, across = major_m * np.cos(turn), minor_m * np.sin(turn)
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    points = np.column_stack([c * along - s * across, s * along + c * across, np.zeros_like(turn)])
    segments = np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)
    dashes: NDArray[np.float32] = segments[np.arange(CORNERS) % 3 != 2]
    return dashes


def is_same(one: Shape, other: Shape) -> bool:
    """Whether nobody would see a difference."""
    near = all(
        abs(a - b) <= max(SAME_M, SAME_SHARE * max(a, b)) for a, b in zip(one[:2], other[:2], strict=True)
    )
    round_enough = min(one[1], other[1]) > 0.9 * max(one[0], other[0])
    turned = abs(math.remainder(one[2] - other[2], math.pi))
    return near and one[3] == other[3] and (round_enough or turned < SAME_RAD)


class Doubt:
    """One foot's ellipse."""

    def __init__(self, scene: viser.SceneApi, name: str, role: Role) -> None:
        self._frame = scene.add_frame(name, show_axes=False, visible=False)
        self._scene, self._name, self._role = scene, name, role
        self._line: viser.LineSegmentsHandle | None = None
        self._shape: Shape | None = None
        self._place: Vector | None = None

    def lie(self, place: Vector, floor_m: float, trust: Trust | None) -> None:
        """Around the shoe, on the floor ``floor_m`` down; nothing where nobody knows how sure it is."""
        known = trust is not None and 0.0 < trust.major_m < FAR_M and math.isfinite(trust.angle_rad)
        if self._frame.visible != known:
            self._frame.visible = known
        if trust is None or not known:
            return
        at = (place[0], place[1], floor_m - ABOVE_FLOOR_M)
        if at != self._place:
            self._frame.position = self._place = at
        shape = (trust.major_m, trust.minor_m, trust.angle_rad, trust.word)
        if self._shape is None or not is_same(self._shape, shape):
            self._draw(shape)

    def _draw(self, shape: Shape) -> None:
        major_m, minor_m, angle_rad, word = shape
        segments = outline(major_m, minor_m, angle_rad)
        if self._line is None or self._shape is None or self._shape[3] != word:
            colour = blend(FOOT[self._role], (255, 255, 255), 0.25) if word == "good" else WARNING
            self._line = self._scene.add_line_segments(
                f"{self._name}/edge", segments, colour, thickness=2.0, thickness_units="screen"
            )
        else:
            self._line.points = segments
        self._shape = shape

    def remove(self) -> None:
        """Take it off the page."""
        self._frame.remove()
