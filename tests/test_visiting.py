"""A visit: simulated feet walk the town, faults and stops bring the camera to rest, smoothly and at once."""

from __future__ import annotations

import itertools
import math

import pytest

from app.gestures.steering import Comfort
from app.motion.basics import MotionId
from app.motion.samples import Sample
from app.simulate.gestures_live import LiveFeet
from app.simulate.gestures_options import GestureOptions
from app.visit import ChooseDecoder, GoOn, Halt, NextVisitor, SetUp, Steer, Switch, Tune, Visit
from app.visiting import IDLE_S, Visiting
from app.world import make_town

TOWN = make_town()
FRAME_NS = 16_666_667


class Sensors:
    """A visitor with two real sensors, played by simulated feet; a foot can be unplugged or spoilt."""

    def __init__(self) -> None:
        self.visiting = Visiting(TOWN, name="test")
        self.feet = LiveFeet(GestureOptions(seed=4))
        self.now_ns = 10**12
        self._start_ns = self.now_ns
        self.dead: set[str] = set()
        self.spoilt: set[str] = set()

    def frames(self, seconds: float) -> list[Visit]:
        """So much later: every frame's picture."""
        return [self.frame() for _ in range(round(seconds * 60))]

    def frame(self) -> Visit:
        self.now_ns += FRAME_NS
        for sample in self.feet.advance((self.now_ns - self._start_ns) * 1e-9, self._start_ns, self.now_ns):
            if sample.sensor not in self.dead:
                self.visiting.take(self._spoil(sample))
        return self.visiting.step(self.now_ns)

    def walking(self) -> list[Visit]:
        self.frames(1.5)
        self.feet.ask(MotionId.FORWARD)
        return self.frames(4.0)

    def _spoil(self, sample: Sample) -> Sample:
        bad = sample.sensor in self.spoilt
        return sample._replace(angular_rate_b=(math.nan, 0.0, 0.0)) if bad else sample


@pytest.fixture
def sensors() -> Sensors:
    return Sensors()


def speeds_are_smooth(visits: list[Visit]) -> None:
    most = Comfort().stop_mps2 * FRAME_NS * 1e-9 + 1e-6
    for before, after in itertools.pairwise(visits):
        assert abs(after.speed_mps - before.speed_mps) <= most


def test_marching_walks(sensors: Sensors) -> None:
    visits = sensors.walking()
    assert visits[-1].motion is MotionId.FORWARD
    assert visits[-1].speed_mps > 0.8
    assert visits[-1].north > -29.0
    assert {foot.state for foot in visits[-1].feet} == {"step"}
    speeds_are_smooth(visits)


@pytest.mark.parametrize("fault", ["unplugged", "rubbish", "stop"])
def test_a_dead_sensor_rubbish_and_escape_bring_it_to_rest(sensors: Sensors, fault: str) -> None:
    sensors.walking()
    if fault == "unplugged":
        sensors.dead.add("left")
    elif fault == "rubbish":
        sensors.spoilt.add("left")
    else:
        sensors.visiting.obey(Halt(), sensors.now_ns)
    visits = sensors.frames(1.0)
    speeds_are_smooth(visits)
    assert visits[-1].speed_mps == 0.0
    slowing = next(i for i, v in enumerate(visits) if v.motion is MotionId.NONE)
    assert slowing * FRAME_NS <= 190e6
    if fault == "stop":
        assert visits[-1].halted
        sensors.visiting.obey(GoOn(), sensors.now_ns)
    else:
        assert "left foot" in visits[-1].fault
        assert visits[-1].feet[0].state in ("silent", "rubbish")
        sensors.dead.clear()
        sensors.spoilt.clear()
    assert sensors.frames(4.0)[-1].speed_mps > 0.5  # and back


def test_one_foot_alone_never_moves_it(sensors: Sensors) -> None:
    sensors.dead.add("right")
    visits = sensors.walking()
    assert all(v.speed_mps == 0.0 for v in visits)
    assert visits[-1].fault == "no sensor on the right foot: gestures take two feet"


def test_the_keys_take_over_from_a_dead_sensor(sensors: Sensors) -> None:
    sensors.dead |= {"left", "right"}
    sensors.frames(1.0)
    for _ in range(30):
        sensors.visiting.obey(Steer("f"), sensors.now_ns)
        visits = sensors.frames(0.1)
    assert visits[-1].speed_mps > 0.5
    assert visits[-1].feet_from == "the keys have taken over"
    assert sensors.frames(3.5)[-1].speed_mps == 0.0  # let go: nobody repeats the key


def test_swapped_feet_turn_the_other_way(sensors: Sensors) -> None:
    sensors.frames(1.0)
    sensors.feet.ask(MotionId.TURN_CW)
    assert sensors.frames(3.0)[-1].turn_radps > 0.1
    sensors.visiting.obey(Switch("swapped", True), sensors.now_ns)
    assert sensors.frames(3.0)[-1].turn_radps < -0.1


def test_the_set_up_holds_the_camera_and_sets_thresholds(sensors: Sensors) -> None:
    sensors.frames(1.0)
    sensors.visiting.obey(SetUp(True), sensors.now_ns)
    titles = []
    script = {
        "March in place": MotionId.FORWARD,
        "Turn left": MotionId.TURN_CCW,
        "Turn right": MotionId.TURN_CW,
        "Step aside": MotionId.SIDE_RIGHT,
    }
    for _ in range(40 * 60):
        visit = sensors.frame()
        if visit.task is None:
            break
        titles.append(visit.task.title)
        sensors.feet.ask(script.get(visit.task.title, MotionId.NONE))
        assert visit.speed_mps == 0.0
    seen = [title for title, _ in itertools.groupby(titles)]
    assert seen == [
        "Stand still", "March in place", "Turn left", "Turn right", "Step aside", "Ready",
    ]  # fmt: skip
    assert sensors.visiting.tuning["on_radps"] != 0.5
    assert not sensors.visiting.switches["swapped"]
    assert sensors.visiting.sensors.intake.sided
    sensors.visiting.obey(NextVisitor(), sensors.now_ns)
    assert not sensors.visiting.sensors.intake.sided


def test_nobody_there_makes_way_for_the_next_visitor(sensors: Sensors) -> None:
    north = sensors.walking()[-1].north
    sensors.feet.ask(MotionId.NONE)
    sensors.frames(1.5)
    sensors.now_ns += round((IDLE_S - 10.0) * 1e9)
    soon = sensors.frame()
    assert soon.idle_s is not None
    assert soon.north > north - 1.0
    sensors.now_ns += round(11e9)
    visits = sensors.frames(0.1)
    assert visits[-1].north == -30.0
    assert visits[-1].idle_s is None


def test_both_decoders_walk(sensors: Sensors) -> None:
    sensors.visiting.obey(ChooseDecoder("papers"), sensors.now_ns)
    visits = sensors.walking()
    assert visits[-1].decoder == "papers"
    assert visits[-1].speed_mps > 0.8
    assert visits[-1].machines is not None


def test_sliders_move_what_they_say(sensors: Sensors) -> None:
    sensors.visiting.obey(Tune("forward_m", 0.5), sensors.now_ns)
    sensors.visiting.obey(Tune("nonsense", 1.0), sensors.now_ns)
    sensors.visiting.obey(Tune("forward_m", math.nan), sensors.now_ns)
    assert sensors.visiting.tuning["forward_m"] == 0.5
    assert sensors.walking()[-1].speed_mps == pytest.approx(0.5, abs=0.15)


def test_the_stroller_finds_a_target_and_a_person_may_take_the_keys() -> None:
    visiting, now_ns, visit = Visiting(TOWN, simulated=GestureOptions()), 0, None
    for _ in range(120 * 60):
        now_ns += FRAME_NS
        visit = visiting.step(now_ns)
        if visit.score:
            break
    assert visit
    assert visit.score == 1
    assert visit.reached
    for _ in range(20):
        visiting.obey(Steer("l"), now_ns)
        for _ in range(6):
            now_ns += FRAME_NS
            visit = visiting.step(now_ns)
    assert visit.motion is MotionId.TURN_CCW
    visiting.obey(NextVisitor(), now_ns)
    assert visiting.step(now_ns + 1).score == 0


def test_the_same_visit_twice_is_the_same() -> None:
    def places() -> list[tuple[float, float]]:
        visiting = Visiting(TOWN, simulated=GestureOptions(seed=2))
        visits = [visiting.step(k * FRAME_NS) for k in range(600)]
        return [(v.north, v.east) for v in visits]

    assert places() == places()


def test_the_next_visitor_does_not_walk_on_with_the_last_ones_feet(sensors: Sensors) -> None:
    """In the middle of a march: at rest at the start until the feet have stood still, then as ever."""
    sensors.walking()
    sensors.visiting.obey(NextVisitor(), sensors.now_ns)
    visits = sensors.frames(3.0)
    assert {(v.north, v.speed_mps, v.hunt_s, v.score) for v in visits} == {(-30.0, 0.0, 0.0, 0)}
    assert "stand still" in visits[-1].reason
    sensors.feet.ask(MotionId.NONE)
    assert sensors.frames(2.0)[-1].speed_mps == 0.0
    sensors.feet.ask(MotionId.FORWARD)
    assert sensors.frames(4.0)[-1].speed_mps > 0.8


def test_the_next_visitor_of_simulated_feet_sets_off_from_rest() -> None:
    visiting = Visiting(TOWN, simulated=GestureOptions())
    walked = [visiting.step(k * FRAME_NS) for k in range(600)]
    visiting.obey(NextVisitor(), 600 * FRAME_NS)
    again = [visiting.step(k * FRAME_NS) for k in range(600, 1200)]
    assert again[0].motion is MotionId.NONE
    assert [v.motion for v in again[5:]] == [v.motion for v in walked[5:600]][: len(again) - 5]
    assert math.hypot(again[-1].north + 30.0, again[-1].east) > 1.0


def test_an_emergency_stop_outlasts_another_operators_go_on_that_had_not_seen_it(sensors: Sensors) -> None:
    sensors.walking()
    sensors.visiting.obey(Halt(), sensors.now_ns)
    sensors.visiting.obey(GoOn(), sensors.now_ns + 200_000_000)
    assert sensors.frames(1.0)[-1].halted
    sensors.visiting.obey(GoOn(), sensors.now_ns)
    assert sensors.frames(3.0)[-1].speed_mps > 0.5


def test_a_stop_in_the_set_up_begins_its_step_anew(sensors: Sensors) -> None:
    sensors.frames(1.0)
    sensors.visiting.obey(SetUp(True), sensors.now_ns)
    sensors.frames(4.0)
    sensors.feet.ask(MotionId.FORWARD)
    sensors.frames(1.0)
    sensors.visiting.obey(Halt(), sensors.now_ns)
    task = sensors.frames(8.0)[-1].task
    assert task is not None
    assert (task.title, task.part) == ("March in place", 0.0)
    assert "Stopped" in task.note
    sensors.visiting.obey(GoOn(), sensors.now_ns)
    titles = [visit.task.title for visit in sensors.frames(8.0) if visit.task]
    assert titles[0] == "March in place"
    assert "Turn left" in titles


def test_leaving_the_set_up_leaves_all_as_it_was(sensors: Sensors) -> None:
    sensors.visiting.use({"on_radps": 0.7, "sure_rad": 0.1, "swapped": True})
    sensors.visiting.obey(SetUp(True), sensors.now_ns)
    sensors.visiting.obey(SetUp(True), sensors.now_ns)  # two operators
    sensors.frames(2.0)
    sensors.visiting.obey(SetUp(False), sensors.now_ns)
    assert sensors.visiting.kept()["swapped"]
    assert sensors.frames(0.1)[-1].switches["swapped"]
    assert sensors.visiting.kept()["on_radps"] == 0.7


def test_keys_in_a_visitors_set_up_are_not_the_visitor(sensors: Sensors) -> None:
    sensors.frames(1.0)
    sensors.visiting.obey(SetUp(True), sensors.now_ns)
    sensors.frames(4.0)
    for _ in range(80):
        sensors.visiting.obey(Steer("f"), sensors.now_ns)
        task = sensors.frames(0.1)[-1].task
    assert task is not None
    assert task.title == "March in place"
    assert "keys" in task.note


def test_a_set_up_that_everybody_left_makes_way_and_a_stop_does_not(sensors: Sensors) -> None:
    sensors.frames(1.0)
    sensors.visiting.obey(SetUp(True), sensors.now_ns)
    assert sensors.frames(5.0)[-1].task is not None
    sensors.now_ns += round((IDLE_S + 1.0) * 1e9)
    assert sensors.frames(0.2)[-1].task is None
    north = sensors.walking()[-1].north
    sensors.visiting.obey(Halt(), sensors.now_ns)
    north = sensors.frames(1.0)[-1].north
    sensors.feet.ask(MotionId.NONE)
    sensors.frames(2.0)
    sensors.now_ns += round((IDLE_S + 1.0) * 1e9)
    visits = sensors.frames(0.2)
    assert visits[-1].north == north > -30.0
    assert visits[-1].idle_s is None
