"""One foot of the default decoder: actions made by hand, whose angle is known."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from app.gestures.foot import step_foot
from app.gestures.state import BACK, FOOT, STEP, TOE_UP, TWIST, Record
from app.motion.basics import Vector

DT_S = 0.01
G = 9.80665


def moved(*parts: tuple[float, Vector], down: Vector = (0.0, 0.0, 1.0)) -> Record:
    """A foot that rests for a second, turns (seconds, angles about its axes) and rests for half a second."""
    foot = np.zeros(1, FOOT)
    foot["on_s"] = foot["previous_on_s"] = foot["end_s"] = -1e9
    t = 0.0
    rests: Sequence[tuple[float, Vector]] = [(1.0, (0.0, 0.0, 0.0)), *parts, (0.5, (0.0, 0.0, 0.0))]
    for seconds, angles in rests:
        count = round(seconds / DT_S)
        for i in range(count):
            # a sine's half wave: it sums to the angle
            shape = 0.5 * math.pi * math.sin(math.pi * (i + 0.5) / count) / seconds
            rate = (shape * angles[0], shape * angles[1], shape * angles[2])
            t += DT_S
            force = (-G * down[0], -G * down[1], -G * down[2])
            step_foot(foot[0], t, force, rate, 0.5, 0.25, 0.07)
    return foot


@pytest.mark.parametrize("yaw", [0.4, -0.4])
def test_a_turn_about_down_is_a_twist_of_its_angle(yaw: float) -> None:
    foot = moved((0.3, (0.0, 0.0, yaw)), (0.3, (0.0, 0.0, -yaw)))[0]
    assert (foot["kind"], foot["actions"], foot["moving"]) == (TWIST, 1.0, 0.0)
    assert foot["size"] == pytest.approx(0.4, rel=0.02)
    assert foot["duration_s"] == pytest.approx(0.6, abs=0.05)


@pytest.mark.parametrize(
    ("first", "then", "kind"), [(-0.5, 0.5, STEP), (0.2, -0.2, TOE_UP), (0.3, -0.6, BACK)]
)
def test_the_end_that_rises_first_makes_the_kind(first: float, then: float, kind: float) -> None:
    foot = moved((0.25, (0.0, first, 0.0)), (0.3, (0.0, then, 0.0)), (0.2, (0.0, -first - then, 0.0)))[0]
    assert foot["kind"] == kind
    assert foot["actions"] == 1.0


def test_a_turn_too_small_is_no_action() -> None:
    foot = moved((0.1, (0.0, -0.05, 0.0)), (0.1, (0.0, 0.05, 0.0)))[0]
    assert foot["actions"] == 0.0


def test_a_turn_too_slow_is_no_action() -> None:
    foot = moved((1.0, (0.0, 0.0, 0.2)), (1.0, (0.0, 0.0, -0.2)))[0]
    assert foot["actions"] == 0.0


@pytest.mark.parametrize("roll", [-0.3, 0.3])
def test_down_is_gravitys_not_the_sensors(roll: float) -> None:
    """A sensor rolled on its side turns about the true vertical with two of its axes."""
    down = (0.0, math.sin(roll), math.cos(roll))
    out = (0.0, 0.4 * down[1], 0.4 * down[2])
    foot = moved((0.3, out), (0.3, (0.0, -out[1], -out[2])), down=down)[0]
    assert foot["kind"] == TWIST
    assert foot["size"] == pytest.approx(0.4, rel=0.02)


def test_two_actions_are_two() -> None:
    there, back = (0.25, (0.0, -0.5, 0.0)), (0.25, (0.0, 0.5, 0.0))
    foot = moved(there, back, (0.3, (0.0, 0.0, 0.0)), there, back)[0]
    assert foot["actions"] == 2.0
    assert foot["on_s"] - foot["previous_on_s"] == pytest.approx(0.8, abs=0.02)
