"""The session: a log in, a snapshot out; results that do not depend on when they come."""

from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np
import pytest

from app.motion.basics import InputError, Role
from app.motion.commands import (
    ApplyCandidate,
    Command,
    KeepAs,
    LookBack,
    Pause,
    ResetHeading,
    RestartHere,
    SetCandidate,
)
from app.motion.samples import Sample, Samples
from app.motion.snapshot import Snapshot
from app.session import Session
from app.settings import Settings
from tests import sessions
from tests.estimator.walks import PAPERS, estimate, foot, one_by_one, rows_of, still, walk
from tests.sessions import (
    GAIN,
    LONG,
    OTHER,
    WALK,
    assert_main_is,
    fed,
    length_of,
    main_rows,
    order,
    played,
    settle,
    tell,
)


def test_an_empty_session_has_a_snapshot() -> None:
    snapshot = Session(PAPERS).snapshot()
    assert (snapshot.number, snapshot.t_s, snapshot.main.feet, snapshot.candidate) == (0, 0.0, (), None)
    assert snapshot.candidate_settings == PAPERS
    assert Session(PAPERS, truth=walk().truth).snapshot().truth == {}


def test_live_is_batch_to_the_bit() -> None:
    session = fed(Session(PAPERS), WALK)
    assert main_rows(session).tobytes() == rows_of(estimate(foot("path=square&noise=1&rate_hz=50"))).tobytes()


@pytest.mark.parametrize(
    "command",
    [
        SetCandidate((("gain_stance", math.nan),)),
        SetCandidate((("gain_stance", -1.0),)),
        SetCandidate((("gain_stance", math.inf),)),
        SetCandidate((("gain_stance", "much"),)),
        SetCandidate((("no such", 1.0),)),
        KeepAs("C"),
        Pause(True),
    ],
)
def test_an_impossible_order_changes_nothing(command: Command) -> None:
    session = fed(Session(PAPERS), WALK[:100])
    with pytest.raises(InputError):
        session.apply(order(command))
    assert session.main.settings == PAPERS
    assert (session.applying.wanted, session.applying.candidate) == (None, None)


def test_a_sensor_that_never_delivered_is_no_foot() -> None:
    session = fed(Session(PAPERS), [Sample("left", 0, 0, 0, (math.nan, 0, 0), (0, 0, 0)), *WALK[:100]])
    tell(session, GAIN, ApplyCandidate(), ResetHeading())
    snapshot = session.snapshot()
    assert [f.sensor for f in snapshot.main.feet] == ["foot"]
    assert snapshot.health["left"].dropped == {"not a finite number": 1}


def test_restart_forgets_the_walk_and_keeps_settings_and_sliders() -> None:
    session = fed(Session(Settings(gain_stance=2.0)), WALK[:500])
    tell(session, OTHER, RestartHere())
    snapshot = session.snapshot()
    assert (snapshot.epoch, snapshot.main.feet, snapshot.t_s) == (1, (), 0.0)
    assert snapshot.candidate_settings.threshold_radps == 0.7
    fed(session, WALK[500:700])
    matrix = np.array(
        [
            [s.device_ns - WALK[500].device_ns, *s.specific_force_b, *s.angular_rate_b, *(s.field_b or ())]
            for s in WALK[500:700]
        ]
    )
    samples = Samples("foot", Role.FOOT, 0, matrix, np.empty(0, np.uint16))
    assert main_rows(session).tobytes() == rows_of(estimate(samples, gain_stance=2.0)).tobytes()
    assert session.applying.candidate is not None


def test_replaying_the_log_repeats_it_to_the_bit() -> None:
    steps = [(200, 0), (100, 3), (100, 1), (50, 3), (80, 5), (10, 6), (90, 2), (40, 3), (60, 7)]
    live = played([(count, command, k % 2 == 0) for k, (count, command) in enumerate(steps)])
    again, taken = Session(PAPERS), 0
    for number, what in live.log:
        while again.number < number - 1:
            again.take(WALK[taken])
            taken += 1
        again.apply(what)
        settle(again)
    fed(again, WALK[taken : taken + live.number - again.number])
    assert again.number == live.number
    assert again.main.settings == live.main.settings
    assert main_rows(again).tobytes() == main_rows(live).tobytes()


def frozen(snapshot: Snapshot) -> list[bytes]:
    feet = [f for view in (snapshot.main, snapshot.candidate) if view for f in view.feet]
    trails = [f.trail for f in feet] + list(snapshot.truth.values())
    arrays: list[Any] = [
        a for t in trails for a in (*(p.segments for p in t.pieces), t.growing, t.provisional)
    ]
    arrays += [a for graph in snapshot.graphs.values() for a in graph]
    return [a.tobytes() for a in arrays]


def test_a_snapshot_never_changes_afterwards() -> None:
    session, held = Session(PAPERS, truth=walk("path=square&noise=1&rate_hz=50").truth), []
    for i, sample in enumerate(WALK[:1500]):
        session.take(sample)
        if i == 400:
            tell(session, GAIN)
        if i == 900:
            tell(session, ApplyCandidate(), OTHER)
        if i % 50 == 0:
            snapshot = session.snapshot()
            held.append((snapshot, frozen(snapshot), copy.copy(snapshot.health["foot"].dropped)))
    for snapshot, before, dropped in held:
        assert frozen(snapshot) == before
        assert snapshot.health["foot"].dropped == dropped


def test_health_counts_what_was_dropped_and_saturated() -> None:
    session = fed(Session(PAPERS), WALK[:10])
    last = WALK[9]
    fed(
        session,
        [last, WALK[3], last._replace(device_ns=last.device_ns + 1, specific_force_b=(math.nan, 0.0, 0.0))],
    )
    fed(session, [last._replace(device_ns=last.device_ns + 2, saturation=0b10)])
    health = session.snapshot().health["foot"]
    assert health.dropped == {"repeated time": 1, "time went backward": 1, "not a finite number": 1}
    assert (health.taken, health.saturated, health.segments) == (11, 1, 1)
    assert session.number == 14


def test_two_feet_have_each_its_own_walk() -> None:
    query = "feet=2&strides=6&rate_hz=50"
    feet = [one_by_one(foot(query, i)) for i in (0, 1)]
    mixed = sorted([*feet[0], *feet[1]], key=lambda s: s.device_ns)
    session = fed(Session(PAPERS, truth=walk(query).truth), mixed)
    tell(session, GAIN, ApplyCandidate())
    snapshot = session.snapshot()
    assert [(f.sensor, f.role) for f in snapshot.main.feet] == [
        ("left", Role.LEFT),
        ("right", Role.RIGHT),
    ]
    for view in snapshot.main.feet:
        assert view.strides == walk(query).feet[view.sensor].strides
        assert_main_is(session, Settings(gain_stance=2.0), mixed, view.sensor)
        assert view.error_m is not None
        assert view.error_m < 0.2


def test_the_truth_turns_with_the_start_heading() -> None:
    query = "strides=10&heading_deg=90&rate_hz=100"
    samples = one_by_one(foot(query))
    for settings_ in (PAPERS, Settings(start_heading_rad=1.0), Settings(magnetometer=True)):
        session = fed(Session(settings_, truth=walk(query).truth), samples)
        error_m = session.snapshot().main.feet[0].error_m
        assert error_m is not None
        assert error_m < 0.1


def test_the_cost_of_a_frame_does_not_grow_with_the_walk() -> None:
    """Counted in arrays and bytes that are new since the frame before, never in time."""
    session = Session(PAPERS, truth=walk("path=oval&size_m=60&duration_s=1200&rate_hz=50").truth)
    session.apply(order(GAIN))
    settle(session)
    known: set[str] = set()
    for i, sample in enumerate(LONG):
        session.take(sample)
        if i % 3 or not (2000 < i < 4000 or i > len(LONG) - 2000):
            continue
        snapshot = session.snapshot()
        trails = [*(f.trail for f in snapshot.main.feet), *snapshot.truth.values()]
        assert sum(len(t.pieces) for t in trails) < 80
        new = {p.key for t in trails for p in t.pieces} - known
        assert len(new) <= 4 or i < 2010 or i <= len(LONG) - 1990
        known |= new
        assert all(len(a) <= 320 for graph in snapshot.graphs.values() for a in graph)
        assert sum(a.nbytes for t in trails for a in (t.growing, t.provisional)) < 60_000
        assert len(snapshot.changes) <= 20
        assert len(snapshot.main.feet[0].footprints) <= 40


def test_a_foot_that_rests_for_long_is_a_short_trail() -> None:
    session = fed(Session(PAPERS), one_by_one(still(200.0, 50.0)))
    view = session.snapshot().main.feet[0]
    assert (view.to_start_m, view.strides) == (0.0, 0)
    assert length_of(view.trail) == 0.0


def test_two_feet_in_hindsight_have_one_heading_and_the_page_is_told() -> None:
    samples = [one_by_one(foot("feet=2&strides=6&rate_hz=50", number)) for number in (0, 1)]
    both = [sample for pair in zip(*samples, strict=True) for sample in pair]

    def looked_back() -> Session:
        session = fed(Session(Settings(estimator="kalman", hindsight=True)), both)
        assert session.snapshot().main.smoothed_s is None
        tell(session, LookBack())
        return session

    once, again = looked_back(), looked_back()
    assert once.snapshot().main.linked
    assert once.snapshot().main.smoothed_s is not None
    assert main_rows(once, "right").tobytes() == main_rows(again, "right").tobytes()
    assert not session_of_one().snapshot().main.linked


def session_of_one() -> Session:
    session = fed(
        Session(Settings(estimator="kalman", hindsight=True)), one_by_one(foot("strides=6&rate_hz=50"))
    )
    tell(session, LookBack())
    return session


def test_a_foot_that_begins_later_keeps_its_place_in_time() -> None:
    """Whatever the first stamp is: 0 is one like any other."""
    for begin_ns in (0, 5_000_000_000):
        session = Session(PAPERS)
        for ns in range(0, 3_000_000_000, 10_000_000):
            session.take(sessions.sample(begin_ns + ns)._replace(sensor="left"))
            if ns >= 2_000_000_000:
                session.take(sessions.sample(begin_ns + ns)._replace(sensor="right"))
        assert [store.worn.offset_s for store in session.stores.values()] == [0.0, 2.0]
        assert session.snapshot().t_s == pytest.approx(2.99)
