"""Candidate, apply, undo, A and B: whatever the order in which work is done, the walk is the same."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.motion.basics import Role
from app.motion.commands import (
    ApplyCandidate,
    DropCandidate,
    KeepAs,
    Order,
    ResetHeading,
    RestartHere,
    SetApplyAtOnce,
    SetCandidate,
    SwapAB,
    Undo,
)
from app.motion.samples import Samples
from app.motion.snapshot import Change
from app.rotation import from_yaw, rotate, yaw_of
from app.session import Session
from app.settings import Settings
from tests.estimator.walks import PAPERS, estimate, rows_of
from tests.sessions import (
    COMMANDS,
    GAIN,
    OTHER,
    WALK,
    Script,
    assert_main_is,
    fed,
    main_rows,
    order,
    played,
    settle,
    tell,
)


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


def scripts(commands: int) -> st.SearchStrategy[Script]:
    """So many samples, then an order, then its work done at once or (True) not yet."""
    return st.lists(
        st.tuples(st.integers(0, 120), st.sampled_from(range(commands)), st.booleans()), max_size=8
    )


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
