"""The stroller's ways never lead through walls, and gestures that follow its wishes reach the target."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from app.gestures.steering import Walker, steer
from app.gestures.stroll import Streets, Stroller
from app.gestures.words import Decision
from app.motion.basics import MotionId
from app.world import make_town

TOWN = make_town()
STREETS = Streets(TOWN)


@pytest.mark.parametrize("number", range(len(TOWN.targets)))
def test_a_way_to_every_target_is_clear(number: int) -> None:
    target = TOWN.targets[number]
    way = [(-30.0, 0.0), *STREETS.way(-30.0, 0.0, target)]
    for (north, east), to in pairwise(way):
        for part in np.linspace(0.0, 1.0, 9):
            assert TOWN.free(north + part * (to[0] - north), east + part * (to[1] - east), 0.35)
    assert way[-1] == (target.north, target.east)


@pytest.mark.parametrize("number", [0, 3, 6])
def test_following_the_wishes_leads_to_the_target(number: int) -> None:
    """Half a second late, as feet are."""
    target, stroller, walker, wishes = TOWN.targets[number], Stroller(TOWN), Walker(), []
    for _ in range(400 * 10):
        wishes.append(stroller.wish(walker.north, walker.east, walker.heading_rad, target))
        motion, size = wishes[max(0, len(wishes) - 6)]
        turn = {
            MotionId.FORWARD_RIGHT: 1.0,
            MotionId.TURN_CW: 1.0,
            MotionId.FORWARD_LEFT: -1.0,
            MotionId.TURN_CCW: -1.0,
        }
        decision = Decision(0, motion, 1.2, 0.8 * size * turn.get(motion, 0.0), 1.0, True, 1.0, "")
        walker = steer(walker, decision, 0.1, TOWN)
        if np.hypot(walker.north - target.north, walker.east - target.east) < target.radius_m:
            return
    raise AssertionError(f"never there: {walker}")


def test_without_a_target_nothing_is_done() -> None:
    assert Stroller(TOWN).wish(0.0, 0.0, 0.0, None).motion is MotionId.NONE
