"""The town as data: the same from the same seed, nothing in the way of a street, every target free."""

from __future__ import annotations

import numpy as np
import pytest

from app.world import Box, Town, make_town

SEEDS = range(12)


@pytest.fixture(scope="module", params=SEEDS)
def town(request: pytest.FixtureRequest) -> Town:
    return make_town(int(request.param))


def overlap(a: Box, b: Box) -> bool:
    return a.south < b.north and b.south < a.north and a.west < b.east and b.west < a.east


def test_a_seed_is_a_town_and_another_seed_another() -> None:
    assert make_town(3) == make_town(3)
    assert make_town(3).buildings != make_town(4).buildings


def test_boxes_have_an_inside_and_lie_in_town(town: Town) -> None:
    for box in [
        *town.blocks,
        town.landmark,
        *(b.box for b in town.buildings),
        *(s.box for s in town.streets),
    ]:
        assert box.south < box.north
        assert box.west < box.east
        assert max(np.abs(box[:4])) <= town.half_m


def test_no_building_overlaps_a_street_or_another_building(town: Town) -> None:
    boxes = [building.box for building in town.buildings]
    for i, box in enumerate(boxes):
        assert not any(overlap(box, street.box) for street in town.streets)
        assert not any(overlap(box, other) for other in boxes[:i])


def test_buildings_stand_on_blocks_and_the_square_has_none(town: Town) -> None:
    for building in town.buildings:
        on = [b for b in town.blocks if overlap(b, building.box)]
        assert len(on) == 1
        assert not overlap(on[0], town.landmark)


def test_trees_and_lamps_leave_the_roadway_free(town: Town) -> None:
    for place in (*town.trees, *town.lamps):
        around = Box(place.north - 0.1, place.east - 0.1, place.north + 0.1, place.east + 0.1, 1.0)
        assert not any(overlap(around, street.box) for street in town.streets)


def test_targets_are_free_apart_and_away_from_the_start(town: Town) -> None:
    assert len(town.targets) == 8
    for i, target in enumerate(town.targets):
        assert town.free(target.north, target.east, target.radius_m)
        assert np.hypot(target.north, target.east) > 25.0
        for other in town.targets[:i]:
            assert np.hypot(target.north - other.north, target.east - other.east) > 25.0


def test_free_is_false_in_walls_and_beyond_the_edge(town: Town) -> None:
    box = town.buildings[0].box
    assert not town.free(0.5 * (box.south + box.north), 0.5 * (box.west + box.east), 0.1)
    assert not town.free(box.south - 0.05, 0.5 * (box.west + box.east), 0.1)
    assert not town.free(town.half_m, 0.0, 0.1)
    assert town.free(-8.0, 0.0, 0.35)  # where a walker starts
