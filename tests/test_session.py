"""The session: a log in, a snapshot out; results that do not depend on when they come."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.blocks import BLOCK
from app.motion.basics import Floats, InputError, Role
from app.motion.commands import (
    ApplyCandidate,
    Command,
    DropCandidate,
    KeepAs,
    LookBack,
    Order,
    Pause,
    ReplaceCandidate,
    ResetHeading,
    RestartHere,
    SetApplyAtOnce,
    SetCandidate,
    SwapAB,
    Undo,
)
from app.motion.samples import Sample, Samples
from app.motion.snapshot import Change, Snapshot, Trail
from app.rotation import from_yaw, rotate, yaw_of
from app.session import Session
from app.settings import Settings
from tests.estimator.walks import PAPERS, estimate, foot, one_by_one, rows_of, still, walk

WALK = one_by_one(foot("path=square&noise=1&rate_hz=50"))
GAIN = SetCandidate((("gain_stance", 2.0),))
OTHER = SetCandidate((("threshold_radps", 0.7),))


def order(command: Command, who: str = "me") -> Order:
    return Order(command, who, 7)


def fed(session: Session, samples: Iterable[Sample]) -> Session:
    for sample in samples:
        session.take(sample)
    return session


def settle(session: Session) -> None:
    """What the shell does with ``wanted``, until nothing is."""
    while (job := session.applying.wanted) is not None:
        session.applying.adopt(job, job.run())


def tell(session: Session, *commands: Command) -> None:
    for command in commands:
        session.apply(order(command))
        settle(session)


def main_rows(session: Session, sensor: str = "foot") -> Floats:
    return rows_of(session.main.feet[sensor].tracker)


def assert_main_is(session: Session, chosen: Settings, samples: list[Sample], sensor: str = "foot") -> None:
    """To the bit, what a session would have that had these settings from the start."""
    fresh = fed(Session(chosen), samples)
    assert session.main.settings == chosen
    assert main_rows(session, sensor).tobytes() == main_rows(fresh, sensor).tobytes()


def test_an_empty_session_has_a_snapshot() -> None:
    snapshot = Session(PAPERS).snapshot()
    assert (snapshot.number, snapshot.t_s, snapshot.main.feet, snapshot.candidate) == (0, 0.0, (), None)
    assert snapshot.candidate_settings == PAPERS
    assert Session(PAPERS, truth=walk().truth).snapshot().truth == {}


def test_live_is_batch_to_the_bit() -> None:
    session = fed(Session(PAPERS), WALK)
    assert main_rows(session).tobytes() == rows_of(estimate(foot("path=square&noise=1&rate_hz=50"))).tobytes()


def test_a_candidate_is_the_whole_walk_under_other_settings_then_live_beside_main() -> None:
    session = fed(Session(PAPERS), WALK[:1200])
    session.apply(order(GAIN))
    assert session.snapshot().pending
    assert session.applying.settings.gain_stance == 2.0
    settle(session)
    fed(session, WALK[1200:])
    assert session.applying.candidate is not None
    ghost = rows_of(session.applying.candidate.feet["foot"].tracker)
    assert ghost.tobytes() == main_rows(fed(Session(Settings(gain_stance=2.0)), WALK)).tobytes()
    assert_main_is(session, PAPERS, WALK)


def test_apply_drop_and_undo() -> None:
    session = fed(Session(PAPERS), WALK[:800])
    tell(session, GAIN, ApplyCandidate())
    assert session.applying.candidate is None
    assert_main_is(session, Settings(gain_stance=2.0), WALK[:800])
    tell(session, OTHER)
    assert session.applying.settings == Settings(gain_stance=2.0, threshold_radps=0.7)
    tell(session, DropCandidate())
    assert session.applying.settings == session.main.settings
    tell(session, OTHER, ApplyCandidate(), SetCandidate((("gain_swing", 0.1),)), ApplyCandidate())
    assert session.snapshot().undo_depth == 3
    gone = []
    for _ in range(4):
        now = session.main.settings
        gone.append((now.gain_stance, now.threshold_radps, now.gain_swing))
        tell(session, Undo())
    assert gone == [(2.0, 0.7, 0.1), (2.0, 0.7, 0.0), (2.0, 1.0, 0.0), (1.05, 1.0, 0.0)]
    assert_main_is(session, PAPERS, WALK[:800])


def test_at_once_applies_a_slider_by_itself() -> None:
    session = fed(Session(PAPERS), WALK[:500])
    tell(session, GAIN, SetApplyAtOnce(True))
    assert session.main.settings.gain_stance == 2.0
    tell(session, OTHER)
    assert session.main.settings == Settings(gain_stance=2.0, threshold_radps=0.7)
    assert session.snapshot().undo_depth == 2


def test_a_and_b_swap() -> None:
    session = fed(Session(PAPERS), WALK[:500])
    tell(session, SwapAB(), KeepAs("A"), GAIN, ApplyCandidate(), KeepAs("B"))
    for slot, gain in (("A", 1.05), ("B", 2.0), ("A", 1.05)):
        tell(session, SwapAB())
        assert (session.snapshot().slot_now, session.main.settings.gain_stance) == (slot, gain)
    tell(session, OTHER, ApplyCandidate())
    assert session.snapshot().slot_now is None


def test_a_swap_back_overtakes_an_apply_and_both_can_be_undone() -> None:
    session = fed(Session(PAPERS), WALK[:500])
    tell(session, KeepAs("A"), SetCandidate((("gain_stance", 3.0),)), ApplyCandidate(), KeepAs("B"), SwapAB())
    depth = session.snapshot().undo_depth
    session.apply(order(SwapAB()))  # to B, which takes a while …
    session.apply(order(SwapAB()))  # … and back to A before it is there
    settle(session)
    assert session.main.settings.gain_stance == 1.05
    assert session.snapshot().undo_depth == depth + 2
    tell(session, Undo())
    assert session.main.settings.gain_stance == 3.0
    tell(session, Undo())
    assert session.main.settings.gain_stance == 1.05


def test_every_apply_is_logged_with_who_what_and_when() -> None:
    session = fed(Session(PAPERS), WALK[:100])
    session.apply(Order(GAIN, "browser 2", 11))
    settle(session)
    session.apply(Order(ApplyCandidate(), "browser 3", 12))
    assert session.snapshot().changes == (Change(102, 12, "browser 3", "applied: gain_stance 1.05 → 2"),)


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


# --- what comes back does not depend on when --------------------------------------------------------

COMMANDS: list[Command] = [
    GAIN,
    OTHER,
    SetCandidate((("magnetometer", True),)),
    ApplyCandidate(),
    DropCandidate(),
    Undo(),
    KeepAs("A"),
    SwapAB(),
    SetApplyAtOnce(True),
    RestartHere(),
    ReplaceCandidate(PAPERS, "reset"),
]


Script = list[tuple[int, int, bool]]


def scripts(commands: int) -> st.SearchStrategy[Script]:
    """So many samples, then an order, then its work done at once or (True) not yet."""
    return st.lists(
        st.tuples(st.integers(0, 120), st.sampled_from(range(commands)), st.booleans()), max_size=8
    )


def played(script: Script) -> Session:
    """Samples and orders, the work done at once or not before the end."""
    session, taken = Session(PAPERS), 0
    for count, command, waits in script:
        fed(session, WALK[taken : taken + count])
        taken += count
        session.apply(order(COMMANDS[command]))
        if not waits:
            settle(session)
    fed(session, WALK[taken : taken + 50])
    settle(session)
    return session


@settings(max_examples=60)
@given(scripts(6))
@example([(99, 0, True), (9, 3, True), (9, 1, True)])
@example([(99, 0, False), (9, 3, False), (9, 1, False), (9, 3, True), (9, 5, True), (9, 5, True)])
@example([(99, 0, True), (9, 3, True), (9, 4, True)])
@example([(99, 0, True), (9, 3, True), (9, 5, True)])
def test_main_and_candidate_do_not_depend_on_when_work_is_done(script: Script) -> None:
    one, other = played([(n, command, False) for n, command, _ in script]), played(script)
    assert one.main.settings == other.main.settings
    assert one.applying.settings == other.applying.settings
    for _sensor in one.main.feet:
        assert main_rows(one).tobytes() == main_rows(other).tobytes()
    assert bool(one.applying.candidate) == bool(other.applying.candidate)


@settings(max_examples=40)
@given(scripts(len(COMMANDS)))
def test_any_orders_leave_a_session_whole(script: Script) -> None:
    session = played(script)
    snapshot = session.snapshot()
    assert snapshot.pending is False
    for store in session.stores.values():
        matrix = store.samples.table(0, store.samples.end)
        samples = Samples("foot", Role.FOOT, 0, matrix, np.empty(0, np.uint16))
        assert main_rows(session).tobytes() == rows_of(estimate(samples, session.main.settings)).tobytes()


def test_a_late_result_catches_up_with_the_samples_taken_meanwhile() -> None:
    session = fed(Session(PAPERS), WALK[:600])
    session.apply(order(GAIN))
    job = session.applying.wanted
    assert job is not None
    track = job.run()
    fed(session, WALK[600:])
    session.applying.adopt(job, track)
    assert session.applying.candidate is not None
    assert (
        rows_of(session.applying.candidate.feet["foot"].tracker).tobytes()
        == main_rows(fed(Session(Settings(gain_stance=2.0)), WALK)).tobytes()
    )


def test_an_outdated_result_is_shown_meanwhile_and_after_a_restart_let_go() -> None:
    session = fed(Session(PAPERS), WALK[:300])
    session.apply(order(GAIN))
    first = session.applying.wanted
    session.apply(order(OTHER))
    second = session.applying.wanted
    assert first is not None
    assert second is not None
    session.applying.adopt(first, first.run())
    assert session.applying.candidate is not None
    assert session.applying.candidate.settings == first.settings
    assert session.applying.settings == second.settings
    assert session.applying.wanted is second
    session.apply(order(RestartHere()))
    session.applying.adopt(second, second.run())
    assert session.main.feet == {}


def test_an_apply_under_way_survives_a_slider_and_a_restart() -> None:
    session = fed(Session(PAPERS), WALK[:300])
    for command in (GAIN, ApplyCandidate(), OTHER):
        session.apply(order(command))
    settle(session)
    assert session.main.settings == Settings(gain_stance=2.0)
    assert session.applying.candidate is not None
    assert session.applying.candidate.settings == Settings(gain_stance=2.0, threshold_radps=0.7)
    for later in (ApplyCandidate(), SetCandidate((("gain_swing", 0.5),)), RestartHere()):
        session.apply(order(later))
    assert session.main.settings == Settings(gain_stance=2.0, threshold_radps=0.7)
    assert session.applying.settings.gain_swing == 0.5


def test_a_sensor_that_never_delivered_is_no_foot() -> None:
    session = fed(Session(PAPERS), [Sample("left", 0, 0, 0, (math.nan, 0, 0), (0, 0, 0)), *WALK[:100]])
    tell(session, GAIN, ApplyCandidate(), ResetHeading())
    snapshot = session.snapshot()
    assert [f.sensor for f in snapshot.main.feet] == ["foot"]
    assert snapshot.health["left"].dropped == {"not a finite number": 1}


# --- heading, restart, replay of the log ------------------------------------------------------------


@pytest.mark.parametrize("magnetometer", [False, True])
def test_reset_heading_points_the_toe_north_and_turns_the_whole_walk(magnetometer: bool) -> None:
    session = fed(Session(Settings(magnetometer=magnetometer)), WALK[:900])
    before = main_rows(session)
    yaw = yaw_of(tuple(before[-1, 6:10].tolist()))
    assert abs(yaw) > 0.5
    tell(session, ResetHeading())
    after = main_rows(session)
    assert yaw_of(tuple(after[-1, 6:10].tolist())) == pytest.approx(0.0, abs=1e-6)
    turn = from_yaw(-yaw)
    for a, b in zip(before[::100], after[::100], strict=True):
        assert rotate(turn, tuple(a[:3])) == pytest.approx(tuple(b[:3]), abs=1e-6)
    fed(session, WALK[900:1000])
    tell(session, ResetHeading())
    assert yaw_of(tuple(main_rows(session)[-1, 6:10].tolist())) == pytest.approx(0.0, abs=1e-6)


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


# --- snapshots --------------------------------------------------------------------------------------


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


# --- a long walk ------------------------------------------------------------------------------------

LONG = one_by_one(foot("path=oval&size_m=60&duration_s=1200&rate_hz=50"))


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


def budgeted(budget: int, samples: Iterable[Sample], settings_: Settings = PAPERS) -> Session:
    return fed(Session(settings_, budget_bytes=budget), samples)


ROOM = 7 * BLOCK * 8 * (10 + 2 + 2 * 12)  # seven blocks of samples, clocks, main and a candidate


def test_over_the_budget_the_oldest_block_goes_and_the_page_is_told() -> None:
    session = Session(PAPERS, budget_bytes=ROOM)
    block = BLOCK * 8 * (10 + 2 + 2 * 12)
    for i, sample in enumerate(LONG):
        session.take(sample)
        if i == 20_000:
            tell(session, GAIN)
        if i % 1000 == 0:
            assert session.stored_bytes <= ROOM + block
    snapshot = session.snapshot()
    start = session.stores["foot"].samples.start
    assert start % BLOCK == 0
    assert start > 0
    assert snapshot.hindsight_from_s == pytest.approx(start / 50.0)
    assert snapshot.stored_bytes <= snapshot.budget_bytes
    whole = rows_of(estimate(foot("path=oval&size_m=60&duration_s=1200&rate_hz=50")))
    assert main_rows(session).tobytes() == whole[start:].tobytes()


def test_after_the_cut_a_candidate_goes_on_from_mains_checkpoint() -> None:
    session = budgeted(ROOM, LONG)
    start = session.stores["foot"].samples.start
    assert start
    before = session.snapshot().main.feet[0]
    tell(session, SetCandidate((("gain_swing", 0.001),)))
    assert session.applying.candidate is not None
    ghost = session.applying.candidate.feet["foot"].tracker
    assert ghost.rows.start == start
    assert rows_of(ghost)[0, :3] == pytest.approx(main_rows(session)[0, :3], abs=1e-3)
    assert ghost.stride_count == before.strides
    tell(session, ApplyCandidate())
    after = session.snapshot().main.feet[0]
    assert after.strides == before.strides
    assert after.distance_m == pytest.approx(before.distance_m, rel=0.01)


def length_of(trail: Trail) -> float:
    segments = np.concatenate([*(p.segments for p in trail.pieces), trail.growing, trail.provisional])
    return float(np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum())


def test_the_trail_before_the_cut_survives_an_apply_and_turns_with_it() -> None:
    session = budgeted(ROOM, LONG)
    before = session.snapshot().main.feet[0].trail
    tell(session, SetCandidate((("gain_stance", 1.06),)), ApplyCandidate())
    after = session.snapshot().main.feet[0].trail
    assert length_of(after) == pytest.approx(length_of(before), rel=0.05)
    tell(session, ResetHeading())
    yaw = session.main.settings.start_heading_rad
    turned = session.snapshot().main.feet[0].trail
    assert length_of(turned) == pytest.approx(length_of(after), rel=0.01)
    assert turned.pieces[0].key != after.pieces[0].key
    point, was = turned.pieces[0].segments[-1, 1], after.pieces[0].segments[-1, 1]
    assert rotate(from_yaw(yaw), tuple(was.tolist())) == pytest.approx(tuple(point.tolist()), abs=1e-3)
    assert yaw_of(tuple(main_rows(session)[-1, 6:10].tolist())) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("late", [0, 2 * BLOCK, 20 * BLOCK])
def test_a_result_that_comes_after_blocks_have_gone_is_the_same(late: int) -> None:
    session = budgeted(ROOM, LONG[:30_000])
    session.apply(order(GAIN))
    job = session.applying.wanted
    assert job is not None
    track = job.run()
    fed(session, LONG[30_000 : 30_000 + late])
    session.applying.adopt(job, track)
    settle(session)
    assert session.applying.candidate is not None
    ghost, store = session.applying.candidate.feet["foot"].tracker, session.stores["foot"].samples
    assert (ghost.rows.start, ghost.rows.end) == (store.start, store.end)
    assert set(session.main.bases()) == {"foot"}
    tell(session, ApplyCandidate(), OTHER, ApplyCandidate())
    assert session.main.feet["foot"].tracker.rows.start == store.start
    fed(session, LONG[30_000 + late :])
    assert np.isfinite(main_rows(session)).all()
    assert session.stored_bytes <= ROOM


def test_a_foot_that_rests_for_long_is_a_short_trail() -> None:
    session = fed(Session(PAPERS), one_by_one(still(200.0, 50.0)))
    view = session.snapshot().main.feet[0]
    assert (view.to_start_m, view.strides) == (0.0, 0)
    assert length_of(view.trail) == 0.0


def test_one_drag_is_one_step_to_undo() -> None:
    session = fed(Session(PAPERS), WALK)
    moves = [
        ("a", 0.5, 0),
        ("a", 0.6, 10**8),
        ("a", 0.7, 2 * 10**8),
        ("b", 2.0, 3 * 10**8),
        ("b", 2.5, 9 * 10**9),
    ]
    tell(session, SetApplyAtOnce(True))
    depths = []
    for who, gain, host_ns in moves:
        session.apply(Order(SetCandidate((("gain_stance", gain),)), who, host_ns))
        settle(session)
        depths.append(session.snapshot().undo_depth)
    assert depths == [1, 1, 1, 2, 3]
    tell(session, Undo(), Undo())
    assert session.main.settings.gain_stance == 0.7


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
