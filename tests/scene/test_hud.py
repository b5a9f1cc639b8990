"""What the script over the town is told: never markup, always numbers that JSON knows."""

from __future__ import annotations

import html
import json
import math
import re
from dataclasses import replace

import pytest

from app.motion.basics import MotionId
from app.scene import hud, mover_panel
from app.visit import Goal, Task, Visit
from app.visiting import Visiting
from app.world import make_town

TOWN = make_town()


@pytest.fixture(scope="module")
def visit() -> Visit:
    return Visiting(TOWN).still(0, "")


def told(visit: Visit) -> dict:
    match = re.search(r'data-state="([^"]*)"', hud.data(visit))
    assert match
    return json.loads(html.unescape(match[1]))


def test_words_of_others_stay_words(visit: Visit) -> None:
    evil = '"><img src=x onerror=alert(1)>'
    data = hud.data(replace(visit, fault=evil, reason=evil, message=evil))
    assert "<img" not in data
    assert told(replace(visit, fault=evil))["fault"] == evil
    assert "<img" not in mover_panel.header(replace(visit, feet_from=evil, fault=evil))


def test_numbers_that_are_none_never_reach_the_page(visit: Visit) -> None:
    state = told(replace(visit, speed_mps=math.nan, turn_radps=math.inf))
    assert (state["speed"], state["turn"]) == (0.0, 0.0)


def test_every_motion_has_words(visit: Visit) -> None:
    for motion in MotionId:
        assert told(replace(visit, motion=motion))["motion"]


def test_goal_and_task_are_told(visit: Visit) -> None:
    task = Task("March", "Both feet.", 0.5, 2, 5, None, "")
    state = told(replace(visit, goal=Goal(3.0, 4.0, 1.5, 5.2), task=task))
    assert state["goal"] == {"north": 3.0, "east": 4.0, "metres": 5}
    assert state["task"]["title"] == "March"


def test_the_map_is_the_town() -> None:
    plan = hud.plan(TOWN)
    assert len(plan["houses"]) == len(TOWN.buildings)
    assert plan["half"] == TOWN.half_m
