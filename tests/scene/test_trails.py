from __future__ import annotations

import numpy as np
import pytest

from app.motion.snapshot import Trail, TrailPiece
from app.scene import private, trails
from app.scene.meshes import BOTH_S
from app.scene.page import Scene
from app.scene.ribbon import ribbon
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


class Clock:
    """The scene's clock, put on by hand."""

    def __init__(self) -> None:
        self.now_s = 1000.0

    def tick(self, seconds: float) -> None:
        self.now_s += seconds

    def monotonic(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    return Clock()


def pieces_sent(scene: Scene) -> set[bytes]:
    """The ribbons that a browser which joins now would be sent."""
    sent = private.broadcast_messages(scene._server)
    return {m.props.glb_data for m in sent if "/piece_" in getattr(m, "name", "") and hasattr(m, "props")}


def test_a_piece_is_sent_once_and_goes_with_its_key(scene: Scene, clock: Clock) -> None:
    nodes = trails.TrailNodes(
        scene._server.scene, "t", trails.Look((1, 2, 3), (4, 5, 6), 2.0), (0.0, 0.0, 0.0), clock.monotonic
    )
    one, two = TrailPiece("one", straight(1.0)), TrailPiece("two", straight(2.0))
    nodes.draw(Trail((one,), EMPTY, EMPTY))
    (first,) = pieces_sent(scene)
    nodes.draw(Trail((one, two), EMPTY, EMPTY))
    assert first in pieces_sent(scene)
    assert len(pieces_sent(scene)) == 2
    nodes.draw(Trail((two,), EMPTY, EMPTY))
    clock.tick(BOTH_S + 0.01)
    nodes.draw(Trail((two,), EMPTY, EMPTY))
    assert len(pieces_sent(scene)) == 1
    assert first not in pieces_sent(scene)


def test_of_pieces_that_came_together_some_go_and_the_others_stay(scene: Scene, clock: Clock) -> None:
    look = trails.Look((1, 2, 3), (4, 5, 6), 2.0)
    nodes = trails.TrailNodes(scene._server.scene, "t", look, (0.0, 0.0, 0.0), clock.monotonic)
    a, b, c, both = (TrailPiece(name, straight(k + 1.0)) for k, name in enumerate(("a", "b", "c", "a and b")))
    nodes.draw(Trail((a, b, c), EMPTY, EMPTY))
    assert pieces_sent(scene) == {drawn_as(look, a, b, c)}
    after = Trail((both, c), EMPTY, EMPTY)
    nodes.draw(after)
    clock.tick(BOTH_S + 0.01)
    nodes.draw(after)
    assert pieces_sent(scene) == {drawn_as(look, both, c)}


def drawn_as(look: trails.Look, *pieces: TrailPiece) -> bytes:
    return ribbon(np.concatenate([piece.segments for piece in pieces]), look.colour, look.thickness)


def test_all_that_is_settled_is_drawn_at_any_time_and_its_end_alone_is_a_line(
    scene: Scene, clock: Clock
) -> None:
    way = straight(30.0, 200)
    nodes = trails.TrailNodes(
        scene._server.scene, "t", trails.Look((1, 2, 3), (4, 5, 6), 2.0), (0.0, 0.0, 0.0), clock.monotonic
    )
    for settled in range(1, 200):
        done = settled // 64 * 64
        pieces = tuple(TrailPiece(f"{i}", way[i : i + 64]) for i in range(0, done, 64))
        growing = way[done:settled]
        nodes.draw(Trail(pieces, growing, EMPTY))
        line = nodes._line._node.points  # what has been a ribbon for a moment is no line any more
        assert len(line) <= 2 * trails.PART + 2
        shown = [*line, *(segment for part, _ in nodes._parts for segment in part)]
        assert {float(s[0, 0]) for s in growing} <= {float(s[0, 0]) for s in shown}
        clock.tick(0.1)
    for _ in range(3):
        clock.tick(BOTH_S)
        nodes.draw(Trail(pieces, growing, EMPTY))
    np.testing.assert_array_equal(nodes._line._node.points, growing[-(len(growing) % trails.PART) :])
    assert len(pieces_sent(scene)) == len(pieces) + len(growing) // trails.PART


def test_a_growing_piece_that_was_turned_is_drawn_anew(scene: Scene, clock: Clock) -> None:
    nodes = trails.TrailNodes(
        scene._server.scene, "t", trails.Look((1, 2, 3), (4, 5, 6), 2.0), (0.0, 0.0, 0.0), clock.monotonic
    )
    nodes.draw(Trail((), straight(5.0), EMPTY))
    before = pieces_sent(scene)
    turned = np.ascontiguousarray(straight(5.0)[..., [1, 0, 2]])
    nodes.draw(Trail((), turned, EMPTY))
    clock.tick(2 * BOTH_S)
    nodes.draw(Trail((), turned, EMPTY))
    assert len(pieces_sent(scene)) == len(before) == 50 // trails.PART
    assert not before & pieces_sent(scene)


def test_what_did_not_change_is_not_sent(scene: Scene, clock: Clock) -> None:
    nodes = trails.TrailNodes(
        scene._server.scene, "t", trails.Look((1, 2, 3), (4, 5, 6), 2.0), (0.0, 0.0, 0.0), clock.monotonic
    )
    trail = fakes.trail(20.3)
    nodes.draw(trail)
    before = [id(m) for m in private.broadcast_messages(scene._server)]
    nodes.draw(trail)
    assert [id(m) for m in private.broadcast_messages(scene._server)] == before
