"""The hunt for targets: a clock that starts with the first step, every target once, a best time."""

from __future__ import annotations

import pytest

from app.gestures.hunt import Hunt, begin, go_on, goal
from app.world import make_town

TOWN = make_town()


def walked(hunt: Hunt, seconds: float = 1.0) -> Hunt:
    """Straight to every target, so many seconds each."""
    while hunt.target is not None:
        hunt = go_on(hunt, hunt.target.north, hunt.target.east, True, seconds)
    return hunt


def test_the_clock_waits_for_the_first_step() -> None:
    hunt = begin(TOWN, -30.0, 0.0)
    hunt = go_on(hunt, -30.0, 0.0, False, 5.0)
    assert hunt.seconds == 0.0
    assert go_on(hunt, -30.0, 0.0, True, 5.0).seconds == 5.0


def test_every_target_counts_once_and_the_best_time_stays() -> None:
    first = walked(begin(TOWN, -30.0, 0.0), 2.0)
    assert first.found == len(TOWN.targets)
    assert first.best_s == pytest.approx(2.0 * len(TOWN.targets))
    second = walked(begin(TOWN, -30.0, 0.0, first.best_s), 3.0)
    assert second.best_s == first.best_s
    assert set(first.order) == set(TOWN.targets)


def test_standing_beside_a_target_is_not_enough() -> None:
    hunt = begin(TOWN, -30.0, 0.0)
    target = hunt.target
    assert target
    assert go_on(hunt, target.north + target.radius_m + 0.1, target.east, True, 1.0).found == 0
    found = go_on(hunt, target.north, target.east, True, 1.0)
    assert found.found == 1
    assert found.cheering


def test_the_goal_tells_how_far_the_target_is() -> None:
    hunt = begin(TOWN, -30.0, 0.0)
    target = hunt.target
    assert target
    seen = goal(hunt, target.north - 3.0, target.east + 4.0)
    assert seen
    assert (seen.north, seen.east) == (target.north, target.east)
    assert seen.distance_m == pytest.approx(5.0)
