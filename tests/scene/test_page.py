from __future__ import annotations

import math
import time
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
import pytest

from app.motion.snapshot import Snapshot, Trail
from app.scene import private
from app.scene.page import Scene
from tests.scene import fakes


def numbers(thing: Any) -> list[float]:
    """Every float in a message, however deep."""
    if isinstance(thing, np.ndarray):
        return thing.astype(float).ravel().tolist() if thing.dtype.kind in "fiu" else []
    if isinstance(thing, float):
        return [thing]
    if isinstance(thing, dict):
        return [n for value in thing.values() for n in numbers(value)]
    if isinstance(thing, list | tuple):
        return [n for value in thing for n in numbers(value)]
    if is_dataclass(thing):
        return [n for f in fields(thing) for n in numbers(getattr(thing, f.name))]
    return []


def names(scene: Scene) -> set[str]:
    return {m.name for m in private.broadcast_messages(scene._server) if hasattr(m, "name")}


def with_foot(snapshot: Snapshot, **changes: Any) -> Snapshot:
    foot = snapshot.main.feet[0]._replace(**changes)
    return replace(snapshot, main=snapshot.main._replace(feet=(foot,)))


def test_one_foot_and_two(scene: Scene) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status())
    assert {"/ned", "/ned/foot", "/ned/foot/body", "/ned/ground", "/ned/compass"} <= names(scene)
    scene.draw(fakes.snapshot(5.0, two=True), fakes.status())
    drawn = {
        node
        for node in ("/ned/foot", "/ned/left", "/ned/right")
        if scene._server.scene.get_handle_by_name(node)
    }
    assert drawn == {"/ned/left", "/ned/right"}


def test_two_feet_start_a_fifth_of_a_metre_apart(scene: Scene) -> None:
    scene.draw(fakes.snapshot(0.0, two=True), fakes.status())
    left, right = (scene._server.scene.get_handle_by_name(f"/ned/{foot}") for foot in ("left", "right"))
    assert left is not None
    assert right is not None
    assert np.allclose(right.position - left.position, (0.0, 0.2, 0.0), atol=0.02)
    assert left.position[1] == pytest.approx(-0.1)


def test_the_ghost_comes_and_goes(scene: Scene) -> None:
    find = scene._server.scene.get_handle_by_name
    scene.draw(fakes.snapshot(5.0, candidate=True, truth=True), fakes.status())
    assert find("/ned/ghost/foot")
    assert find("/ned/trail/foot_truth")
    scene.draw(fakes.snapshot(5.0), fakes.status())
    assert not find("/ned/ghost/foot")
    assert not find("/ned/trail/foot_ghost")


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_never_reaches_viser(scene: Scene, bad: float) -> None:
    good = fakes.snapshot(9.7, candidate=True)
    trail = good.main.feet[0].trail
    growing, provisional = trail.growing.copy(), trail.provisional.copy()
    growing[3, 0, 1] = provisional[5, 1, 2] = bad
    piece = trail.pieces[0]._replace(segments=np.full((4, 2, 3), bad, np.float32))
    print_ = good.main.feet[0].footprints[0]._replace(position_n=(bad, bad, bad), heading_rad=bad)
    graph = good.graphs["foot"]
    spoiled = {"foot": graph._replace(statistic=np.where(graph.t_s > 5, bad, graph.statistic))}
    shot = with_foot(
        good, position_n=(bad, 0.0, 0.0), q_nb=(bad,) * 4, distance_m=bad,
        speed_mps=bad,
        cadence_spm=bad, height_m=bad, to_start_m=bad, error_m=bad, footprints=(print_,),
        trail=Trail((piece,), growing, provisional),
    )  # fmt: skip
    health = {"foot": good.health["foot"]._replace(rate_hz=bad)}
    ghost = (
        good.candidate._replace(feet=(good.candidate.feet[0]._replace(q_nb=(bad,) * 4),))
        if good.candidate
        else None
    )
    shot = replace(shot, graphs=spoiled, health=health, candidate=ghost, hindsight_from_s=bad)
    scene.draw(shot, fakes.status(position_s=bad, speed=1.0, stale_s=0.0, sweep_progress=0.5))
    messages = private.broadcast_messages(scene._server)
    assert sum(len(numbers(m)) for m in messages) > 1000
    assert [m for m in messages if not all(map(math.isfinite, numbers(m)))] == []


def test_after_a_pose_that_was_none_the_walk_goes_on(scene: Scene) -> None:
    shoe = "/ned/foot"
    scene.draw(fakes.snapshot(5.0), fakes.status())
    scene.draw(with_foot(fakes.snapshot(5.1), position_n=(math.nan,) * 3), fakes.status())
    node = scene._server.scene.get_handle_by_name(shoe)
    assert node is not None
    assert np.allclose(node.position, fakes.pose(5.0)[0])
    scene.draw(fakes.snapshot(5.2), fakes.status())
    assert np.allclose(node.position, fakes.pose(5.2)[0])


def test_a_new_epoch_leaves_nothing_behind(scene: Scene) -> None:
    scene.draw(fakes.snapshot(40.0), fakes.status())
    old = scene._server.scene.get_handle_by_name("/ned/trail/foot/piece_1")
    scene.draw(fakes.snapshot(0.0, epoch=1), fakes.status())
    assert old is not None
    assert old._impl.removed
    assert not scene._server.scene.get_handle_by_name("/ned/trail/foot/piece_1")


def test_the_buffer_for_a_late_joiner_does_not_grow_with_time(scene: Scene) -> None:
    """The same kinds of messages replace each other: only settled pieces of trail add to it."""
    snapshot = fakes.snapshot(30.0)

    def frames(count: int) -> int:
        for i in range(count):
            scene._next_text = scene._next_graph = 0.0
            moved = with_foot(snapshot, position_n=(0.001 * i, 0.0, -0.1), t_s=30.0 + i / 60)
            scene.draw(moved, fakes.status(position_s=30.0 + i / 60))
        return len(private.broadcast_messages(scene._server))

    first = frames(30)
    assert frames(200) <= first + 2


def test_follow_moves_the_world_not_the_camera(scene: Scene) -> None:
    for i in range(30):
        scene.draw(fakes.snapshot(30.0), fakes.status())
        time.sleep(0.002 * (i < 5))
    root = scene._server.scene.get_handle_by_name("/ned")
    assert root is not None
    north, east, _ = fakes.pose(30.0)[0]
    assert math.hypot(root.position[0] + east, root.position[1] + north) < 0.5
    before = root.position.copy()
    scene._set_view("follow", False)
    scene.draw(fakes.snapshot(33.0), fakes.status())
    assert np.array_equal(root.position, before)


def test_an_empty_snapshot_draws(scene: Scene) -> None:
    shot = fakes.snapshot(0.0)
    shot = replace(shot, main=shot.main._replace(feet=()), graphs={}, health={})
    scene.draw(shot, fakes.status(replay=False))
    assert not scene._server.scene.get_handle_by_name("/ned/foot")


def test_light_and_dark(scene: Scene) -> None:
    for dark in (False, True):
        scene._set_view("dark", dark)
        themes = [
            m
            for m in private.broadcast_messages(scene._server)
            if type(m).__name__ == "ThemeConfigurationMessage"
        ]
        assert [m.dark_mode for m in themes] == [dark]
        assert not themes[0].show_share_button
