"""A GPS track beside the walk: drawn once, on the floor, its name only text."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.motion.status import Reference
from app.scene import private
from app.scene.page import Scene
from app.scene.reference import told
from tests.scene import fakes

TRACK = Reference("<b>loop</b>", np.array([[[0, 0], [5, 1]], [[5, 1], [9, 4]]], np.float32), 10.1)


def nodes(scene: Scene) -> list[str]:
    return [m.name for m in private.broadcast_messages(scene._server) if "LineSegments" in type(m).__name__]


def test_a_track_is_drawn_and_goes_again(scene: Scene) -> None:
    status = fakes.status()
    scene.draw(fakes.snapshot(5.0), replace(status, reference=TRACK))
    assert "/ned/reference" in nodes(scene)
    scene._next_text = 0.0
    scene.draw(fakes.snapshot(5.0), status)
    assert "/ned/reference" not in nodes(scene)


def test_its_name_is_text() -> None:
    assert "<b>" not in told(TRACK)
    assert "10.10 m" in told(TRACK)
    assert told(None) == ""
