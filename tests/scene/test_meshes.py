"""Meshes by their keys: what is replaced stays a moment, and names are used again."""

from __future__ import annotations

import numpy as np

from app.scene import meshes, private
from app.scene.page import Scene
from app.scene.ribbon import ribbon


def shown(scene: Scene) -> list[str]:
    sent = private.broadcast_messages(scene._server)
    return sorted(m.name for m in sent if type(m).__name__ == "GlbMessage" and "/mine" in m.name)


def file(east: float) -> bytes:
    return ribbon(np.array([[[0, 0, 0], [1, east, 0]]], np.float32), (1, 2, 3), 2.0)


def test_what_is_replaced_stays_until_the_new_one_is_there(scene: Scene) -> None:
    now = [0.0]
    kept = meshes.Meshes(scene._server.scene, "/ned/mine", 0.3, lambda: now[0])
    kept.put("a", file(1.0))
    kept.put("a", file(2.0))
    kept.tidy()
    assert len(shown(scene)) == 2
    now[0] = 0.31
    kept.tidy()
    assert len(shown(scene)) == len(kept) == 1


def test_however_much_comes_and_goes_there_are_few_names(scene: Scene) -> None:
    kept = meshes.Meshes(scene._server.scene, "/ned/mine", 0.3, lambda: 0.0)
    names: set[str] = set()
    for k in range(200):
        kept.put("a", file(float(k)))
        names |= set(shown(scene))
    assert len(names) <= meshes.LEAVING + 2
    kept.drop("a")
    kept.drop("never there")
    assert len(kept) == 0
