from __future__ import annotations

import numpy as np
import pytest

from app.motion.snapshot import Trail, TrailPiece
from app.scene import private, trails
from app.scene.page import Scene
from tests.scene import fakes

EMPTY = trails.NOTHING[:0]


def straight(length_m: float, count: int = 50) -> np.ndarray:
    points = np.zeros((count + 1, 3), np.float32)
    points[:, 0] = np.linspace(0, length_m, count + 1)
    return np.stack([points[:-1], points[1:]], axis=1)


def test_dashes_cover_half_the_path_in_order() -> None:
    cut = trails.dashes(straight(1.4))
    lengths = np.linalg.norm(cut[:, 1] - cut[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(0.7, abs=trails.DASH_M)
    assert (cut[1:, 0, 0] > cut[:-1, 1, 0]).all()


def test_dashes_are_bounded_however_far_it_ran() -> None:
    cut = trails.dashes(straight(5000.0))
    assert len(cut) == 400
    assert cut[-1, 0, 0] > 4900


def test_dashes_of_nothing() -> None:
    assert len(trails.dashes(EMPTY)) == 0


def piece_names(scene: Scene) -> set[str]:
    names = {getattr(m, "name", "") for m in private.broadcast_messages(scene._server)}
    return {n for n in names if "/piece_" in n}


def test_a_piece_is_sent_once_and_goes_with_its_key(scene: Scene) -> None:
    nodes = trails.TrailNodes(
        scene._server.scene, "t", trails.Look((1, 2, 3), (4, 5, 6), 2.0), (0.0, 0.0, 0.0)
    )
    one, two = TrailPiece("one", straight(1.0)), TrailPiece("two", straight(2.0))
    nodes.draw(Trail((one,), EMPTY, EMPTY))
    first = dict(nodes._pieces)
    nodes.draw(Trail((one, two), EMPTY, EMPTY))
    assert nodes._pieces["one"] is first["one"]
    assert len(piece_names(scene)) == 2
    nodes.draw(Trail((two,), EMPTY, EMPTY))
    assert set(nodes._pieces) == {"two"}


def test_what_did_not_change_is_not_sent(scene: Scene) -> None:
    nodes = trails.TrailNodes(
        scene._server.scene, "t", trails.Look((1, 2, 3), (4, 5, 6), 2.0), (0.0, 0.0, 0.0)
    )
    trail = fakes.trail(20.3)
    nodes.draw(trail)
    before = [id(m) for m in private.broadcast_messages(scene._server)]
    nodes.draw(trail)
    assert [id(m) for m in private.broadcast_messages(scene._server)] == before
