"""The guided set-up, done by simulated visitors: lively and timid ones, with swapped feet, with trembling."""

from __future__ import annotations

import numpy as np
import pytest

from app.gestures.default import DefaultDecoder, DefaultSettings
from app.gestures.merge import readings
from app.gestures.setup import STEPS, Fitted, SetUpGuide
from app.gestures.words import FootReading
from app.motion.basics import MotionId, Role
from app.simulate.gestures import make_gestures
from app.simulate.gestures_live import LiveFeet
from app.simulate.gestures_options import parse

SCRIPT = "none:3.2,forward:5,turn_ccw:4,turn_cw:4,side_right:4,none:6"
#: What a visitor does when a step is said, and the same by the other foot.
DOES = {
    "March in place": MotionId.FORWARD, "Turn left": MotionId.TURN_CCW, "Turn right": MotionId.TURN_CW,
    "Step aside": MotionId.SIDE_RIGHT,
}  # fmt: skip
MEANT = ("Turn left", "Turn right", "Step aside")
OTHER_FOOT = {
    MotionId.TURN_CCW: MotionId.TURN_CW, MotionId.TURN_CW: MotionId.TURN_CCW,
    MotionId.SIDE_RIGHT: MotionId.SIDE_LEFT,
}  # fmt: skip
_OTHER = {Role.LEFT: Role.RIGHT, Role.RIGHT: Role.LEFT}


def performed(script: str = SCRIPT, **options: object) -> list[FootReading]:
    made = make_gestures({"script": script, **{k: str(v) for k, v in options.items()}})
    return list(readings({samples.role: samples for samples in made.recording.sensors}))


def guided(all_: list[FootReading], swapped: bool = False) -> SetUpGuide:
    guide = SetUpGuide(DefaultSettings())
    for reading in all_:
        guide.take(reading._replace(foot=_OTHER[reading.foot]) if swapped else reading)
    return guide


def followed(mistakes: list[dict[str, bool]], swapped: bool, seed: int = 0) -> tuple[SetUpGuide, bool]:
    """A visitor who does what is said 0.6 s later, some steps of a round with the other foot; asked again?"""
    guide, feet, again = SetUpGuide(DefaultSettings()), LiveFeet(parse({"seed": str(seed)})), False
    said: list[MotionId] = []
    for tick in range(1600):
        again = again or "once more, with" in guide.task.note
        other = mistakes[again].get(guide.task.title, False)
        meant = DOES.get(guide.task.title, MotionId.NONE)
        said.append(OTHER_FOOT[meant] if other else meant)
        feet.ask(said[max(0, tick - 30)])
        for sample in feet.advance(tick * 0.02, 0, round(tick * 2e7)):
            foot = Role(sample.sensor)
            reading = FootReading(foot, sample.device_ns, sample.specific_force_b, sample.angular_rate_b)
            guide.take(reading._replace(foot=_OTHER[foot]) if swapped else reading)
    return guide, again


def fitted(guide: SetUpGuide) -> Fitted:
    assert guide.fitted is not None, guide.task
    return guide.fitted


@pytest.mark.parametrize("seed", range(4))
def test_twenty_seconds_are_enough(seed: int) -> None:
    assert sum(step.seconds for step in STEPS) == 20.0
    result = fitted(guided(performed(seed=seed)))
    assert not result.swapped
    assert "Left is left" in result.words


@pytest.mark.parametrize("seed", range(4))
def test_swapped_feet_are_seen(seed: int) -> None:
    result = fitted(followed([{}, {}], True, seed)[0])
    assert result.swapped
    assert "swapped" in result.words


@pytest.mark.parametrize(("swapped", "wrong"), [(False, 1), (False, 2), (True, 1)])
def test_one_step_with_the_other_foot_changes_no_verdict_and_two_are_asked_again(
    swapped: bool, wrong: int
) -> None:
    guide, again = followed([dict.fromkeys(MEANT[:wrong], True), {}], swapped)
    assert again == (swapped or wrong == 2)
    assert fitted(guide).swapped == swapped


def test_whose_feet_stay_unclear_keeps_them_as_they_were() -> None:
    mistaken = {"Turn left": True, "Turn right": True}
    guide, again = followed([mistaken, mistaken], False)
    assert again
    assert not fitted(guide).swapped
    assert "not clear" in fitted(guide).words


def test_a_step_during_which_a_sensor_was_silent_begins_anew() -> None:
    """What one foot did meanwhile does not count, nor does the time that passed."""
    guide, all_ = SetUpGuide(DefaultSettings()), performed(seed=1)
    began_ns = all_[0].t_ns
    for reading in all_:
        if reading.t_ns - began_ns > 7_000_000_000:
            break
        guide.take(reading)
    assert guide.task.title == "March in place"
    guide.wait("A sensor was silent.")
    assert (guide.task.title, guide.task.part) == ("March in place", 0.0)
    assert "silent" in guide.task.note
    much_later = all_[-1]._replace(t_ns=all_[-1].t_ns + 60_000_000_000)
    guide.take(much_later)
    assert (guide.task.title, guide.task.part) == ("March in place", 0.0)


def test_a_timid_visitor_gets_lower_thresholds_that_hear_them() -> None:
    timid = fitted(guided(performed(amplitude=0.4, seed=2))).settings
    lively = fitted(guided(performed(amplitude=1.3, seed=2))).settings
    assert timid.on_radps < lively.on_radps
    assert timid.sure_rad < lively.sure_rad
    decoder = DefaultDecoder(timid)
    heard = [d for r in performed("none:2,forward:6", amplitude=0.4, seed=9) if (d := decoder.take(r))]
    assert any(d.motion.name == "FORWARD" and d.certain for d in heard)


def test_who_does_nothing_is_asked_again_and_nothing_is_set() -> None:
    guide = guided(performed("none:15"))
    assert guide.fitted is None
    assert guide.task.title == "March in place"
    assert "Nothing was heard" in guide.task.note


def test_who_does_not_stand_still_is_asked_again() -> None:
    guide = guided(performed("forward:6"))
    assert guide.task.title == "Stand still"
    assert "not still" in guide.task.note


def test_rubbish_does_not_end_it() -> None:
    all_ = performed()
    broken = all_[100]._replace(angular_rate_b=(np.nan, 0.0, 0.0))
    assert not fitted(guided([*all_[:100], broken, *all_[100:]])).swapped
