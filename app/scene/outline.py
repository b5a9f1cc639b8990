"""Edge, scene: the trails that a recording tells itself, while its samples are read."""

from __future__ import annotations

import viser

from app.motion.basics import Role
from app.motion.source import Outline
from app.scene.colours import FOOT, blend
from app.scene.guard import finite_segments
from app.scene.ribbon import ribbon
from app.scene.walkers import GREY, origin

PIXELS = 1.5


def outline_lines(scene: viser.SceneApi, outline: Outline) -> list[viser.SceneNodeHandle]:
    """Every foot's trail."""
    two_feet = {Role.LEFT, Role.RIGHT} <= {role for role, _ in outline.ways}
    return [
        scene.add_glb(
            f"/ned/outline/{number}",
            ribbon(good, blend(FOOT[role], GREY, 0.35), PIXELS),
            position=origin(role, two_feet, 0.0),
            cast_shadow=False,
            receive_shadow=False,
        )
        for number, (role, segments) in enumerate(outline.ways)
        if len(good := finite_segments(segments))
    ]
