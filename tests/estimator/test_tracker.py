"""Live = batch = from a checkpoint, to the bit; strides in gaitmap's meanings."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.blocks import BLOCK, Blocks
from app.estimator.tracker import Tracker
from app.motion.basics import Floats
from app.motion.estimate import ROW_WIDTH
from app.motion.samples import SAMPLE_WIDTH, Samples
from app.settings import Settings
from tests.estimator.walks import PAPERS, estimate, foot, rows_of, still, table_of, walk, without

# 103 s at 100 Hz: two boundaries of a block, and a gap
LONG = without(foot("noise=1&path=oval&distance_m=120"), 60.3, 61.0)


def advanced(samples: Samples, cuts: list[int], settings: Settings = PAPERS) -> Tracker:
    """The samples handed over in pieces that end at ``cuts``."""
    tracker, table = Tracker(settings), Blocks(SAMPLE_WIDTH)
    for begin, end in zip([0, *cuts], [*cuts, len(samples)], strict=True):
        table.extend(samples.matrix[begin:end])
        tracker.advance(table)
    return tracker


def assert_same(one: Tracker, other: Tracker) -> None:
    begin = max(one.rows.start, other.rows.start)
    assert one.rows.end == other.rows.end
    assert one.rows.table(begin, one.rows.end).tobytes() == other.rows.table(begin, other.rows.end).tobytes()
    assert one.state.tobytes() == other.state.tobytes()
    count = min(len(one.strides), len(other.strides))
    first, second = one.strides[-count:], other.strides[-count:]
    if one.rows.start != other.rows.start:  # of a swing whose rows are gone in part, so is the lift
        first, second = (
            [s._replace(lift_m=0.0) for s in first[:1]],
            [s._replace(lift_m=0.0) for s in second[:1]],
        )
        assert one.strides[1 - count :] == other.strides[1 - count :]
    assert first == second
    assert (one.stride_count, one.distance_m) == (other.stride_count, other.distance_m)


def test_one_sample_at_a_time_is_the_whole_to_the_bit() -> None:
    assert len(LONG) > 2 * BLOCK
    assert_same(advanced(LONG, list(range(1, len(LONG)))), estimate(LONG))


@settings(max_examples=25)
@given(st.lists(st.one_of(st.integers(1, len(LONG) - 1), st.integers(BLOCK - 3, BLOCK + 3)), max_size=8))
def test_chunks_of_any_size_are_the_whole_to_the_bit(cuts: list[int]) -> None:
    assert_same(advanced(LONG, sorted(set(cuts))), estimate(LONG))


@settings(max_examples=10)
@given(st.floats(0.0, 5.0), st.floats(0.0, 2.0), st.floats(0.2, 3.0), st.floats(0.0, 0.2), st.booleans())
def test_under_any_settings(ks: float, kd: float, threshold: float, duration: float, compass: bool) -> None:
    chosen = Settings(
        gain_stance=ks,
        gain_swing=kd,
        threshold_radps=threshold,
        min_duration_s=duration,
        magnetometer=compass,
    )
    assert_same(advanced(LONG, list(range(7, len(LONG), 7)), chosen), estimate(LONG, chosen))


def test_a_checkpoint_goes_on_as_if_nothing_had_happened() -> None:
    whole, table = estimate(LONG), table_of(LONG.matrix)
    for row in (BLOCK, 2 * BLOCK):
        rest = table.share()
        for _ in range(row // BLOCK):
            rest.drop_oldest()
        later = Tracker(PAPERS, row, whole.checkpoints[row])
        later.advance(rest)
        assert later.rows.start == row
        assert_same(later, whole)


def test_a_checkpoint_is_a_copy() -> None:
    tracker = estimate(LONG)
    kept = tracker.checkpoints[BLOCK].state.tobytes()
    Tracker(Settings(gain_stance=2.0, start_heading_rad=1.0), BLOCK, tracker.checkpoints[BLOCK])
    tracker.advance(
        table_of(np.vstack([LONG.matrix, still(1.0).matrix + LONG.matrix[-1] * (np.arange(10) == 0)]))
    )
    assert tracker.checkpoints[BLOCK].state.tobytes() == kept


def dropped(tracker: Tracker, table: Blocks) -> None:
    tracker.drop_oldest()
    table.drop_oldest()


def test_old_rows_may_go_while_the_walk_goes_on() -> None:
    tracker, table = Tracker(PAPERS), Blocks(SAMPLE_WIDTH)
    for begin in range(0, len(LONG), 1000):
        table.extend(LONG.matrix[begin : begin + 1000])
        tracker.advance(table)
        if len(table) > BLOCK + 500:
            dropped(tracker, table)
    assert tracker.rows.start == 2 * BLOCK
    assert set(tracker.checkpoints) == {2 * BLOCK}
    assert_same(tracker, estimate(LONG))


def test_a_swing_that_began_in_a_block_that_is_gone_still_closes() -> None:
    moving = rows_of(estimate(LONG))[:, 10]
    shift = next(k for k in range(200) if moving[BLOCK + k - 20 : BLOCK + k + 20].all())
    samples = Samples(
        "foot", LONG.role, 0, LONG.matrix[shift:] - LONG.matrix[shift] * (np.arange(10) == 0), LONG.saturation
    )
    whole = estimate(samples)
    assert rows_of(whole)[BLOCK - 5 : BLOCK + 5, 10].all()
    base = whole.checkpoints[BLOCK]
    rest = table_of(samples.matrix)
    rest.drop_oldest()
    later = Tracker(PAPERS, BLOCK, base)
    later.advance(rest)
    assert_same(later, whole)


@pytest.mark.parametrize("turn", [0.5, -2.0])
def test_a_start_heading_given_after_old_samples_are_gone_turns_what_is_left(turn: float) -> None:
    plain, table = estimate(LONG), table_of(LONG.matrix)
    table.drop_oldest()
    later = Tracker(Settings(start_heading_rad=turn), BLOCK, plain.checkpoints[BLOCK])
    later.advance(table)
    turned = estimate(LONG, start_heading_rad=turn)
    assert rows_of(later) == pytest.approx(rows_of(turned)[BLOCK:], abs=1e-6)
    for ours, theirs in zip(later.strides, turned.strides[-len(later.strides) :], strict=True):
        assert tuple(ours[1:6]) == pytest.approx(tuple(theirs[1:6]), abs=1e-6)
        assert ours.end_n == pytest.approx(theirs.end_n, abs=1e-6)
        assert ours.turn_rad == pytest.approx(theirs.turn_rad, abs=1e-6)


def test_gravity_set_after_old_samples_are_gone_holds() -> None:
    plain, table = estimate(LONG), table_of(LONG.matrix)
    table.drop_oldest()
    for chosen, expected in (
        (Settings(gravity_from_rest=False, gravity_mps2=9.9), 9.9),
        (PAPERS, plain.checkpoints[BLOCK].state["gravity"][0]),
    ):
        later = Tracker(chosen, BLOCK, plain.checkpoints[BLOCK])
        assert later.state["gravity"][0] == expected
    unbiased = Tracker(Settings(bias_from_rest=False), BLOCK, plain.checkpoints[BLOCK])
    assert unbiased.state["bias_x"][0] == 0.0


def test_rows_before_settled_end_never_change() -> None:
    tracker, table = Tracker(PAPERS), Blocks(SAMPLE_WIDTH)
    seen = np.empty((0, ROW_WIDTH))
    for i in range(3000):
        table.extend(LONG.matrix[i : i + 1])
        tracker.advance(table)
        settled = tracker.settled_end
        assert settled >= len(seen)
        if i % 10 == 0:
            now = tracker.rows.table(0, settled)
            assert now[: len(seen)].tobytes() == seen.tobytes()
            seen = now


# --- strides ----------------------------------------------------------------------------------------


def test_strides_are_those_that_were_walked() -> None:
    tracker = estimate(foot("strides=30&stride_m=1.1&rate_hz=200&cadence_spm=100"))
    assert [s.number for s in tracker.strides] == list(range(1, 31))
    for stride in tracker.strides:
        assert stride.length_m == pytest.approx(1.1, abs=0.01)
        assert stride.lift_m == pytest.approx(0.1, abs=0.015)
        assert stride.turn_rad == pytest.approx(0.0, abs=1e-3)
    for stride in tracker.strides[1:]:
        assert stride.duration_s == pytest.approx(1.2, abs=0.011)
        assert stride.stance_s + stride.swing_s == pytest.approx(stride.duration_s)
        assert stride.duration_s == pytest.approx(stride.end_s - stride.start_s)
    assert tracker.distance_m == pytest.approx(sum(s.length_m for s in tracker.strides))


def test_each_stride_begins_where_the_last_ended() -> None:
    tracker = estimate(foot("strides=20&path=square"))
    for before, now in zip(tracker.strides, tracker.strides[1:], strict=False):
        assert now.start_s == before.end_s
        north, east = (now.end_n[i] - before.end_n[i] for i in (0, 1))
        assert now.length_m == pytest.approx(math.hypot(north, east))


@pytest.mark.parametrize(
    ("query", "sense"), [("path=square&laps=1", 1.0), ("path=oval&laps=1&size_m=60", 1.0)]
)
def test_turns_of_a_lap_sum_to_a_turn_positive_to_the_left(query: str, sense: float) -> None:
    heading = np.unwrap(walk(query).feet["foot"].heading_rad)
    left = -(heading[-1] - heading[0])
    assert abs(left) == pytest.approx(math.tau, abs=0.2)
    tracker = estimate(foot(query))
    assert sense * sum(s.turn_rad for s in tracker.strides) == pytest.approx(left, abs=0.05)


def test_a_stair_is_not_lift() -> None:
    tracker = estimate(foot("path=stairs&rate_hz=200&lift_m=0.12"))
    up = [s for s in tracker.strides if abs(s.end_n[2]) > 0.1]
    assert up
    for stride in tracker.strides:
        assert stride.lift_m < 0.30


def test_a_recording_of_nothing_is_no_walk() -> None:
    empty = Tracker(PAPERS)
    empty.advance(Blocks(SAMPLE_WIDTH))
    assert (empty.stride_count, empty.distance_m, empty.settled_end) == (0, 0.0, 0)


def closure_of(tracker: Tracker) -> float:
    end: Floats = rows_of(tracker)[-1, :3]
    return float(np.hypot(end[0], end[1]))
