"""The walk by a sensor's own orientation, told by a simulator: it is the truth, so the walk must be, too."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.motion.commands import Order, ResetHeading, RestartHere
from app.motion.samples import Sample
from app.rotation import from_yaw, multiply
from app.session import Session
from app.settings import Settings
from app.simulate.walk import SimulatedWalk, make_walk
from app.sources.timeline import Timeline

WALK = {"path": "oval", "distance_m": "12", "rate_hz": "100", "still_s": "2"}


@pytest.fixture(scope="module")
def walk() -> SimulatedWalk:
    return make_walk(WALK)


def samples(walk: SimulatedWalk, yaw_rad: float = 0.0) -> list[Sample]:
    """With the true orientation, as a sensor tells it whose north is ``yaw_rad`` elsewhere."""
    timeline = Timeline(walk.recording)
    t_s = np.array([timeline.elapsed_ns(i) * 1e-9 for i in range(len(timeline))])
    _, q_nb = walk.truth("foot", t_s)
    turn = from_yaw(yaw_rad)
    return [
        sample._replace(device_q_nb=multiply(turn, (w, x, y, z)))
        for sample, (w, x, y, z) in zip(timeline.cut(0, len(timeline), 0), q_nb.tolist(), strict=True)
    ]


def taken(session: Session, walk: list[Sample]) -> Session:
    for sample in walk:
        session.take(sample)
    return session


@pytest.mark.parametrize("yaw_rad", [0.0, 2.0])
def test_a_true_orientation_gives_the_true_walk(walk: SimulatedWalk, yaw_rad: float) -> None:
    session = taken(Session(Settings()), samples(walk, yaw_rad))
    own = session.snapshot().own["foot"]
    t_s = np.array([0.0, session.stores["foot"].elapsed_s])
    position_n, _ = walk.truth("foot", t_s)
    from_start = math.dist(own.position_n[:2], position_n[1, :2] - position_n[0, :2])
    assert from_start < 0.02 * own.distance_m
    assert abs(own.position_n[2]) < 0.02  # a swing that is told late would sink by a hand's breadth
    assert own.distance_m == pytest.approx(12.0, rel=0.05)
    assert own.tilt_rad < math.radians(3)
    assert abs(own.heading_rad) < math.radians(5)
    assert own.trail.pieces or len(own.trail.growing)


def test_a_walk_that_is_turned_takes_it_along(walk: SimulatedWalk) -> None:
    session = taken(Session(Settings()), samples(walk)[:900])
    before = session.snapshot().own["foot"]
    session.apply(Order(ResetHeading(), "somebody", 0))
    job = session.applying.wanted
    assert job is not None
    session.applying.adopt(job, job.run())
    after = session.snapshot().own["foot"]
    assert math.hypot(*after.position_n[:2]) == pytest.approx(math.hypot(*before.position_n[:2]))
    assert after.heading_rad == pytest.approx(before.heading_rad, abs=1e-6)
    assert after.position_n[:2] != pytest.approx(before.position_n[:2])


def test_nothing_is_integrated_over_a_gap(walk: SimulatedWalk) -> None:
    every = samples(walk)
    hole = slice(600, 700)  # a second
    session = taken(Session(Settings()), every[: hole.start])
    before = session.snapshot().own["foot"].position_n
    session.take(every[hole.stop])
    assert session.snapshot().own["foot"].position_n == before


def test_a_restart_begins_it_anew_and_without_orientation_there_is_none(walk: SimulatedWalk) -> None:
    every = samples(walk)
    session = taken(Session(Settings()), every[:700])
    assert "foot" in session.snapshot().own
    session.apply(Order(RestartHere(), "somebody", 0))
    assert session.snapshot().own == {}
    plain = taken(Session(Settings()), [sample._replace(device_q_nb=None) for sample in every[:500]])
    assert plain.snapshot().own == {}


def test_behind_a_seek_it_begins_where_ours_is(walk: SimulatedWalk) -> None:
    every = samples(walk)
    session = taken(Session(Settings()), [sample._replace(device_q_nb=None) for sample in every[:800]])
    for sample in every[800:]:
        session.take(sample)
    snapshot = session.snapshot()
    ours, own = snapshot.main.feet[0], snapshot.own["foot"]
    assert math.dist(own.position_n, ours.position_n) < 0.2
    assert ours.distance_m > 2.0 * own.distance_m > 1.0
