"""The drawn town is the town that steering knows: what one sees in the way is in the way, and the reverse."""

from __future__ import annotations

import numpy as np
import pytest

from app.motion.basics import Floats
from app.scene.town import parts, sky_file, town_file
from app.world import Box, Town, make_town

TOWN = make_town()
#: Between a kerb and a head: what a body would touch, m above the ground.
LOW_M, HIGH_M = 0.2, 1.8
SILLS_M = 0.25  # plinths, steps and window sills stand out so far


@pytest.fixture(scope="module")
def touchable() -> Floats:
    """Places [n, 2] of what is drawn inside the town at a body's height."""
    blocks = [part.vertices for name, part in parts().items() if name.startswith("block")]
    places = np.concatenate(blocks).astype(np.float64)
    height = -places[:, 2]
    return np.asarray(places[(height > LOW_M) & (height < HIGH_M), :2])


def away(places: Floats, town: Town) -> Floats:
    """How far each place is from the nearest wall of the world [n]."""
    nearest = np.full(len(places), np.inf)
    for south, west, north, east in town.solid:
        n = places[:, 0] - np.clip(places[:, 0], south, north)
        e = places[:, 1] - np.clip(places[:, 1], west, east)
        nearest = np.minimum(nearest, np.hypot(n, e))
    return nearest


def test_nothing_is_drawn_in_the_way_that_steering_would_walk_through(touchable: Floats) -> None:
    assert len(touchable) > 10_000
    assert away(touchable, TOWN).max() < SILLS_M


def test_every_wall_of_the_world_is_drawn_where_it_is(touchable: Floats) -> None:
    boxes = [*(b.box for b in TOWN.buildings), TOWN.landmark, *TOWN.planters, *TOWN.benches]
    for box in boxes:
        inside = touchable[_within(touchable, box, SILLS_M)]
        assert len(inside)
        low, high = inside.min(axis=0), inside.max(axis=0)
        edge = np.array([box.south, box.west, box.north, box.east])
        assert np.abs(np.concatenate([low, high]) - edge).max() < SILLS_M


def test_every_tree_and_lamp_is_drawn() -> None:
    for place in (*TOWN.trees, *TOWN.lamps):
        around = [part.vertices for name, part in parts().items() if name.startswith("block")]
        near = np.concatenate(
            [v[np.hypot(v[:, 0] - place.north, v[:, 1] - place.east) < 0.3] for v in around]
        )
        assert len(near)
        assert -near[:, 2].min() > 3.0


def _within(places: Floats, box: Box, more_m: float) -> np.ndarray:
    low = places > [box.south - more_m, box.west - more_m]
    return np.asarray((low & (places < [box.north + more_m, box.east + more_m])).all(axis=1))


def test_it_draws_fast_on_a_modest_laptop() -> None:
    """What is in one file, at most a third of which lies in view: draw calls and triangles."""
    drawn = [part for name, part in parts().items() if name != "sky"]
    assert len(drawn) <= 27
    assert sum(len(part.faces) for part in drawn) < 300_000
    assert len(town_file()) + len(sky_file()) < 20e6


def test_faces_are_sound() -> None:
    for part in parts().values():
        assert np.isfinite(part.vertices).all()
        assert part.faces.max() < len(part.vertices)
        assert part.colours.min() >= 0.0
        assert part.colours.max() <= 1.0
