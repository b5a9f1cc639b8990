"""Two feet linked while they walk: apart no further than legs let them, and the same however samples come."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from app.blocks import Blocks
from app.estimator.feet import Worn
from app.estimator.linking import link_walked
from app.estimator.tracker import Tracker
from app.estimator.turns import Turn, Turns
from app.motion.basics import Floats, Role
from app.motion.commands import ApplyCandidate, Command, LookBack, Order, ReplaceCandidate
from app.motion.samples import Sample
from app.session import Session
from app.settings import Settings
from app.tracks import Track
from tests.estimator.scoring import rmse
from tests.estimator.walks import rows_of, table_of, walk

DEFAULT = Settings(estimator="kalman", sensor_height_m=0.0)
WORN = {"left": Worn(Role.LEFT), "right": Worn(Role.RIGHT)}
NAMES = ("left", "right")
BESIDE = np.array([0.0, 0.2])
SQUARE = "feet=2&rate_hz=100&path=square&size_m=15&strides=50"


@cache
def matrices(query: str, drift_radps: float = 0.0) -> dict[str, Floats]:
    """Both feet's samples; the gyros' biases come only after the start: left one way, right the other."""
    made = {}
    for foot in walk(query).recording.sensors:
        made[foot.sensor] = foot.matrix.copy()
        sign = 1.0 if foot.sensor == "left" else -1.0
        made[foot.sensor][:, 6] += sign * drift_radps * (foot.matrix[:, 0] > 2e9)
    return made


@cache
def alone(query: str, drift_radps: float = 0.0, right_rad: float = 0.0) -> dict[str, Floats]:
    """Each foot's rows by itself; the right one's start heading is another."""
    headings = {"left": 0.0, "right": right_rad}
    found = {}
    for name, matrix in matrices(query, drift_radps).items():
        tracker = Tracker(DEFAULT.with_changes({"start_heading_rad": headings[name]}))
        tracker.advance(table_of(matrix))
        found[name] = rows_of(tracker)
    return found


def linked(
    query: str, drift_radps: float = 0.0, settings: Settings = DEFAULT
) -> tuple[bool, dict[str, Floats]]:
    """The whole walk in one go."""
    trackers = {}
    for name, matrix in matrices(query, drift_radps).items():
        trackers[name] = Tracker(settings)
        trackers[name].advance(table_of(matrix))
    held = link_walked(trackers, WORN, settings)
    return held, {name: rows_of(tracker) for name, tracker in trackers.items()}


def apart(rows: dict[str, Floats]) -> Floats:
    """From the left foot to the right, horizontally [n, 2]."""
    return rows["right"][:, :2] + BESIDE - rows["left"][:, :2]


def true_positions(query: str, name: str) -> Floats:
    """Where a foot truly is [n, 3]."""
    return walk(query).truth(name, matrices(query)[name][:, 0] * 1e-9)[0]


def off(query: str, rows: dict[str, Floats], name: str) -> float:
    """RMSE of a foot's place, m."""
    true = true_positions(query, name)[:, :2]
    return float(np.sqrt(np.mean(np.sum((rows[name][:, :2] - (true - true[0])) ** 2, axis=1))))


def test_feet_without_errors_are_not_moved_at_all() -> None:
    held, rows = linked(SQUARE)
    assert held
    for name in NAMES:
        assert rows[name].tobytes() == alone(SQUARE)[name].tobytes()


@pytest.mark.parametrize("drift_radps", [3e-3, 8e-3])
def test_headings_that_drift_apart_are_kept_together(drift_radps: float) -> None:
    held, rows = linked(SQUARE, drift_radps)
    before = alone(SQUARE, drift_radps)
    assert held
    assert np.hypot(*apart(before).T).max() > 2.0
    assert np.hypot(*apart(rows).T).max() < 1.45
    for name in NAMES:
        assert off(SQUARE, rows, name) < off(SQUARE, before, name)


@pytest.mark.parametrize("bad", NAMES)
def test_a_gyro_that_drifts_costs_the_other_foot_little(bad: str) -> None:
    """Its bias moves about the axes that zero velocities tell, so it may have moved about down."""
    noise = "gyro_noise_radps=0.0035&accelerometer_noise_mps2=0.03"
    query = f"feet=2&rate_hz=100&path=square&size_m=20&strides=120&{noise}"
    good, trackers, before = NAMES[bad == "left"], {}, {}
    for name, matrix in matrices(query).items():
        moved = matrix.copy()
        moved[:, 4:7] += [4e-3, -4e-3, 4e-3] * (moved[:, :1] > 2e9) * (name == bad)
        trackers[name] = Tracker(DEFAULT)
        trackers[name].advance(table_of(moved))
        before[name] = rows_of(trackers[name])
    assert link_walked(trackers, WORN, DEFAULT)
    after = {name: rows_of(tracker) for name, tracker in trackers.items()}
    alone, linked = (
        {name: rmse(rows[name][:, :3], true_positions(query, name)) for name in NAMES}
        for rows in (before, after)
    )
    assert linked[good] < alone[good] + 0.3
    assert linked[bad] < 0.4 * alone[bad]


def test_one_foot_or_papers_or_no_bound_is_left_as_it_is() -> None:
    for settings in (
        DEFAULT.with_changes({"feet_apart_m": 0.0}),
        DEFAULT.with_changes({"estimator": "papers"}),
    ):
        held, rows = linked(SQUARE, 8e-3, settings)
        assert not held
        assert np.hypot(*apart(rows).T).max() > 2.0
    one = {"left": Tracker(DEFAULT)}
    one["left"].advance(table_of(matrices(SQUARE)["left"]))
    assert not link_walked(one, WORN, DEFAULT)
    assert rows_of(one["left"]).tobytes() == alone(SQUARE)["left"].tobytes()


@pytest.mark.parametrize("turned_rad", [-1.6, 0.5, 2.5])
def test_starts_that_look_elsewhere_come_together(turned_rad: float) -> None:
    track = Track("t", DEFAULT)
    headings = {"left": 0.0, "right": turned_rad}
    trackers = {}
    for name, matrix in matrices(SQUARE).items():
        trackers[name] = Tracker(DEFAULT.with_changes({"start_heading_rad": headings[name]}))
        trackers[name].advance(table_of(matrix))
    assert track.settings == DEFAULT
    assert link_walked(trackers, WORN, DEFAULT)
    rows = {name: rows_of(tracker) for name, tracker in trackers.items()}
    assert np.hypot(*apart(rows).T).max() < 1.2
    assert off(SQUARE, rows, "left") < 0.15
    assert off(SQUARE, rows, "right") < 0.6


def samples(query: str, drift_radps: float) -> dict[str, list[Sample]]:
    return {
        name: [
            Sample(
                name,
                i,
                int(row[0]),
                0,
                tuple(row[1:4].tolist()),
                tuple(row[4:7].tolist()),
                tuple(row[7:10].tolist()),
            )
            for i, row in enumerate(matrix)
        ]
        for name, matrix in matrices(query, drift_radps).items()
    }


def orders(both: dict[str, list[Sample]]) -> list[list[Sample]]:
    """The same samples: as they were taken, one foot wholly after the other, and in bursts."""
    left, right = both["left"], both["right"]
    taken = [sample for pair in zip(left, right, strict=True) for sample in pair]
    bursts = [s for k in range(0, len(left), 137) for s in (*right[k : k + 137], *left[k : k + 137])]
    return [taken, left + right, bursts]


def test_it_is_the_same_to_the_bit_however_the_samples_come() -> None:
    found = []
    for given in orders(samples(SQUARE, 8e-3)):
        session = Session(DEFAULT)
        for i, sample in enumerate(given):
            session.take(sample)
            if i % 500 == 0:
                session.snapshot()
        feet = session.main.feet
        assert session.snapshot().main.linked
        found.append([feet[name].table(0, feet[name].tracker.rows.end).tobytes() for name in NAMES])
        found[-1] += [repr(feet[name].strides(1000)).encode() for name in NAMES]
        found[-1] += [repr(feet[name].footprints()).encode() for name in NAMES]
    assert found[0] == found[1] == found[2]
    _, rows = linked(SQUARE, 8e-3)
    assert found[0][:2] == [rows[name].tobytes() for name in NAMES]


def test_what_is_drawn_is_where_the_feet_are() -> None:
    session = Session(DEFAULT)
    for i, sample in enumerate(orders(samples(SQUARE, 8e-3))[0]):
        session.take(sample)
        if i % 97 == 0:
            session.snapshot()
    for foot in session.snapshot().main.feet:
        rows = session.main.feet[foot.sensor].table(0, session.main.feet[foot.sensor].tracker.rows.end)
        assert foot.position_n == pytest.approx(rows[-1, :3])
        points = np.concatenate([piece.segments.reshape(-1, 3) for piece in foot.trail.pieces])
        far = [np.min(np.hypot(*(rows[:, :2] - point[:2]).T)) for point in points[::7]]
        assert max(far) < 0.02


def test_a_foot_that_falls_silent_does_not_hold_the_other() -> None:
    both = samples(SQUARE, 8e-3)
    half = len(both["left"]) // 2
    taken = orders(both)[0]
    silent = [s for s in taken if s.sensor == "left" or s.seq < half]
    session = Session(DEFAULT)
    for i, sample in enumerate(silent):
        session.take(sample)
        if i % 500 == 0:
            session.snapshot()
    foot = session.main.feet["left"]
    end = foot.tracker.rows.end
    late = slice(half + 500, end)
    own, drawn = rows_of(foot.tracker)[late, :2], foot.table(0, end)[late, :2]
    steps, moved = np.diff(own, axis=0), np.diff(drawn, axis=0)
    assert np.hypot(*steps.T) == pytest.approx(np.hypot(*moved.T), abs=1e-9)  # turned, and no more
    assert len(session.snapshot().main.feet[0].trail.provisional) < 2000


def test_a_foot_that_was_lost_comes_back_to_the_other() -> None:
    """The right foot says nothing for a third of the walk; then it is where it was, and the left goes on."""
    both = samples(SQUARE, 0.0)
    begin, end = len(both["left"]) // 3, 2 * len(both["left"]) // 3
    session = Session(DEFAULT)
    for sample in orders(both)[0]:
        if sample.sensor == "left" or not begin < sample.seq < end:
            session.take(sample)
    left, right = (session.main.feet[name] for name in NAMES)
    rows = left.table(0, left.tracker.rows.end)
    assert np.hypot(*(rows[:, :2] - alone(SQUARE)["left"][:, :2]).T).max() < 0.25
    last = right.table(right.tracker.rows.end - 1, right.tracker.rows.end)[0, :2]
    assert np.hypot(*(last + BESIDE - rows[-1, :2])) < 1.3
    stranded = rows_of(right.tracker)[-1, :2]
    assert np.hypot(*(stranded + BESIDE - rows[-1, :2])) > 3.0


def settle(session: Session) -> None:
    while (job := session.applying.wanted) is not None:
        session.applying.adopt(job, job.run())


def told(session: Session, command: Command) -> None:
    session.apply(Order(command, "somebody", 0))
    settle(session)


def drawn(session: Session) -> list[bytes]:
    feet = [session.main.feet[name] for name in NAMES]
    return [foot.table(foot.tracker.rows.start, foot.tracker.rows.end).tobytes() for foot in feet]


def test_other_settings_are_linked_as_if_they_had_held_from_the_start() -> None:
    given = orders(samples(SQUARE, 8e-3))[0]
    session, fresh = Session(DEFAULT), Session(changed := DEFAULT.with_changes({"feet_apart_m": 0.8}))
    for i, sample in enumerate(given):
        session.take(sample)
        fresh.take(sample)
        if i == len(given) // 2:
            told(session, ReplaceCandidate(changed, "tried"))
            told(session, ApplyCandidate())
    assert session.main.settings == changed
    assert drawn(session) == drawn(fresh)


def test_after_a_look_back_the_feet_stay_together() -> None:
    session = Session(DEFAULT.with_changes({"hindsight": True}))
    given = orders(samples(SQUARE, 8e-3))[0]
    for i, sample in enumerate(given):
        session.take(sample)
        if i == len(given) // 2:
            told(session, LookBack())
            assert session.main.linked
    rows = {name: session.main.feet[name].table(0, len(given) // 2) for name in NAMES}
    assert session.main.linked
    assert np.hypot(*apart(rows).T).max() < 1.5
    lengths = [stride.length_m for stride in session.main.feet["left"].strides(1000)]
    assert max(lengths) < 2.5


def test_where_old_samples_are_gone_other_settings_go_on_from_where_the_feet_were() -> None:
    query = "feet=2&rate_hz=100&path=square&size_m=15&strides=150"
    session, whole = Session(DEFAULT, budget_bytes=6_000_000), Session(DEFAULT)
    given = orders(samples(query, 3e-3))[0]
    for i, sample in enumerate(given):
        session.take(sample)
        whole.take(sample)
        if i == len(given) - 1000:
            turned = DEFAULT.with_changes({"start_heading_rad": 0.7})
            told(session, ReplaceCandidate(turned, "turned"))
            told(session, ApplyCandidate())
    c, s = np.cos(0.7), np.sin(0.7)
    for name in NAMES:
        foot, before = session.main.feet[name], whole.main.feet[name]
        start, end = foot.tracker.rows.start, foot.tracker.rows.end
        assert start > 0
        found, true = (one.table(start, end)[:, :2] for one in (foot, before))
        assert found == pytest.approx(true @ np.array([[c, s], [-s, c]]), abs=0.02)


def test_strangers_are_not_called_linked() -> None:
    trackers = {}
    for name, query in (("left", SQUARE), ("right", "feet=2&rate_hz=100&path=straight&strides=50")):
        trackers[name] = Tracker(DEFAULT)
        trackers[name].advance(table_of(matrices(query)[name]))
    assert not link_walked(trackers, WORN, DEFAULT)


def test_a_turn_goes_over_into_the_next_in_the_swing_only() -> None:
    turns = Turns()
    turns.add(Turn(10.0, 20.0, 0.1, 0.0, 0.0, 0.0, 1.0, 2.0))
    assert not len(turns)  # nothing has to move yet
    turns.add(Turn(30.0, 40.0, 0.1, 0.1, 0.5, -0.5, 3.0, 4.0))
    turns.add(Turn(50.0, 60.0, 0.1, 0.3, 1.0, 0.0, 5.0, 6.0))
    rows = np.zeros((70, 13))
    rows[:, 0], rows[:, 1], rows[:, 6] = 3.0, 4.0, 1.0
    made = turns.from_row(0, rows)
    assert made[:31].tobytes() == rows[:31].tobytes()
    assert made[40, :2] == pytest.approx([3.5, 3.5])
    assert np.ptp(made[40:51, :2], axis=0) == pytest.approx(0.0)
    assert np.all(np.diff(made[30:41, 0]) > 0.0)
    yaw = 2.0 * np.arctan2(made[:, 9], made[:, 6])
    assert yaw[40] == pytest.approx(0.1)
    assert yaw[60:] == pytest.approx(0.3)
    rate = np.gradient(made[:, 0], 0.01)
    assert made[31:39, 3] == pytest.approx(rate[31:39], abs=0.6)  # a parabola by ten points
    assert turns.of(rows[[45]], np.array([45]))[0] == pytest.approx(made[45])


def test_only_what_is_there_is_asked_for() -> None:
    asked: list[int] = []

    def worn() -> dict[str, Worn]:
        asked.append(1)
        return WORN

    track = Track("t", DEFAULT)
    for name in NAMES:
        table = Blocks(10)
        table.extend(matrices(SQUARE)[name][:100])
        track.advance(name, table)
        track.link(worn)
    assert len(asked) == 1  # no stride yet: once when the second foot came, never again
    track.link(worn)
    assert len(asked) == 1
