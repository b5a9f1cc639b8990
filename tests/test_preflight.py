"""The pre-flight, fed with samples: every line green on a sound walk, and each fault says what to do."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping

import pytest

from app.clocks import FixedClock
from app.health import Monitor, judge
from app.motion.basics import GaitPhase, Role
from app.motion.health import Health
from app.motion.samples import Sample
from app.motion.snapshot import FootView, Trail
from app.motion.status import LineState, PreflightView
from app.preflight import Preflight, sentence
from app.preflight import told as report

G = 9.80665
FEET = {"left": Role.LEFT, "right": Role.RIGHT}
NO_TRAIL = Trail((), None, None)  # type: ignore[arg-type]


def view(sensor: str, north_m: float = 0.0, distance_m: float = 0.0, yaw_rad: float = 0.0) -> FootView:
    q = (math.cos(yaw_rad / 2), 0.0, 0.0, math.sin(yaw_rad / 2))
    return FootView(
        sensor, FEET.get(sensor, Role.FOOT), 0.0, (north_m, 0.0, 0.0), q, GaitPhase.STANCE,
        True, 0, distance_m, 0.0, 0.0, 0.0, 0.0, NO_TRAIL, (), None,
    )  # fmt: skip


class Rehearsal:
    """A person who stands, stamps, walks and stands, as samples of each foot and views of the estimate."""

    def __init__(self, roles: Mapping[str, Role] = FEET, rate_hz: float = 100.0) -> None:
        self.preflight = Preflight(roles)
        self.sensors = tuple(roles)
        self.monitors = {sensor: Monitor(FixedClock()) for sensor in roles}
        self.rate_hz, self.count, self.uses_field = rate_hz, 0, True
        self.views = {sensor: view(sensor) for sensor in roles}
        self.change: Callable[[Sample], Sample | None] = lambda sample: sample

    def do(
        self, seconds: float, force: float = G, rate: float = 0.0, who: str | None = None
    ) -> PreflightView:
        for _ in range(int(seconds * self.rate_hz)):
            self.count += 1
            at = round(self.count * 1e9 / self.rate_hz)
            for sensor in self.sensors:
                moves = who is None or who == sensor
                turn, pull = (rate, force) if moves else (0.0, G)
                swing = turn * (-1) ** (self.count // 5)
                made = Sample(
                    sensor, self.count, at, at, (0.0, 0.0, -pull), (0.0, swing, 0.0), (20.0, 0.0, 40.0)
                )
                sample = self.change(made)
                if sample is not None:
                    self.monitors[sensor].add(sample, True, GaitPhase.STANCE)
                    self.preflight.add(sample)
            if self.count % 10 == 0:
                self.look()
        return self.look()

    def look(self) -> PreflightView:
        health = {}
        for sensor, monitor in self.monitors.items():
            recent = monitor.recent(0.0, live=True)
            health[sensor] = Health(0.0, 0, {}, 0, 1, recent, *judge(Role.FOOT, recent, True))
        return self.preflight.look(tuple(self.views.values()), health, self.uses_field)

    def walk(self, metres: float, ends_m: float) -> None:
        self.do(2.0, 20.0, 3.0)
        self.views = {s: view(s, ends_m, metres) for s in self.sensors}


def states(shown: PreflightView) -> dict[str, LineState]:
    return {line.name: line.state for line in shown.lines}


def told(shown: PreflightView, name: str) -> str:
    return next(line.told for line in shown.lines if line.name == name)


@pytest.mark.parametrize("roles", [FEET, {"foot": Role.FOOT}])
def test_a_sound_walk_is_green_line_by_line(roles: Mapping[str, Role]) -> None:
    person = Rehearsal(roles)
    assert states(person.do(1.0))["still"] is LineState.NOW
    after = states(person.do(4.0))
    assert (after["still"], after["rate"], after["heading"]) == (LineState.GOOD,) * 3
    assert after["range"] is LineState.NOW
    person.do(0.5, 30.0, 4.0)
    assert states(person.look())["loop"] is LineState.NOW
    person.walk(12.0, 0.1)
    shown = person.do(2.0)
    assert shown.done
    assert shown.good
    assert shown.seconds < 60.0
    assert "0.10 m from the start after 12.0 m (0.8 %)" in told(shown, "loop")
    assert json.loads(json.dumps(report(shown)))["lines"][0]["state"] == "good"
    assert sentence(shown).startswith("pre-flight good: still good (gravity 9.81 m/s²")


def test_one_line_at_a_time_is_asked_for() -> None:
    person = Rehearsal()
    for _ in range(12):
        shown = person.do(0.5)
        assert sum(line.state is LineState.NOW for line in shown.lines) == 1
        assert shown.words == next(line.told for line in shown.lines if line.state is LineState.NOW)


def test_who_moves_is_not_still() -> None:
    person = Rehearsal()
    assert states(person.do(6.0, rate=1.0))["still"] is LineState.NOW
    assert states(person.do(3.0))["still"] is LineState.GOOD


@pytest.mark.parametrize(
    ("change", "line", "words"),
    [
        (lambda s: s._replace(specific_force_b=(0.0, 0.0, -9.2)), "still", "calibrate"),
        (lambda s: None if s.seq % 20 == 3 else s, "rate", "move the receiver closer"),
        (lambda s: s._replace(field_b=(200.0, 0.0, 0.0)), "heading", "iron"),
        (lambda s: s._replace(field_b=None), "heading", "no magnetometer"),
    ],
)
def test_each_fault_says_what_to_do(change: Callable[[Sample], Sample | None], line: str, words: str) -> None:
    person = Rehearsal({"foot": Role.FOOT})
    person.change = change
    shown = person.do(6.0)
    assert states(shown)[line] is LineState.BAD
    assert words in told(shown, line)


def test_a_slow_sensor_is_told() -> None:
    shown = Rehearsal({"foot": Role.FOOT}, rate_hz=25.0).do(8.0)
    assert "25 samples a second" in told(shown, "rate")


def test_a_range_that_is_too_small_is_told() -> None:
    person = Rehearsal()
    person.do(5.0)
    person.change = lambda s: s._replace(saturation=1)
    shown = person.do(1.0, 50.0, 5.0)
    assert states(shown)["range"] is LineState.BAD
    assert "larger" in told(shown, "range")


def test_feet_that_point_apart_are_told() -> None:
    person = Rehearsal()
    person.views["right"] = view("right", yaw_rad=1.2)
    assert "69° apart" in told(person.do(5.0), "heading")
    person = Rehearsal()
    person.uses_field = False
    person.views["right"] = view("right", yaw_rad=1.2)
    assert states(person.do(5.0))["heading"] is LineState.GOOD


def test_a_loop_that_does_not_close_is_told() -> None:
    person = Rehearsal()
    person.do(5.0)
    person.do(0.5, 30.0, 4.0)
    person.walk(12.0, 1.5)
    shown = person.do(2.0)
    assert (shown.done, shown.good) == (True, False)
    assert "1.50 m from the start" in told(shown, "loop")
    assert "with remarks" in sentence(shown)


def test_a_line_can_be_skipped() -> None:
    person = Rehearsal()
    person.do(5.0)
    person.preflight.skip()
    shown = person.look()
    assert told(shown, "range") == "skipped"
    assert states(shown)["loop"] is LineState.NOW


def test_a_tap_names_the_shoes() -> None:
    person = Rehearsal({"aa:01": Role.FOOT, "aa:02": Role.FOOT})
    shown = person.do(3.0)
    assert "left shoe" in shown.words
    person.do(0.3, 14.0, 3.0, who="aa:02")
    shown = person.do(1.0)
    assert dict(shown.names) == {"aa:02": Role.LEFT, "aa:01": Role.RIGHT}
    assert "aa:02 is left" in told(shown, "name")
    person.preflight.swap()
    assert person.preflight.names == {"aa:02": Role.RIGHT, "aa:01": Role.LEFT}


def test_both_shoes_at_once_name_nothing() -> None:
    person = Rehearsal({"a": Role.FOOT, "b": Role.FOOT})
    person.do(3.0)
    assert set(dict(person.do(1.0, 14.0, 3.0).names).values()) == {Role.FOOT}


def test_left_and_right_are_not_asked_again() -> None:
    assert "name" not in states(Rehearsal().do(1.0))
