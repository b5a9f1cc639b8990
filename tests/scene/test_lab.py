"""The lab tab: one slider for each error, lessons by name, a pendulum that turns and not walks."""

from __future__ import annotations

from dataclasses import asdict, replace

import pytest

from app.motion.door import GuiRule
from app.motion.snapshot import PendulumView
from app.rotation import from_yaw_pitch_roll
from app.scene import figures, private, swinging
from app.scene.page import Scene
from app.simulate.lab import LESSONS, LIMITS, PERFECT
from tests.scene import fakes
from tests.scene.test_words import read


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
    scene.draw(fakes.snapshot(3.0), replace(fakes.status(), errors=asdict(PERFECT), lesson=name))
    assert name in scene.panel._lab._notice._text
    assert any(name in rule.choices for rule in scene.rules().values())


def test_a_pendulum_hangs_instead_of_the_shoes(scene: Scene) -> None:
    status = fakes.status()
    swung = from_yaw_pitch_roll(0.0, 0.4, 0.0)
    shot = fakes.snapshot(3.0)
    scene.draw(shot, status)
    assert scene._server.scene.get_handle_by_name("/ned/foot") is not None
    scene.draw(replace(shot, pendulum=PendulumView(1.0, true_q_nb=swung)), status)
    assert scene._server.scene.get_handle_by_name("/ned/foot") is None
    truth = scene._server.scene.get_handle_by_name("/ned/pendulum/truth")
    assert truth is not None
    assert tuple(truth.wxyz) == pytest.approx(swung)
    scene.draw(fakes.snapshot(3.2), status)
    assert scene._server.scene.get_handle_by_name("/ned/pendulum") is None
    assert scene._server.scene.get_handle_by_name("/ned/foot") is not None


def test_the_pendulums_graphs_are_angles(scene: Scene) -> None:
    scene.panel.show_graphs(replace(fakes.snapshot(3.0), pendulum=PendulumView(1.0)))
    sent = private.broadcast_messages(scene._server)
    titles = [m.props.title for m in sent if type(m).__name__ == "GuiUplotMessage"]
    assert "Angle, ° (dashed truth)" in titles
    assert "Speed, m/s" not in titles


def test_the_pendulums_card_has_angles_and_periods_and_no_walks_figures() -> None:
    view = PendulumView(1.0, angle_rad=0.2, true_rad=0.15, worst_rad=0.1, period_s=2.024, true_period_s=None)
    text = read(swinging.card(view, fakes.snapshot(3.0))).text
    for said in ("Angle11.5 °", "True angle8.6 °", "Error2.86 °", "5.73 °", "Period2.02 s", "True period–"):
        assert said in text
    assert "Stride" not in text
    assert "Distance" not in text


def test_a_candidate_pendulum_is_held_against_the_truth() -> None:
    shot = fakes.snapshot(3.0, candidate=True)
    assert shot.candidate is not None
    feet = tuple(f._replace(q_nb=from_yaw_pitch_roll(0.0, 0.3, 0.0)) for f in shot.candidate.feet)
    shot = replace(shot, candidate=shot.candidate._replace(feet=feet))
    text = read(figures.comparison(shot, swinging.compared(PendulumView(1.0, true_rad=0.1)))).text
    assert "11.46 °" in text
    assert "Strides" not in text
