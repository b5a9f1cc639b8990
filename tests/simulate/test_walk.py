"""Whole simulated walks: where they end, when the feet move, and that truth is what the sensors read."""

from __future__ import annotations

import ast
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson
from scipy.spatial.transform import Rotation

import app.simulate.walk
from app.motion.basics import InputError, Role
from app.motion.samples import GAP_NS
from app.simulate.gait import papers_reach
from app.simulate.options import WalkOptions
from app.simulate.walk import SimulatedWalk, make_walk, simulate


def end_of(walk: SimulatedWalk, sensor: str = "foot") -> np.ndarray:
    position, _ = walk.truth(sensor, np.array([walk.recording.duration_s]))
    return position[0]


def test_120_m_are_100_strides_of_the_papers() -> None:
    walk = make_walk({"model": "papers", "distance_m": "120", "rate_hz": "50"})
    assert walk.feet["foot"].strides == 100
    np.testing.assert_allclose(end_of(walk), [120 * papers_reach(), 0.0, 0.0], atol=1e-9)
    assert 120 - end_of(walk)[0] == pytest.approx(0.136, abs=0.001)


@pytest.mark.parametrize("rate_hz", ["20", "37.5", "50", "400"])
def test_the_end_does_not_depend_on_the_rate(rate_hz: str) -> None:
    np.testing.assert_allclose(end_of(make_walk({"rate_hz": rate_hz})), [120.0, 0.0, 0.0], atol=1e-9)


@pytest.mark.parametrize("options", [
    WalkOptions(path="square", rate_hz=1000.0),
    WalkOptions(path="stairs", feet=2, rate_hz=1000.0),
    WalkOptions(model="papers", distance_m=12.0, rate_hz=1000.0),
])  # fmt: skip
def test_truth_is_the_integral_of_what_the_sensors_read(options: WalkOptions) -> None:
    """Turn the readings by the true orientation, add gravity, integrate twice: the true positions.

    Simpson's rule stands in for the estimator; over a smooth walk it needs no help. The papers' foot
    is set to rest in every stance, as its vertical acceleration does not do that itself.
    """
    walk = simulate(options)
    for sensor in walk.recording.sensors:
        t = sensor.matrix[:, 0] * 1e-9
        position, q = walk.truth(sensor.sensor, t)
        force_n = Rotation.from_quat(q[:, [1, 2, 3, 0]]).apply(sensor.matrix[:, 1:4])
        acceleration = force_n + [0.0, 0.0, options.gravity_mps2]
        if options.model == "papers":
            acceleration = acceleration[:, :2]  # forward it sums to zero by itself
        velocity = cumulative_simpson(acceleration, x=t, axis=0, initial=0.0)
        found = cumulative_simpson(velocity, x=t, axis=0, initial=0.0)
        np.testing.assert_allclose(found, position[:, : found.shape[1]], atol=2e-3)


@pytest.mark.parametrize("path", ["oval", "square", "eight"])
@pytest.mark.parametrize("feet", [1, 2])
def test_closed_paths_close(path: str, feet: int) -> None:
    walk = simulate(WalkOptions(path=path, feet=feet))
    for sensor in walk.feet:
        np.testing.assert_allclose(end_of(walk, sensor), 0.0, atol=1e-9)


def test_the_lane_takes_365_strides() -> None:
    assert make_walk({"path": "oval"}).feet["foot"].strides == 365


@pytest.mark.parametrize("model", ["smooth", "papers"])
def test_two_feet_are_half_a_cycle_apart_and_never_fly_together(model: str) -> None:
    walk = make_walk({"feet": "2", "strides": "6", "model": model, "cadence_spm": "100"})
    left, right = walk.feet["left"], walk.feet["right"]
    assert right.timing.heel_off_s - left.timing.heel_off_s == pytest.approx(0.6)
    assert (left.strides, right.strides) == (7, 6)
    t = np.arange(0.0, walk.recording.duration_s, 0.001)
    fast = [np.abs(foot.at(t).velocity_n[:, 0]) > 0.05 for foot in (left, right)]
    assert fast[0].any()
    assert not np.any(fast[0] & fast[1])


def test_two_feet_start_and_end_side_by_side() -> None:
    walk = make_walk({"feet": "2", "strides": "6"})
    for sensor in ("left", "right"):
        np.testing.assert_allclose(end_of(walk, sensor), [7.2, 0.0, 0.0], atol=1e-9)
    lengths = np.linalg.norm(walk.feet["left"].stride_n, axis=1)
    np.testing.assert_allclose(lengths, [0.6, 1.2, 1.2, 1.2, 1.2, 1.2, 0.6])


def test_the_inner_foot_walks_less() -> None:
    walk = simulate(WalkOptions(path="oval", feet=2))  # to the left
    left, right = (np.linalg.norm(walk.feet[s].stride_n, axis=1).sum() for s in ("left", "right"))
    assert right - left == pytest.approx(2 * math.pi * 0.2, rel=0.02)


def test_each_stride_on_the_stairs_takes_two_risers() -> None:
    foot = simulate(WalkOptions(path="stairs")).feet["foot"]
    climbs = -foot.stride_n[:, 2]
    np.testing.assert_allclose(climbs, [0.0] * 4 + [0.34] * 5 + [0.0] * 4 + [0.34] * 5 + [0.0] * 4, atol=1e-9)


def test_the_heading_turns_the_walk_and_the_foot() -> None:
    north, east = make_walk({"strides": "3"}), make_walk({"strides": "3", "heading_deg": "90"})
    np.testing.assert_allclose(end_of(east), end_of(north)[[1, 0, 2]], atol=1e-9)
    _, q = east.truth("foot", np.zeros(1))
    np.testing.assert_allclose(q, [[math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]])


def test_each_foot_starts_at_its_own_origin() -> None:
    walk = make_walk({"path": "eight", "feet": "2", "heading_deg": "30"})
    for sensor in ("left", "right"):
        np.testing.assert_array_equal(walk.truth(sensor, np.zeros(1))[0], 0.0)


@pytest.mark.parametrize("path", ["straight", "square", "eight", "stairs"])
def test_the_smooth_model_fits_common_sensors(path: str) -> None:
    walk = simulate(WalkOptions(path=path, feet=2, rate_hz=400.0))
    for sensor in walk.recording.sensors:
        assert np.linalg.norm(sensor.matrix[:, 1:4], axis=1).max() < 5 * 9.80665
        assert np.linalg.norm(sensor.matrix[:, 4:7], axis=1).max() < 10.0


def test_the_papers_lift_is_past_their_sensors_range() -> None:
    force = simulate(WalkOptions(model="papers")).recording.sensors[0].matrix[:, 1:4]
    assert np.abs(force).max() > 10 * 9.80665


def test_length_by_duration() -> None:
    walk = make_walk({"duration_s": "60", "feet": "2"})
    assert walk.recording.duration_s == pytest.approx(60.0)
    assert walk.feet["right"].strides == 56  # 60 s less 3 s standing and a stride for the other foot
    assert end_of(walk, "left")[0] == pytest.approx(56 * 1.2)


def test_laps_and_rounding() -> None:
    walk = make_walk({"path": "eight", "laps": "2", "stride_m": "1.3"})
    strides = walk.feet["foot"].strides
    assert strides == round(2 * 2 * math.pi * 8.0 / 1.3)
    np.testing.assert_allclose(end_of(walk), 0.0, atol=1e-9)


def test_the_walk_stands_at_both_ends() -> None:
    walk = make_walk({"strides": "2", "still_s": "3", "end_s": "4", "rate_hz": "100"})
    rate = np.abs(walk.recording.sensors[0].matrix[:, 5])
    moving = np.flatnonzero(rate > 0)
    assert moving[0] >= 300
    assert len(rate) - moving[-1] >= 396  # the last corner of the pitch is rounded over 0.04 s


def test_the_recording_is_what_motion_says() -> None:
    walk = make_walk({"feet": "2", "rate_hz": "30", "lost_fraction": "0.3", "noise": "1"})
    assert walk.recording.spec == "sim:walk?feet=2&rate_hz=30&noise=1&lost_fraction=0.3"
    assert [(s.sensor, s.role) for s in walk.recording.sensors] == [
        ("left", Role.LEFT),
        ("right", Role.RIGHT),
    ]
    for sensor in walk.recording.sensors:
        stamps = sensor.matrix[:, 0]
        assert sensor.matrix.shape[1] == 10
        assert np.isfinite(sensor.matrix).all()
        assert sensor.saturation.dtype == np.uint16
        np.testing.assert_array_equal(stamps, np.rint(stamps))
        assert stamps[0] == 0
        assert np.diff(stamps).min() > 0
        assert np.diff(stamps).min() < GAP_NS


@pytest.mark.parametrize(("texts", "says"), [
    ({"duration_s": "3"}, "duration_s=3: expected at least 4"),
    ({"distance_m": "200000", "rate_hz": "2000"}, "at most 20000000 samples"),
])  # fmt: skip
def test_impossible_walks(texts: dict[str, str], says: str) -> None:
    with pytest.raises(InputError, match=says):
        make_walk(texts)


def test_a_sensor_that_does_not_exist() -> None:
    with pytest.raises(ValueError, match="no sensor 'left'.*foot"):
        make_walk({"strides": "1"}).truth("left", np.zeros(1))


def test_the_oracle_shares_no_code_with_what_it_judges() -> None:
    folder = Path(app.simulate.walk.__file__).parent
    imported = {
        node.module
        for path in folder.glob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("app.")
    }
    assert imported
    # the lab's lessons name settings; a record of numbers is no oracle
    others = {".".join(name.split(".")[:2]) for name in imported if not name.startswith("app.simulate.")}
    assert others == {"app.limits", "app.motion", "app.settings"}
