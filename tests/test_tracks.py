"""What a track tells of a foot."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.basics import Role, Vector
from app.settings import Settings
from app.stores import SensorStore
from app.tracks import Track
from tests.estimator.walks import foot, one_by_one, rows_of
from tests.sessions import sample

extreme = st.floats(allow_nan=True, allow_infinity=True)


vectors = st.tuples(extreme, extreme, extreme)


@given(st.lists(st.tuples(vectors, vectors, vectors), max_size=30), st.booleans())
def test_no_sample_makes_a_row_that_is_not_finite(
    readings: list[tuple[Vector, Vector, Vector]], compass: bool
) -> None:
    store = SensorStore("foot", Role.FOOT)
    track = Track("t", Settings(magnetometer=compass, still_window_s=0.05, gain_swing=1.0))
    for i, values in enumerate(readings):
        if store.take(sample(i * 20_000_000, *values)):
            track.advance("foot", store.samples)
    for foot_track in track.feet.values():
        rows = rows_of(foot_track.tracker)
        assert all(math.isfinite(x) for x in rows.ravel())


def test_a_view_tells_the_last_stride_and_standing() -> None:
    samples = foot("strides=10&rate_hz=100&end_s=4")
    store, track = SensorStore("foot", Role.FOOT), Track("t", Settings())
    for taken in one_by_one(samples):
        store.take(taken)
        track.advance("foot", store.samples)
        if store.samples.end == 900:
            walking = track.view({"foot": store}, {}).feet[0]
    assert walking.speed_mps == pytest.approx(1.2, abs=0.05)
    assert walking.cadence_spm == pytest.approx(120.0, abs=3.0)
    assert walking.error_m is None
    standing = track.view({"foot": store}, {}).feet[0]
    assert (standing.speed_mps, standing.cadence_spm) == (0.0, 0.0)
    assert standing.strides == 10
    assert standing.to_start_m == pytest.approx(12.0, abs=0.1)
    assert len(standing.footprints) == 10
    assert standing.footprints[-1].position_n == pytest.approx(standing.position_n, abs=1e-9)


def test_the_newest_stride_is_provisional_until_its_update() -> None:
    samples = foot("strides=4&rate_hz=100")
    store, track = SensorStore("foot", Role.FOOT), Track("t", Settings())
    for i, taken in enumerate(one_by_one(samples)):
        store.take(taken)
        track.advance("foot", store.samples)
        view = track.view({"foot": store}, {}).feet[0]
        tracker = track.feet["foot"].tracker
        assert bool(len(view.trail.provisional)) == (tracker.settled_end < tracker.rows.end)
        if i == 300:
            break


def test_the_trail_breaks_at_a_gap_only_if_the_foot_jumped() -> None:
    """It never does: position is kept across a gap, and no line joins the two sides."""
    store, track = SensorStore("foot", Role.FOOT), Track("t", Settings())
    for taken in one_by_one(foot("strides=10&rate_hz=100")):
        if not 4.6e9 < taken.device_ns < 6e9:
            store.take(taken)
            track.advance("foot", store.samples)
    view = track.view({"foot": store}, {}).feet[0]
    assert len(track.feet["foot"].tracker.segments) == 1
    rows = rows_of(track.feet["foot"].tracker)[:, :3]
    middles = view.trail.growing.mean(axis=1)
    assert max(np.linalg.norm(rows - middle, axis=1).min() for middle in middles) < 0.05
