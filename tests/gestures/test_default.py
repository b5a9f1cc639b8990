"""The default decoder on simulated feet, and what it does when a sensor fails."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.gestures.default import DefaultDecoder, words
from app.gestures.merge import changes, decode, readings
from app.gestures.words import GENTLE_MPS, Decision
from app.motion.basics import MotionId, Role
from app.simulate.gestures import Bout, SimulatedGestures
from tests.gestures.feet import feet_of, performed, still

GESTURES = [motion for motion in MotionId if motion]


def decided(made: SimulatedGestures) -> list[Decision]:
    return decode(DefaultDecoder(), feet_of(made))


def at(decisions: list[Decision], t_s: float) -> Decision:
    return [d for d in decisions if d.t_ns <= t_s * 1e9][-1]


def only_bout(made: SimulatedGestures) -> Bout:
    (bout,) = made.bouts
    return bout


@pytest.mark.parametrize("amplitude", ["0.3", "1", "1.5"])
@pytest.mark.parametrize("motion", GESTURES, ids=lambda m: m.name)
def test_each_gesture_is_recognised_within_a_cycle_and_then_held(motion: MotionId, amplitude: str) -> None:
    made = performed(f"none:2,{motion.name.lower()}:8,none:3", amplitude=amplitude, vary="0", hesitation="0")
    bout, decisions = only_bout(made), decided(made)
    for t in np.arange(bout.onset_s + bout.cycle_s + 0.2, bout.end_s, 0.05):
        assert at(decisions, float(t)).motion == motion
    assert at(decisions, bout.end_s + 1.2).motion == MotionId.NONE


def test_a_hundred_varied_bouts_are_read_right() -> None:
    made = performed("random:96", seed="31")
    decisions, wrong, frames = decided(made), 0, 0
    stamps = np.array([d.t_ns * 1e-9 for d in decisions])
    for bout in made.bouts:
        for t in np.arange(bout.onset_s + bout.cycle_s + 0.2, bout.end_s, 0.02):
            frames += 1
            wrong += decisions[int(np.searchsorted(stamps, t, side="right")) - 1].motion != bout.motion
    assert wrong < 0.01 * frames


def test_before_the_class_is_certain_it_goes_gently_and_never_sideways() -> None:
    for decision in decided(performed("random:32", seed="32")):
        if not decision.certain:
            assert decision.speed_mps <= GENTLE_MPS
            assert decision.motion not in (MotionId.SIDE_LEFT, MotionId.SIDE_RIGHT)


@pytest.mark.parametrize("cadence", ["0.6", "1.0", "1.4", "1.8"])
def test_speed_follows_the_cadence(cadence: str) -> None:
    made = performed("none:2,forward:12,none:1", cadence=cadence, vary="0.3", hesitation="0")
    bout = only_bout(made)
    last = at(decided(made), bout.end_s - 0.01)
    assert last.cadence_hz == pytest.approx(1.0 / bout.cycle_s, rel=0.03)
    assert last.speed_mps == pytest.approx(1.2 / bout.cycle_s, rel=0.03)


def test_a_wider_twist_turns_faster() -> None:
    turns = []
    for amplitude in ("0.4", "0.8", "1.2"):
        made = performed("none:2,turn_ccw:8", amplitude=amplitude, vary="0")
        turns.append(-at(decided(made), only_bout(made).end_s - 0.1).turn_radps)
    assert 0.0 < turns[0] < 0.7 * turns[1] < 0.6 * turns[2]


def test_shifting_the_weight_and_tapping_move_nothing() -> None:
    assert changes(decided(performed("none:3,shift:60,tap:30", seed="5"))) == []


def test_the_reason_tells_what_a_tapping_foot_lacks() -> None:
    assert any("raises its toe" in d.reason for d in decided(performed("none:3,tap:20", seed="6")))


def test_one_foot_stepping_back_asks_for_the_other() -> None:
    made = performed("none:2,backward:6", vary="0")
    feet = feet_of(made)
    lazy = performed("none:30", vary="0")
    decisions = decode(DefaultDecoder(), {Role.LEFT: feet[Role.LEFT], Role.RIGHT: feet_of(lazy)[Role.RIGHT]})
    end = feet[Role.LEFT].duration_s - 0.5
    assert at(decisions, end).motion == MotionId.NONE
    assert any(
        d.reason == "only the left foot steps back, the right foot is still: step back with both"
        for d in decisions
    )


@pytest.mark.parametrize("foot", [Role.LEFT, Role.RIGHT])
def test_a_silent_foot_stops_the_walk_within_its_silence(foot: Role) -> None:
    made = performed("none:2,forward:8", vary="0")
    decoder, said = DefaultDecoder(), []
    for reading in readings(feet_of(made)):
        if reading.foot is not foot or reading.t_ns < 6e9:
            said.append(decoder.take(reading))
    last = [d for d in said if d is not None][-1]
    assert last.motion == MotionId.NONE
    assert 6.14 < last.t_ns * 1e-9 < 6.18
    assert last.reason.startswith(f"the {foot.value} foot's sensor is silent")


def test_both_silent_is_seen_by_the_watch() -> None:
    decoder, last = DefaultDecoder(), 0
    for reading in readings(feet_of(performed("none:2,forward:8", vary="0"))):
        if reading.t_ns < 6e9:
            decoder.take(reading)
            last = reading.t_ns
    assert decoder.now.motion == MotionId.FORWARD
    assert decoder.watch(last + 140_000_000) is None
    stopped = decoder.watch(last + 160_000_000)
    assert stopped is not None
    assert stopped.motion == MotionId.NONE


@pytest.mark.parametrize("rubbish", [math.nan, math.inf, -math.inf, 1e300])
def test_readings_that_cannot_be_stop_at_once_and_are_forgotten(rubbish: float) -> None:
    decoder = DefaultDecoder()
    said = []
    for reading in readings(feet_of(performed("none:2,forward:12", vary="0"))):
        bad = reading.foot is Role.LEFT and 6.0 <= reading.t_ns * 1e-9 < 6.05
        rate = (rubbish, 0.0, 0.0) if bad else reading.angular_rate_b
        said.append(decoder.take(reading._replace(angular_rate_b=rate)))
        if bad:
            assert decoder.now.motion == MotionId.NONE
            assert "cannot be" in decoder.now.reason
    assert decoder.now.motion == MotionId.FORWARD
    assert all(math.isfinite(d.speed_mps + d.turn_radps + d.confidence) for d in said if d is not None)


def test_an_unplugged_foot_stops_and_comes_back() -> None:
    decoder = DefaultDecoder()
    for reading in readings(feet_of(performed("none:2,forward:8", vary="0"))):
        if 5e9 < reading.t_ns <= 5.01e9 and reading.foot is Role.RIGHT:
            stopped = decoder.unplug(Role.RIGHT, reading.t_ns)
            assert stopped is not None
            assert (stopped.motion, stopped.reason) == (MotionId.NONE, "no sensor on the right foot")
        decoder.take(reading)
    assert decoder.now.motion == MotionId.FORWARD


def test_with_one_foot_only_nothing_moves_and_it_says_why() -> None:
    feet = feet_of(performed("none:2,forward:6", vary="0"))
    del feet[Role.LEFT]
    assert changes(decode(DefaultDecoder(), feet)) == []
    decoder = DefaultDecoder()
    decoder.take(still(Role.RIGHT, 0.0))
    assert decoder.now.reason == "no sensor on the left foot"


def test_mounting_turned_about_any_axis_by_ten_degrees_does_not_matter() -> None:
    made = performed("none:2,forward_right:6,none:2,backward:6", mounting="17", seed="9")
    for bout in made.bouts:
        assert at(decided(made), bout.end_s - 0.2).motion == bout.motion


@pytest.mark.parametrize("rate", ["40", "60", "200"])
def test_any_rate_will_do(rate: str) -> None:
    made = performed("none:2,forward_left:6,none:2,side_right:6", rate=rate, vary="0")
    for bout in made.bouts:
        assert at(decided(made), bout.end_s - 0.2).motion == bout.motion


def test_every_reason_is_a_sentence() -> None:
    for why in range(11):
        for motion in GESTURES if why == 10 else [MotionId.NONE]:
            for which in (0, 1, 2):
                sentence = words(motion, why, which)
                assert len(sentence) > 10
                assert "{" not in sentence


def test_feet_of_different_rates_and_late_starts_are_one_walk() -> None:
    slow, quick = (performed("none:2,forward:6,none:2", rate=rate, vary="0") for rate in ("50", "200"))
    feet = {Role.LEFT: feet_of(slow)[Role.LEFT], Role.RIGHT: feet_of(quick)[Role.RIGHT]}
    decisions = decode(DefaultDecoder(), feet)
    bout = only_bout(slow)
    assert at(decisions, bout.end_s - 0.2).motion == MotionId.FORWARD
    assert at(decisions, bout.end_s + 1.0).motion == MotionId.NONE


@pytest.mark.parametrize(
    ("performed_motion", "read"),
    [("side_right", MotionId.SIDE_LEFT), ("forward_left", MotionId.FORWARD_RIGHT)],
)
def test_swapped_feet_mirror_the_motion(performed_motion: str, read: MotionId) -> None:
    made = performed(f"none:2,{performed_motion}:6", vary="0")
    feet = feet_of(made)
    swapped = {Role.LEFT: feet[Role.RIGHT], Role.RIGHT: feet[Role.LEFT]}
    assert at(decode(DefaultDecoder(), swapped), only_bout(made).end_s - 0.2).motion == read
