"""Edge, scene: a GPS track on the floor beside the walk: its line, its name, its length."""

from __future__ import annotations

import math

import numpy as np
import viser

from app.motion.status import Reference
from app.scene import words
from app.scene.colours import Rgb
from app.scene.shoe import SENSOR_HEIGHT_M

GPS: Rgb = (86, 180, 233)
#: Above the floor, below the trails.
ABOVE_M = 0.006


def reference_line(scene: viser.SceneApi, reference: Reference) -> list[viser.SceneNodeHandle]:
    """Its line and its name; nothing where it has no length."""
    if not len(reference.segments):
        return []
    flat = reference.segments
    down = np.full((*flat.shape[:2], 1), SENSOR_HEIGHT_M - ABOVE_M, np.float32)
    line = scene.add_line_segments(
        "/ned/reference",
        np.concatenate([flat, down], axis=-1),
        GPS,
        thickness=2.5,
        thickness_units="screen",
    )
    north, east = (float(value) for value in flat[-1, 1])
    label = scene.add_label(
        "/ned/reference_name", f"GPS {reference.name}", position=(north, east, SENSOR_HEIGHT_M - 0.1),
        anchor="bottom-center", font_size_mode="screen", font_screen_scale=0.8,
    )  # fmt: skip
    return [line, label]


def told(reference: Reference | None) -> str:
    """Its key and length as HTML; nothing without one."""
    if reference is None:
        return ""
    turned = math.degrees(reference.declination_rad)
    length = " ".join(words.metres(reference.length_m))
    return (
        f'<div class="ss-legend"><span><i class="ss-gps"></i>GPS {words.plain(reference.name, 60)}, {length},'
        f" declination {turned:+.1f}°</span></div>"
    )
