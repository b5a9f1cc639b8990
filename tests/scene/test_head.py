from __future__ import annotations

import json
import re

from app.scene.page import Scene


def presses(scene: Scene) -> dict[str, dict[str, object]]:
    found = re.search(r"const presses = (\{.*\});", scene.head)
    assert found
    return json.loads(found.group(1))


def test_each_key_presses_a_control_with_a_value_its_rule_allows(scene: Scene) -> None:
    asked = presses(scene)
    assert set(asked) == {"b", "c", "r", "escape", " ", "m"}
    for message in asked.values():
        rule = scene.rules()[str(message["uuid"])]
        assert message["updates"]["value"] in rule.choices  # type: ignore[index]


def test_title_style_and_script_are_closed(scene: Scene) -> None:
    assert scene.head.startswith("<title>Stridescope</title>")
    for tag in ("title", "style", "script"):
        assert scene.head.count(f"<{tag}>") == scene.head.count(f"</{tag}>") == 1


def test_nothing_is_left_to_fill_in(scene: Scene) -> None:
    assert "KEY_PRESSES" not in scene.head
    assert "RESETS" not in scene.head
    assert "http" not in scene.head.replace("https://", "http://").split("<script>")[0]


def test_no_word_that_changes_makes_a_browser_look_at_the_whole_page_again(scene: Scene) -> None:
    assert ":has(" not in scene.head.split("<script>")[0]
