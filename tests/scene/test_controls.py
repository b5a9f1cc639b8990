from __future__ import annotations

import math
import time
from dataclasses import replace

import pytest

from app.motion.commands import (
    ApplyCandidate,
    DropCandidate,
    FindGains,
    KeepAs,
    LoadProfile,
    Loop,
    Order,
    Pause,
    ReplaceCandidate,
    ResetHeading,
    RestartHere,
    SaveProfile,
    Seek,
    SetApplyAtOnce,
    SetCandidate,
    Speed,
    Step,
    SwapAB,
    Undo,
)
from app.motion.door import GuiRule
from app.scene import controls, private
from app.scene.page import Scene
from app.scene.replaying import factor
from app.settings import BUILT_IN, LIMITS, Settings
from tests.scene import fakes
from tests.scene.browsers import client, until


def control(scene: Scene, label: str, rule_kind: str | None = None) -> str:
    """The control of this label, or the row of buttons with this button."""
    for uuid, handle in private.inputs(scene._server).items():
        rule = scene.rules().get(uuid)
        named = getattr(handle, "label", None) == label or (rule is not None and label in rule.choices)
        if named and (rule_kind is None or (rule is not None and rule.kind == rule_kind)):
            return uuid
    raise AssertionError(f"no control {label!r}")


def test_every_input_has_a_rule_and_every_rule_an_input(scene: Scene) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status())
    takes = {
        uuid for uuid, handle in private.inputs(scene._server).items()
        if type(handle).__name__ != "GuiProgressBarHandle"
    }  # fmt: skip
    assert set(scene.rules()) == takes
    assert len(takes) > 25


def test_rules_are_narrow(scene: Scene) -> None:
    kinds = {"number", "bool", "text", "choice", "button"}
    for rule in scene.rules().values():
        assert rule.kind in kinds
        if rule.kind == "number":
            assert math.isfinite(rule.low)
            assert math.isfinite(rule.high)
        if rule.kind == "choice":
            assert rule.choices
        if rule.kind == "text":
            assert rule.max_length <= 80


PRESSES = {
    "Apply": ApplyCandidate(), "Drop": DropCandidate(), "Undo": Undo(), "Keep as A": KeepAs("A"),
    "Keep as B": KeepAs("B"), "Swap": SwapAB(), "Reset heading": ResetHeading(),
    "Restart from here": RestartHere(),
    "Play": Pause(False), "Pause": Pause(True), "Step": Step(),
    "Reset all sliders": ReplaceCandidate(BUILT_IN["default"], "all sliders reset"),
}  # fmt: skip
WRITES = [
    ("Apply at once", True, SetApplyAtOnce(True)), ("Loop", True, Loop(True)),
    ("Position, s", 12.5, Seek(12.5)),
    ("Speed, ×", 0.0, Speed(0.0)), ("Stance gain k_s, 1/s", 1.5, SetCandidate((("gain_stance", 1.5),))),
    ("Magnetometer", True, SetCandidate((("magnetometer", True),))),
    ("Start heading ψ_0, °", 180.0, SetCandidate((("start_heading_rad", math.pi),))),
]  # fmt: skip


def test_buttons_ask_for_their_commands(scene: Scene, orders: list[Order]) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status())
    with client(scene.port) as browser:
        for label, command in PRESSES.items():
            browser.write(control(scene, label), label)
            until(lambda: orders and orders[-1].command == command)  # noqa: B023
        browser.write(control(scene, "Find gains"), True)
        until(lambda: orders[-1].command == FindGains())
    assert all(order.who.startswith("browser ") for order in orders)
    assert all(abs(time.monotonic_ns() - order.host_ns) < 60e9 for order in orders)


@pytest.mark.parametrize(("label", "value", "command"), WRITES, ids=[w[0] for w in WRITES])
def test_values_ask_for_their_commands(
    scene: Scene, orders: list[Order], label: str, value: object, command: object
) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status())
    with client(scene.port) as browser:
        browser.write(control(scene, label), value)
        until(lambda: orders)
    assert [order.command for order in orders] == [command]


def test_a_fast_drag_arrives_in_order(scene: Scene, orders: list[Order]) -> None:
    values = [round(0.01 * i, 2) for i in range(1, 120)]
    with client(scene.port) as browser:
        for value in values:
            browser.write(control(scene, "Stance gain k_s, 1/s"), value)
        until(lambda: len(orders) == len(values))
    assert [o.command for o in orders] == [SetCandidate((("gain_stance", v),)) for v in values]


def test_each_setting_has_its_reset(scene: Scene, orders: list[Order]) -> None:
    resets = scene.panel._tuning.resets
    assert len(resets) == len(LIMITS) == len(scene.panel.tuned())
    with client(scene.port) as browser:
        browser.write(resets[0].id, True)
        until(lambda: orders)
    assert orders[0].command == SetCandidate((("estimator", BUILT_IN["default"].estimator),))


def test_only_what_the_estimator_reads_is_on_the_page(scene: Scene) -> None:
    for settings in (Settings(), BUILT_IN["default"], Settings(estimator="kalman", detector="rate")):
        scene.panel._tuning.show(fakes.snapshot(5.0, candidate_settings=settings))
        shown = {name for name, control in scene.panel.tuned().items() if control.handle.visible}
        assert "estimator" in shown
        assert ("gain_stance" in shown) == (settings.estimator == "papers")
        assert ("sensor_height_m" in shown) == (settings.estimator == "kalman")
        assert ("min_duration_s" in shown) == (settings.estimator == "papers" or settings.detector == "rate")
        assert len(shown) == sum(reset.handle.visible for reset in scene.panel._tuning.resets)


def test_profiles(scene: Scene, orders: list[Order]) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status(profiles=("papers", "<b>mine</b>")))
    load = control(scene, "Load")
    assert scene.rules()[load].choices[1:] == ("papers", "<b>mine</b>")
    with client(scene.port) as browser:
        browser.write(load, "papers")
        until(lambda: orders)
        browser.write(control(scene, "Save profile"), "Save profile")  # no name yet: it will be told so
        browser.write(control(scene, "Save as"), " corridor ")
        browser.write(control(scene, "Save profile"), "Save profile")
        until(lambda: len(orders) == 3)
    assert [o.command for o in orders] == [LoadProfile("papers"), SaveProfile(""), SaveProfile("corridor")]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e300, -1.0])
def test_a_number_that_cannot_be_is_not_heard(bad: float) -> None:
    assert not controls.in_range(bad, GuiRule("number", 0.0, 50.0))


def test_the_page_shows_what_the_session_says(scene: Scene) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status())
    held = Settings(gain_stance=2.25, magnetometer=True, start_heading_rad=math.radians(30))
    scene._next_text = 0.0
    scene.draw(
        fakes.snapshot(5.0, candidate_settings=held, apply_at_once=True), fakes.status(loop=True, speed=2.0)
    )
    shown = {name: i.handle.value for name, i in scene.panel.tuned().items()}
    assert shown["gain_stance"] == 2.25
    assert shown["magnetometer"] is True
    assert shown["start_heading_rad"] == pytest.approx(30.0)
    inputs = private.inputs(scene._server)
    assert inputs[control(scene, "Apply at once")].value is True
    assert inputs[control(scene, "Speed, ×")].value == 2.0


def test_a_value_outside_the_safe_range_widens_its_slider(scene: Scene) -> None:
    scene.draw(fakes.snapshot(5.0, candidate_settings=Settings(gain_stance=20.0)), fakes.status())
    slider = scene.panel.tuned()["gain_stance"]
    assert (slider.handle.value, slider.handle.max, slider.handle.min) == (20.0, 20.0, 0.0)
    rule = scene.rules()[slider.id]
    assert rule.low <= 0.0 <= 50.0 <= rule.high


def shown_as(control: controls.Input, value: float) -> bool:
    control.show(value)
    return bool(control.handle.value == value)


def test_the_hand_on_a_slider_is_not_fought(scene: Scene, orders: list[Order]) -> None:
    """While a browser drags, the session's older value is not sent back; later it is."""
    slider = scene.panel.tuned()["gain_stance"]
    with client(scene.port) as browser:
        browser.write(slider.id, 2.0)
        until(lambda: orders)
        slider.show(1.05)
        assert slider.handle.value == 2.0
        until(lambda: shown_as(slider, 1.05))
    slider.show(1.3)  # our own write does not hold us off
    assert slider.handle.value == 1.3


def test_setting_a_value_asks_for_nothing(scene: Scene, orders: list[Order]) -> None:
    scene.draw(fakes.snapshot(5.0, candidate_settings=Settings(gain_stance=2.0)), fakes.status(loop=True))
    time.sleep(0.2)
    assert orders == []


def test_speeds() -> None:
    assert [factor(v) for v in (0.0, 0.04, 0.07, 1.0, 8.0, 99.0)] == [0.0, 0.0, 0.1, 1.0, 8.0, 8.0]


def test_replay_controls_only_for_a_replay(scene: Scene) -> None:
    scene.draw(fakes.snapshot(5.0), replace(fakes.status(), replay=False))
    assert scene.panel._replaying._folder.visible is False
