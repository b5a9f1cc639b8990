"""The lab tab: one slider for each error, lessons by name, a pendulum that turns and not walks."""

from __future__ import annotations

from dataclasses import asdict, replace

import pytest

from app.motion import GuiRule
from app.rotation import from_yaw_pitch_roll
from app.scene import lab, private
from app.scene.page import Scene
from app.simulate.lab import LESSONS, LIMITS, PERFECT
from tests.scene import fakes


def test_every_error_has_its_slider_and_its_rule(scene: Scene) -> None:
    tab = scene.panel._lab
    assert set(tab._errors) == set(LIMITS)
    for name, control in tab._errors.items():
        rule: GuiRule = scene.rules()[control.id]
        assert (rule.low, rule.high) == (LIMITS[name].low, LIMITS[name].high)
        assert control.handle.hint == LIMITS[name].sentence


def test_it_shows_the_errors_and_hides_without_a_simulation(scene: Scene) -> None:
    tab = scene.panel._lab
    errors = asdict(PERFECT) | {"noise": 7.0}
    scene.draw(fakes.snapshot(3.0), replace(fakes.status(), errors=errors))
    assert tab._errors["noise"].handle.value == 7.0
    assert tab._sensor.visible
    scene._next_text = 0.0
    scene.draw(fakes.snapshot(3.1), fakes.status())
    assert not tab._sensor.visible


@pytest.mark.parametrize("name", [x.name for x in LESSONS])
def test_a_lesson_is_asked_for_and_said(scene: Scene, name: str) -> None:
    tab = scene.panel._lab
    assert tab._lesson(name)().name == name
    assert name in lab.notice(tab._taken)


def test_a_pendulum_hangs_instead_of_the_shoes(scene: Scene) -> None:
    status = fakes.status()
    swung = from_yaw_pitch_roll(0.0, 0.4, 0.0)
    shot = fakes.snapshot(3.0)
    foot = shot.main.feet[0]._replace(true_q_nb=swung)
    shot = replace(shot, main=shot.main._replace(feet=(foot,)))
    scene.draw(shot, status)
    assert scene._server.scene.get_handle_by_name("/ned/foot") is not None
    hanging = replace(status, source=replace(status.source, rod_m=1.0))
    scene.draw(shot, hanging)
    assert scene._server.scene.get_handle_by_name("/ned/foot") is None
    truth = scene._server.scene.get_handle_by_name("/ned/pendulum/truth")
    assert truth is not None
    assert tuple(truth.wxyz) == pytest.approx(swung)
    scene.draw(fakes.snapshot(3.2), status)
    assert scene._server.scene.get_handle_by_name("/ned/pendulum") is None
    assert scene._server.scene.get_handle_by_name("/ned/foot") is not None


def test_the_pendulums_graphs_are_angles(scene: Scene) -> None:
    scene.panel.show_graphs(fakes.snapshot(3.0), hanging=True)
    sent = private.broadcast_messages(scene._server)
    titles = [m.props.title for m in sent if type(m).__name__ == "GuiUplotMessage"]
    assert "Angle, ° (dashed truth)" in titles
    assert "Speed, m/s" not in titles
