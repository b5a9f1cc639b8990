"""The tab for before the walk: words, shapes, a picture for every pose, no markup from outside."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

import pytest

from app.calibration.guide import Guide
from app.calibration.steps import FIELD_STEPS, STEPS
from app.motion.status import CalibrationView, GuideView, Line, LineState, PreflightView
from app.scene import pictures
from app.scene.before import applied, guide, preflight

GUIDE = GuideView("s", 2, 10, "Roll it over.", "y-", 0.4, "", 0.25, frozenset({1, 5}), False)


@pytest.mark.parametrize("name", sorted({step.picture for step in STEPS + FIELD_STEPS}))
def test_each_step_has_a_picture_of_its_own(name: str) -> None:
    picture = pictures.pose(name)
    ET.fromstring(picture)
    others = {pictures.pose(step.picture) for step in STEPS + FIELD_STEPS if step.picture != name}
    assert picture not in others
    assert {"x", "y", "z"} <= set(re.findall(r">([xyz])</text>", picture))


def test_the_axis_that_is_down_is_drawn_lowest() -> None:
    for name in ("x+", "y+", "z+"):
        height = dict(re.findall(r'y="(-?[\d.]+)" fill="[^"]+">([xyz])<', pictures.pose(name)))
        lowest = max(height, key=float)
        assert height[lowest] == name[0]


def test_seen_directions_are_coloured() -> None:
    sky = pictures.sky(frozenset({0, 13, 71}))
    ET.fromstring(sky)
    assert sky.count("ss-seen") == 3
    assert sky.count("<polygon") == 72


def test_a_guide_shows_step_words_picture_and_progress() -> None:
    text = guide(CalibrationView(("s",), {}, (), GUIDE))
    for told in ("Step 3 of 10", "Roll it over.", "width:40%", "25 % of directions", "<svg"):
        assert told in text
    assert "Appendix B" in guide(CalibrationView((), {}, ()))
    found = CalibrationView(("s",), {}, (), Guide("s").view()._replace(done=True), ("null <b>",))
    assert "null &lt;b&gt;" in guide(found)


def test_what_is_applied_is_said_of_each_sensor() -> None:
    text = applied(CalibrationView(("left", "<right>", "x"), {"left": "2026-11-22"}, ("x",)))
    assert "corrected; calibrated 2026-11-22" in text
    assert "&lt;right&gt;" in text
    assert "undone" in text
    assert "recording is left" in applied(CalibrationView((), {}, ()))
    assert "ss-bad" in applied(CalibrationView(("a",), {}, (), damaged="file x: not JSON"))


def test_a_preflight_line_has_a_shape_and_words() -> None:
    lines = tuple(Line(f"line {state.value}", state, f"told <{state.value}>") for state in LineState)
    text = preflight(PreflightView(lines, "", False, False, 12.0, ()))
    for shape in "✓■▶·":
        assert shape in text
    assert "told &lt;now&gt;" in text
    assert "Ready to walk." in preflight(PreflightView(lines[2:3], "", True, True, 31.0, ()))
    assert "with remarks" in preflight(PreflightView(lines[3:], "", True, False, 31.0, ()))
    assert "Press Check" in preflight(None)
