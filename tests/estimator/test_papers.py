"""The papers' step as a whole: simulator truth, segments, which ω, edges."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.estimator.tracker import Tracker
from app.motion.basics import Floats
from app.motion.estimate import ROW_WIDTH
from app.motion.samples import Samples
from app.rotation import yaw_of
from app.settings import Settings
from tests.estimator.walks import G, estimate, foot, rows_of, samples_of, still, table_of, walk, without


def errors_of(query: str, number: int = 0, settings: Settings | None = None) -> tuple[Tracker, Floats]:
    """A simulated walk's estimate, and where it is off the truth [n, 3]."""
    samples = foot(query, number)
    tracker = estimate(samples, settings or Settings())
    position_n, _ = walk(query).truth(samples.sensor, samples.matrix[:, 0] * 1e-9)
    return tracker, rows_of(tracker)[:, :3] - position_n


def test_the_papers_model_at_50_hz_ends_within_10_centimetres() -> None:
    """The figure: 120 m straight, 100 strides of 100."""
    tracker, error = errors_of("model=papers&rate_hz=50")
    assert tracker.stride_count == 100
    assert math.hypot(*error[-1, :2]) < 0.10
    assert abs(error[-1, 2]) < 0.5


def test_the_smooth_model_at_400_hz_ends_within_5_centimetres() -> None:
    tracker, error = errors_of("rate_hz=400")
    assert tracker.stride_count == 100
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.05
    assert np.abs(error[:, 2]).max() < 0.05


@pytest.mark.parametrize("query", ["path=square", "path=eight", "path=oval&size_m=60", "path=stairs"])
@pytest.mark.parametrize("number", [0, 1])
def test_two_feet_go_where_their_truth_goes(query: str, number: int) -> None:
    query += "&feet=2&rate_hz=200"
    tracker, error = errors_of(query, number)
    assert tracker.stride_count == walk(query).feet[("left", "right")[number]].strides
    assert np.abs(error).max() < 0.10


def test_stairs_climb() -> None:
    tracker, error = errors_of("path=stairs&rate_hz=200")
    rows = rows_of(tracker)
    assert -rows[:, 2].min() > 1.0
    assert np.abs(error[:, 2]).max() < 0.05


def other_rate(query: str, choice: str) -> Floats:
    """The end's error with ω of the last sample, or of this one, in place of their mean.

    A sample whose neighbours' mean is a rate w: feed w such that (w₋₁ + w)/2 is the one wanted.
    """
    samples = foot(query)
    wanted = samples.matrix[:, 4:7]
    if choice == "previous":
        wanted = np.vstack([wanted[:1], wanted[:-1]])
    fed = np.zeros_like(wanted)
    for i in range(1, len(wanted)):  # rests at 0 in every stance, so no error piles up
        fed[i] = 2 * wanted[i] - fed[i - 1] if np.any(wanted[i]) else 0.0
    matrix = samples.matrix.copy()
    matrix[:, 4:7] = fed
    tracker = estimate(replace(samples, matrix=matrix), min_duration_s=0.06)
    position_n, _ = walk(query).truth("foot", matrix[-1:, 0] * 1e-9)
    error: Floats = rows_of(tracker)[-1, :3] - position_n[0]
    return error


def test_the_mean_rate_turns_the_foot() -> None:
    """Which ω: on the papers' model, whose ω jumps, the height tells the three apart."""
    _, error = errors_of("model=papers&rate_hz=100")
    down = error[-1, 2]
    assert abs(down) < 2.0
    for choice in ("previous", "current"):
        assert abs(other_rate("model=papers&rate_hz=100", choice)[2] - down) > 0.5


def test_the_mean_rate_is_pinned_by_a_turn_that_speeds_up() -> None:
    """ω grows linearly: the mean integrates it exactly, previous and current are off by ½ω·dt."""
    t_s = np.arange(301) / 100.0
    rate = np.zeros((301, 3))
    rate[100:, 2] = 1.2 + 2.0 * (t_s[100:] - t_s[100])
    tracker = estimate(samples_of(t_s, np.array([0.0, 0.0, -G]), rate))
    turned = 1.2 * 2.0 + 0.5 * 2.0 * 2.0**2 + 0.5 * 0.01 * 1.2  # the ramp up to 1.2 takes one sample
    yaw = yaw_of(tuple(rows_of(tracker)[-1, 6:10].tolist()))
    assert math.remainder(yaw - turned, math.tau) == pytest.approx(0.0, abs=1e-9)


def test_edges_lie_at_the_last_quiet_sample_and_the_first() -> None:
    """Back-dated: the rows between are swing, whatever Γ is."""
    samples = foot("model=papers&rate_hz=200&strides=5")
    rates = np.linalg.norm(samples.matrix[:, 4:7], axis=1)
    for min_duration_s in (0.0, 0.03, 0.06, 0.1):
        phase = rows_of(estimate(samples, min_duration_s=min_duration_s, bias_from_rest=False))[:, 10]
        contrary = np.flatnonzero(rates >= 1.0)
        found = np.flatnonzero(phase)
        assert found[0] == contrary[0]
        assert found[-1] == contrary[-1] + 1


# --- segments ---------------------------------------------------------------------------------------


def test_a_gap_in_a_stance_loses_nothing() -> None:
    samples = foot("strides=10&rate_hz=100")
    whole, cut = estimate(samples), estimate(without(samples, 5.05, 5.06))
    assert cut.segments == []
    # the foot stands from 5.0 to 5.4: hold it there for 10 s more, unseen
    matrix = samples.matrix.copy()
    matrix[matrix[:, 0] >= 5.1e9, 0] += 10e9
    gap = estimate(replace(samples, matrix=matrix))
    assert len(gap.segments) == 1
    assert gap.stride_count == whole.stride_count
    assert rows_of(gap)[-1, :3] == pytest.approx(rows_of(whole)[-1, :3], abs=0.02)


@pytest.mark.parametrize("begin_s", [4.5, 4.6, 4.7, 4.8, 4.95])
def test_nothing_is_integrated_across_a_gap(begin_s: float) -> None:
    """10 s missing from mid-swing on: the foot stays where it was last seen until it is seen to move."""
    samples = foot("strides=20&rate_hz=100&path=eight")
    cut = without(samples, begin_s, 14.95)
    tracker = estimate(cut)
    rows, edge = rows_of(tracker), tracker.segments[0]
    assert cut.matrix[edge, 0] - cut.matrix[edge - 1, 0] > 9e9
    assert rows[edge, :3] == pytest.approx(rows[edge - 1, :3], abs=1e-12)
    assert not rows[edge, 3:6].any()
    q_before, q_after = (tuple(rows[i, 6:10].tolist()) for i in (edge - 1, edge + 60))
    assert np.isfinite(rows).all()
    for stride in tracker.strides:
        assert stride.length_m < 1.5
        assert stride.duration_s < 2.0
    assert abs(math.hypot(*q_before) - 1) < 1e-9
    assert abs(math.hypot(*q_after) - 1) < 1e-9


def segment_of(rows: Floats, dt_s: float, gap_s: float, after: Floats) -> Samples:
    """Forces and rates [n, 6], a gap, and more of them."""
    t_s: Floats = np.arange(len(rows) + len(after), dtype=np.float64) * dt_s
    t_s[len(rows) :] += gap_s
    both = np.vstack([rows, after])
    return samples_of(t_s, both[:, :3], both[:, 3:])


QUIET = np.tile([0.0, 0.0, -G, 0.0, 0.0, 0.0], (100, 1))


def spinning(n: int, forward: float = 0.0) -> Floats:
    rows = np.tile([forward, 0.0, -G, 0.0, 0.0, 5.0], (n, 1))
    rows[1::2, 5] = -5.0
    return rows


def test_a_swing_cut_short_keeps_its_travel_and_a_new_stride_starts_after_it() -> None:
    samples = segment_of(
        np.vstack([QUIET, spinning(20, 1.0)]), 0.01, 5.0, np.vstack([QUIET, spinning(20), QUIET])
    )
    tracker = estimate(samples, gain_stance=0.0)
    rows = rows_of(tracker)
    assert rows[119, 0] == pytest.approx(0.5 * 0.2**2, rel=0.1)
    assert rows[120, 0] == rows[119, 0]
    assert tracker.stride_count == 1
    stride = tracker.strides[0]
    assert stride.stance_s == 0.0  # no contact before it in its segment
    assert stride.start_s == pytest.approx(samples.matrix[219, 0] * 1e-9)
    assert stride.start_s > 6.0


def test_a_swing_whose_end_was_pending_closes_with_its_update() -> None:
    """Three quiet samples, too few for Γ, and then the gap."""
    first = np.vstack([QUIET, spinning(20, 1.0), QUIET[:3]])
    tracker = estimate(segment_of(first, 0.01, 5.0, QUIET), gain_stance=0.0)
    rows = rows_of(tracker)
    assert tracker.stride_count == 1
    assert tracker.strides[0].end_s == pytest.approx(1.20)
    assert not rows[121:, 3:6].any()
    assert rows[121:, :3] == pytest.approx(np.tile(rows[120, :3], (len(rows) - 121, 1)), abs=1e-12)
    assert (rows[100:121, 10] == 1.0).all()
    assert (rows[121:, 10] == 0.0).all()


def test_a_lift_that_was_pending_at_a_gap_was_none() -> None:
    first = np.vstack([QUIET, spinning(3, 5.0)])
    rows = rows_of(estimate(segment_of(first, 0.01, 5.0, QUIET), gain_stance=0.0))
    assert not rows[:, :6].any()
    assert not rows[:, 10].any()


def test_integration_begins_with_the_acceleration_of_the_last_quiet_sample() -> None:
    """Velocity one sample after the lift is the mean of both accelerations, held for dt."""
    first = np.vstack([QUIET, spinning(20)])
    first[99, 0], first[100:, 0] = 3.0, 1.0
    rows = rows_of(estimate(segment_of(first, 0.01, 0.0, QUIET[:1]), gain_stance=0.0))
    assert rows[99, 3] == 0.0
    assert math.hypot(*rows[100, 3:5]) == pytest.approx(0.5 * (3.0 + 1.0) * 0.01, rel=1e-3)


def test_a_flicker_moves_nothing() -> None:
    first = np.vstack([QUIET, spinning(3, 5.0), QUIET])
    rows = rows_of(estimate(segment_of(first, 0.01, 0.0, QUIET), gain_stance=0.0))
    assert not rows[:, :6].any()
    assert not rows[:, 10].any()


@pytest.mark.parametrize("gap_s", [0.3, 10.0, 3600.0])
def test_level_after_a_gap_takes_its_whole_window(gap_s: float) -> None:
    """However long the gap was, one sample is no rest."""
    noisy = QUIET.copy()
    noisy[:, :3] += 0.3 * np.random.default_rng(3).standard_normal((100, 3))
    samples = segment_of(QUIET, 0.01, gap_s, noisy)
    tracker = Tracker(Settings(gain_stance=0.0))
    tracker.advance(table_of(samples.matrix[:101]))
    assert not tracker.levelled
    done = estimate(samples, gain_stance=0.0)
    window = noisy[:51, :3]
    assert done.state["gravity"][0] == pytest.approx(np.linalg.norm(window, axis=1).mean())


def test_a_quarter_of_a_second_is_not_yet_a_gap() -> None:
    t_s = np.cumsum(np.full(40, 0.25))
    samples = samples_of(t_s, np.array([0.0, 0.0, -G]), np.zeros(3))
    assert estimate(samples).segments == []
    matrix = samples.matrix.copy()
    matrix[20:, 0] += 1
    assert estimate(replace(samples, matrix=matrix)).segments == [20]


def test_uneven_stamps_are_integrated_as_stamped() -> None:
    """A third of the samples lost at random: the same walk."""
    whole, lost = estimate(foot("rate_hz=400")), estimate(foot("rate_hz=400&lost_fraction=0.3"))
    assert lost.stride_count == whole.stride_count
    assert rows_of(lost)[-1, :2] == pytest.approx(rows_of(whole)[-1, :2], abs=0.15)


def test_one_sample_is_a_walk_of_one_row() -> None:
    tracker = estimate(still(0.01))
    assert rows_of(tracker).shape == (1, ROW_WIDTH)
    assert not tracker.levelled
