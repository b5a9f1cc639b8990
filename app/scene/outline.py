"""Edge, scene: the trails that a recording tells itself, while its samples are read."""

from __future__ import annotations

import viser

from app.motion.basics import Role
from app.motion.source import Outline
from app.scene.colours import FOOT, blend
from app.scene.guard import finite_segments
from app.scene.walkers import GREY, origin


class OutlineLines:
    """Drawn once for each recording that is being opened."""

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._shown: Outline | None = None
        self._nodes: list[viser.SceneNodeHandle] = []

    def draw(self, outline: Outline | None) -> None:
        """Make the page show these trails, or none."""
        if outline is self._shown:
            return
        self._shown = outline
        for node in self._nodes:
            node.remove()
        self._nodes = [] if outline is None else self._made(outline)

    def _made(self, outline: Outline) -> list[viser.SceneNodeHandle]:
        two_feet = {Role.LEFT, Role.RIGHT} <= {role for role, _ in outline.ways}
        return [
            self._scene.add_line_segments(
                f"/ned/outline/{number}",
                good,
                blend(FOOT[role], GREY, 0.35),
                thickness=1.5,
                thickness_units="screen",
                position=origin(role, two_feet, 0.0),
            )
            for number, (role, segments) in enumerate(outline.ways)
            if len(good := finite_segments(segments))
        ]
