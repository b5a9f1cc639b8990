"""The truth beside the walk: from where and when the walk began, turned to its heading."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.motion.commands import Order, RestartHere, SetApplyAtOnce, SetCandidate
from app.rotation import pitch_of, yaw_of
from app.session import Session
from app.settings import Settings
from app.simulate.walk import make_walk
from app.truth import KEPT, TrueWalk, pitches
from tests.estimator.walks import one_by_one

OPTIONS = {"path": "square", "size_m": "20", "rate_hz": "100", "distance_m": "40"}


def test_it_is_the_simulators_own_from_the_first_sample_on() -> None:
    made = make_walk(OPTIONS)
    session = Session(Settings(), truth=made.truth)
    for sample in one_by_one(made.recording.sensors[0]):
        session.take(sample)
    session.snapshot()
    (walk,) = session._beside._true.values()
    assert len(walk.recent) == KEPT
    for place in list(walk.recent)[::50]:
        position_n, _ = made.truth("foot", np.array([0.0, place.t_s]))
        assert place.position_n == pytest.approx(position_n[1] - position_n[0], abs=1e-9)
        assert place.t_s == session.stores["foot"].time_ns(place.row) * 1e-9


def test_the_errors_are_distances_and_end_with_the_newest() -> None:
    made = make_walk(OPTIONS)
    session = Session(Settings(), truth=made.truth)
    for sample in one_by_one(made.recording.sensors[0]):
        session.take(sample)
    snapshot = session.snapshot()
    found = snapshot.errors["foot"]
    assert found.shape == (KEPT, 4)
    assert found[-1, 1] == pytest.approx(snapshot.main.feet[0].error_m, rel=1e-14)  # another order of adding
    assert snapshot.t_s - found[-1, 0] < 0.3
    assert snapshot.t_s - found[0, 0] == pytest.approx(10.0, abs=0.5)
    assert found[:, 1].max() < 0.1  # what sampling at 100 Hz costs


def test_a_walk_that_begins_anew_has_a_truth_that_does_too() -> None:
    """After half the square the toe points elsewhere: the new walk starts at 0, heading north."""
    made = make_walk(OPTIONS)
    samples = one_by_one(made.recording.sensors[0])
    session = Session(Settings(), truth=made.truth)
    swings = [s for s in samples if 18.0 < s.device_ns * 1e-9 and np.linalg.norm(s.angular_rate_b) < 0.01]
    begin_ns = swings[10].device_ns  # the foot stands
    for sample in samples:
        if sample.device_ns == begin_ns:
            session.apply(Order(RestartHere(), "test", 0))
        session.take(sample)
    foot = session.snapshot().main.feet[0]
    assert foot.error_m is not None
    assert foot.error_m < 0.1
    (walk,) = session._beside._true.values()
    true = walk.recent[-1].q_nb
    assert math.remainder(yaw_of(true) - yaw_of(foot.q_nb), math.tau) == pytest.approx(0, abs=0.02)


def test_it_is_turned_with_the_start_heading() -> None:
    made = make_walk({"distance_m": "20", "rate_hz": "50"})
    session = Session(Settings(), truth=made.truth)
    for sample in one_by_one(made.recording.sensors[0]):
        session.take(sample)
    walk = TrueWalk("t", made.truth, "foot")
    end = walk.look(session.stores["foot"], Settings(start_heading_rad=math.pi / 2)).position_n
    assert end == pytest.approx([0.0, 20.0, 0.0], abs=0.05)


def test_the_pitch_stands_beside_the_true_one() -> None:
    made = make_walk(OPTIONS)
    session = Session(Settings(), truth=made.truth)
    for sample in one_by_one(made.recording.sensors[0]):
        session.take(sample)
    _, _, pitch, true = session.snapshot().errors["foot"].T
    assert np.ptp(true) > 0.5
    assert pitch == pytest.approx(true, abs=0.02)


def test_pitches_are_those_of_one_after_another() -> None:
    q = np.random.default_rng(0).normal(size=(50, 4))
    q /= np.linalg.norm(q, axis=1)[:, None]
    np.testing.assert_allclose(pitches(q), [pitch_of((w, x, y, z)) for w, x, y, z in q.tolist()], atol=1e-14)


def test_errors_are_those_of_the_track_that_is_applied_now() -> None:
    """Also while no sample comes: a replay stands still while somebody tries settings."""
    made = make_walk(OPTIONS)
    session = Session(Settings(), truth=made.truth)
    for sample in one_by_one(made.recording.sensors[0]):
        session.take(sample)
    before = session.snapshot().errors["foot"]
    for command in (SetApplyAtOnce(True), SetCandidate((("zero_velocity", False),))):
        session.apply(Order(command, "test", 0))
    job = session.applying.wanted
    assert job is not None
    session.applying.adopt(job, job.run())
    after = session.snapshot()
    assert after.errors["foot"][-1, 1] == pytest.approx(after.main.feet[0].error_m, rel=1e-14)
    assert not np.array_equal(after.errors["foot"], before)
