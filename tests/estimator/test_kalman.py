"""The Kalman filter's laws: closed forms, rest, gaps, clipping, and live is batch."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.estimator.kalman import half_turn_between
from app.estimator.tracker import Tracker
from app.motion.samples import SAMPLE_WIDTH, Samples
from app.rotation import from_yaw_pitch_roll, rotate
from app.settings import Settings
from tests.estimator.walks import G, estimate, foot, rows_of, samples_of, still, table_of, walk, without

KALMAN = Settings(estimator="kalman")
NOISY = "strides=12&noise=1&seed=3"


def true_positions(query: str, samples: Samples) -> np.ndarray:
    return walk(query).truth(samples.sensor, samples.matrix[:, 0] * 1e-9)[0]


def test_a_foot_at_rest_stays_at_rest() -> None:
    tracker = estimate(still(60.0), KALMAN)
    rows = rows_of(tracker)
    assert np.abs(rows[:, :6]).max() < 1e-9
    assert not rows[:, 10].any()
    assert tracker.stride_count == 0


@pytest.mark.parametrize("pose", [(0.0, 0.4, 0.2), (0.0, 0.0, np.pi), (0.0, -np.pi / 2, 0.0)])
def test_any_mounting_is_levelled(pose: tuple[float, float, float]) -> None:
    q = from_yaw_pitch_roll(*pose)
    force_b = np.array(rotate((q[0], -q[1], -q[2], -q[3]), (0.0, 0.0, -9.6)))
    t_s = np.arange(300) / 100
    rows = rows_of(estimate(samples_of(t_s, force_b, np.zeros(3)), KALMAN))
    assert rotate(tuple(rows[-1, 6:10].tolist()), tuple(force_b.tolist())) == pytest.approx(
        (0.0, 0.0, -9.6), abs=1e-6
    )
    assert np.abs(rows[:, :3]).max() < 1e-6


@pytest.mark.parametrize("rate_hz", [100, 200, 400])
def test_a_simulated_walk_ends_where_it_ends(rate_hz: int) -> None:
    query = f"strides=20&rate_hz={rate_hz}"
    samples = foot(query)
    tracker = estimate(samples, KALMAN.with_changes({"sensor_height_m": 0.0}))
    away_m = rows_of(tracker)[-1, :3] - true_positions(query, samples)[-1]
    assert tracker.stride_count == 20
    assert np.linalg.norm(away_m) < 0.01 * tracker.distance_m


def test_live_is_batch_to_the_bit() -> None:
    samples = foot(NOISY)
    batch = estimate(samples, KALMAN)
    table, live = table_of(np.empty((0, SAMPLE_WIDTH))), Tracker(KALMAN)
    rng, begin = np.random.default_rng(1), 0
    while begin < len(samples):
        end = min(len(samples), begin + int(rng.integers(1, 40)))
        table.extend(samples.matrix[begin:end])
        live.advance(table)
        begin = end
    assert np.array_equal(rows_of(live), rows_of(batch))
    assert live.strides == batch.strides


def test_nothing_before_the_settled_end_changes() -> None:
    samples = foot(NOISY)
    whole = rows_of(estimate(samples, KALMAN))
    for end in range(150, len(samples), 37):
        tracker = Tracker(KALMAN)
        tracker.advance(table_of(samples.matrix[:end]))
        settled = tracker.settled_end
        assert np.array_equal(rows_of(tracker)[:settled], whole[:settled])


def test_covariance_stays_symmetric_and_positive() -> None:
    tracker = estimate(foot(NOISY), KALMAN)
    P = tracker.state["P"][0]
    known = np.diag(P) > 0.0  # the floor it began on has no error, by definition
    P = P[known][:, known]
    assert np.allclose(P, P.T, rtol=1e-9, atol=1e-15)
    scale = np.sqrt(np.diag(P))
    assert np.linalg.eigvalsh(P / np.outer(scale, scale)).min() > -1e-9


def test_a_gap_begins_a_segment_and_integrates_nothing() -> None:
    samples = foot("strides=12")
    t_s = samples.matrix[:, 0] * 1e-9
    middle = float(t_s[len(t_s) // 2])
    tracker = estimate(without(samples, middle, middle + 3.0), KALMAN)
    rows = rows_of(tracker)
    (row,) = tracker.segments
    assert np.array_equal(rows[row, :3], rows[row - 1, :3])
    assert np.isfinite(rows).all()
    assert np.abs(np.diff(rows[:, :3], axis=0)).max() < 0.1


def test_the_rows_of_a_finished_swing_join_both_stances() -> None:
    rows = rows_of(estimate(foot("strides=12&noise=1&seed=3&rate_hz=200"), KALMAN))
    assert np.abs(np.diff(rows[:, :3], axis=0)).max() < 0.06  # 200 Hz: no faster than 12 m/s, and no jump


def test_gyro_bias_of_a_still_start_is_found_and_swaying_is_not_taken_for_it() -> None:
    t_s = np.arange(800) / 100
    bias = np.array([0.004, -0.003, 0.002])
    noise = np.random.default_rng(0).standard_normal((800, 3))
    quiet = samples_of(t_s, np.array([0.0, 0.0, -G]) + 0.01 * noise, bias + 0.002 * noise)
    found = estimate(quiet, KALMAN).state["gyro_bias"][0]
    assert found == pytest.approx(bias, abs=5e-4)
    sway = 0.03 * np.sin(2 * np.pi * 0.3 * t_s)[:, None] * np.array([0.0, 1.0, 0.0])
    swaying = samples_of(t_s, np.array([0.0, 0.0, -G]), sway)
    assert abs(estimate(swaying, KALMAN).state["gyro_bias"][0][1]) < 0.006


def test_bias_of_a_noisy_still_start_is_about_the_mean_of_it() -> None:
    t_s, sigma = np.arange(800) / 200, 0.0076
    errors: list[np.ndarray] = []
    for seed in range(20):
        rate = sigma * np.random.default_rng(seed).standard_normal((800, 3))
        state = estimate(samples_of(t_s, np.array([0.0, 0.0, -G]), rate + 0.005), KALMAN).state
        errors.append(state["gyro_bias"][0] - 0.005)
    assert np.sqrt(np.mean(np.square(errors))) < 1.5 * sigma / 800**0.5


def test_a_loud_stance_is_found_where_the_foot_has_no_speed() -> None:
    samples = foot("strides=20&rate_hz=200")
    t_s = samples.matrix[:, 0] * 1e-9
    shaken = samples.matrix.copy()
    hum = np.where((t_s > 10.0) & (t_s < 11.0), 1.0, 0.0)  # over the threshold, its mean is nothing
    shaken[:, 6] += 2.6 * hum * (-1.0) ** np.arange(len(t_s))
    loud = Samples("foot", samples.role, 0, shaken, samples.saturation)
    assert estimate(loud, KALMAN).stride_count == 20


def test_a_gyro_that_ends_at_300_degrees_is_known_by_its_flat_tops() -> None:
    """What it lost in a swing is no bias: that grew to 0.06 rad/s, and the walk went 50 m astray."""
    query = "rate_hz=50&strides=40&path=oval&cadence=115&lift_m=0.22&stride_m=1.35"
    clipped, whole = foot(f"{query}&gyro_range_dps=300"), foot(query)
    assert np.abs(whole.matrix[:, 4:7]).max() > 1.3 * np.abs(clipped.matrix[:, 4:7]).max()
    found = estimate(clipped, KALMAN)
    assert np.abs(found.state["gyro_bias"]).max() < 1e-3
    away = rows_of(found)[:, :2] - rows_of(estimate(whole, KALMAN))[:, :2]
    assert np.hypot(*away.T).max() < 3.0
    assert found.state["flat_radps"][0] == pytest.approx(np.radians(300.0))
    assert estimate(whole, KALMAN).state["flat_radps"][0] == 0.0


def test_a_clipped_gyro_is_doubted_about_its_own_axis_and_mended() -> None:
    t_s = np.arange(400) / 200
    swing = np.where((t_s > 1.0) & (t_s < 1.2), 12.0 * np.sin(np.pi * (t_s - 1.0) / 0.2), 0.0)
    true_turn = np.trapezoid(swing, t_s)
    rate = np.zeros((400, 3))
    rate[:, 2] = np.minimum(swing, 8.727)  # about the vertical, so that gravity says nothing
    clipped = estimate(samples_of(t_s, np.array([0.0, 0.0, -G]), rate), KALMAN)
    q = rows_of(clipped)[-1, 6:10]
    yaw = 2.0 * np.arctan2(q[3], q[0])
    lost = true_turn - np.trapezoid(rate[:, 2], t_s)
    assert lost > 0.2
    assert abs(true_turn - yaw) < 0.5 * lost
    P = clipped.state["P"][0]
    assert P[8, 8] > max(100 * P[7, 7], 0.05**2)


def test_the_turn_of_a_rate_that_changes_evenly_minds_its_axis() -> None:
    before, after, dt_s = np.array([8.0, 0.0, 1.0]), np.array([1.0, 9.0, -1.0]), 0.01
    half = half_turn_between((8.0, 0.0, 1.0), (1.0, 9.0, -1.0), dt_s)
    true = Rotation.identity()
    for u in (np.arange(200) + 0.5) / 200:
        true = true * Rotation.from_rotvec((before + u * (after - before)) * dt_s / 200)
    off = (Rotation.from_rotvec(0.5 * dt_s * (before + after)).inv() * true).magnitude()
    assert (Rotation.from_rotvec(2.0 * np.array(half)).inv() * true).magnitude() < 0.02 * off


def test_two_starts_in_mid_walk_still_find_level() -> None:
    samples = foot("strides=12&rate_hz=200")
    cut = samples.matrix[600:].copy()
    cut[:, 0] -= cut[0, 0]
    tracker = estimate(Samples("foot", samples.role, 0, cut, samples.saturation[600:]), KALMAN)
    assert tracker.levelled
    assert tracker.stride_count >= 7
    assert np.abs(rows_of(tracker)[:, 2]).max() < 0.5


@pytest.mark.parametrize("detector", ["adaptive", "shoe", "ared", "rate"])
def test_every_detector_finds_every_stride(detector: str) -> None:
    tracker = estimate(foot("strides=20&rate_hz=200"), KALMAN, detector=detector)
    assert tracker.stride_count == 20


def test_another_estimators_walk_is_taken_up_where_the_foot_was() -> None:
    samples = foot("strides=12")
    papers = estimate(samples, Settings())
    taken = Tracker(KALMAN, 0, papers.checkpoints[0]._replace(state=papers.state))
    assert taken.state["px"][0] == pytest.approx(papers.state["px"][0] + papers.state["sx"][0])
    back = Tracker(Settings(), 0, papers.checkpoints[0]._replace(state=taken.state))
    assert back.state["px"][0] == pytest.approx(taken.state["px"][0])


def test_start_heading_turns_everything() -> None:
    samples = foot("strides=6")
    plain, turned = (rows_of(estimate(samples, KALMAN, start_heading_rad=angle)) for angle in (0.0, 1.0))
    c, s = np.cos(1.0), np.sin(1.0)
    assert turned[:, :2] == pytest.approx(plain[:, :2] @ np.array([[c, s], [-s, c]]), abs=1e-6)
    assert turned[:, 2] == pytest.approx(plain[:, 2], abs=1e-6)


def test_the_first_swing_after_a_gap_begins_after_it() -> None:
    samples = foot("strides=12")
    t_s = samples.matrix[:, 0] * 1e-9
    swing_s = estimate(samples, KALMAN).strides[5].swing_s
    for begin_s in np.arange(6.0, 7.0, 0.1):
        gone = without(samples, begin_s, begin_s + 1.2)
        tracker = estimate(gone, KALMAN)
        (row,) = tracker.segments
        first = next(s for s in tracker.strides if s.end_s > begin_s + 1.2)
        assert first.start_s > gone.matrix[row, 0] * 1e-9 - 1e-9
        assert first.swing_s < 1.2 * swing_s
        assert first.start_s < t_s[-1]
