"""Steering: never through a wall, never with a jerk, always to rest when nothing is asked for."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gestures.steering import STOP, Comfort, Walker, slide, steer
from app.gestures.words import Decision
from app.motion.basics import MotionId
from app.world import Town, make_town

TOWN = make_town(1)
EMPTY = Town(
    0, 500.0, (), (), (), TOWN.landmark._replace(south=400.0, north=401.0, west=400.0, east=401.0), (), (), ()
)
COMFORT = Comfort()
DT_S = 1 / 60


def wish(motion: MotionId, speed: float = 1.2, turn: float = 0.0) -> Decision:
    return Decision(0, motion, speed, turn, 1.0, True, 1.0, "")


def walked(decision: Decision, seconds: float, start: Walker, town: Town = EMPTY) -> Walker:
    for _ in range(round(seconds / DT_S)):
        start = steer(start, decision, DT_S, town)
    return start


some_wishes = st.builds(
    wish, st.sampled_from(MotionId), st.floats(allow_nan=True, allow_infinity=True), st.floats(-5.0, 5.0)
)


@pytest.mark.parametrize(
    ("motion", "north", "east"),
    [
        (MotionId.FORWARD, 1.0, 0.0),
        (MotionId.BACKWARD, -1.0, 0.0),
        (MotionId.SIDE_RIGHT, 0.0, 1.0),
        (MotionId.SIDE_LEFT, 0.0, -1.0),
        (MotionId.TURN_CW, 0.0, 0.0),
        (MotionId.NONE, 0.0, 0.0),
    ],
)
def test_each_motion_goes_its_way(motion: MotionId, north: float, east: float) -> None:
    """Up to v at a m/s², then on: v t − v² / 2a."""
    way = 1.2 * 5.0 - 1.2**2 / (2 * COMFORT.start_mps2)
    end = walked(wish(motion), 5.0, Walker(0.0, 0.0))
    assert (end.north, end.east) == pytest.approx((north * way, east * way), abs=0.02)


def test_clockwise_from_north_is_to_the_east_and_a_side_step_goes_with_the_heading() -> None:
    east = replace(Walker(0.0, 0.0), heading_rad=0.5 * math.pi)
    assert walked(wish(MotionId.FORWARD), 3.0, east).east > 2.0
    assert walked(wish(MotionId.SIDE_RIGHT), 3.0, east).north < -2.0
    assert 0.4 < walked(wish(MotionId.TURN_CW, 0.0, 0.5), 1.2, Walker(0.0, 0.0)).heading_rad < 0.6


def test_a_walk_with_a_turn_is_a_circle() -> None:
    walker = walked(wish(MotionId.FORWARD_RIGHT, 1.0, 0.5), 2.0, Walker(0.0, 0.0))
    round_trip = walked(wish(MotionId.FORWARD_RIGHT, 1.0, 0.5), math.tau / 0.5, walker)
    assert math.hypot(round_trip.north - walker.north, round_trip.east - walker.east) < 0.05


@given(st.lists(some_wishes, max_size=40), st.floats(0.0, 0.2))
def test_no_wish_makes_a_jerk_or_a_number_that_is_none(wishes: list[Decision], dt_s: float) -> None:
    walker = Walker(0.0, 0.0)
    for decision in wishes:
        after = steer(walker, decision, dt_s, EMPTY)
        change = abs(after.ahead_mps - walker.ahead_mps), abs(after.right_mps - walker.right_mps)
        assert max(change) <= COMFORT.stop_mps2 * min(dt_s, 0.1) + 1e-9
        assert max(abs(after.ahead_mps), abs(after.right_mps)) <= COMFORT.most_mps
        assert math.isfinite(after.north + after.east + after.heading_rad)
        walker = after


@given(some_wishes)
def test_a_stop_is_at_rest_in_less_than_a_second_and_stays(decision: Decision) -> None:
    walker = walked(decision, 2.0, Walker(0.0, 0.0))
    stopped = walked(STOP, 0.8, walker)
    assert stopped.at_rest
    assert walked(decision._replace(speed_mps=math.nan, turn_radps=math.nan), 1.0, stopped) == stopped


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_nobody_walks_through_a_wall_or_out_of_town(seed: int) -> None:
    rng = np.random.default_rng(seed)
    walker = Walker()
    for _ in range(15):
        motion = MotionId(int(rng.integers(1, 9)))
        decision = wish(motion, float(rng.uniform(0.0, 3.0)), float(rng.uniform(-1.5, 1.5)))
        for _ in range(60):
            before, walker = walker, steer(walker, decision, 0.05, TOWN)
            assert TOWN.free(walker.north, walker.east, COMFORT.radius_m - 1e-6)
            moved = math.hypot(walker.north - before.north, walker.east - before.east)
            assert moved < 0.05 * COMFORT.most_mps * 3.0


def test_a_wall_is_slid_along() -> None:
    wall = np.array([[5.0, -50.0, 6.0, 50.0]])
    north, east = slide(4.9, 1.0, wall, 100.0, 0.35)
    assert (north, east) == pytest.approx((4.65, 1.0), abs=1e-6)
    assert slide(4.0, 1.0, wall, 100.0, 0.35) == (4.0, 1.0)


def test_from_within_a_wall_the_way_out_is_the_shortest() -> None:
    wall = np.array([[0.0, 0.0, 10.0, 10.0]])
    assert slide(5.0, 9.5, wall, 100.0, 0.35) == pytest.approx((5.0, 10.35))
    assert slide(0.1, 5.0, wall, 100.0, 0.35) == pytest.approx((-0.35, 5.0))


def test_a_long_pause_is_not_walked_through() -> None:
    walker = walked(wish(MotionId.FORWARD), 2.0, Walker(0.0, 0.0))
    assert steer(walker, wish(MotionId.FORWARD), 60.0, EMPTY).north - walker.north < 0.2
    assert steer(walker, wish(MotionId.FORWARD), math.nan, EMPTY).north == walker.north
