"""Hindsight on a live walk: a halt smooths the whole trail, going on goes on, and nothing else changes."""

from __future__ import annotations

from app.estimator.smoother import finish
from app.motion.basics import Floats
from app.motion.commands import LookBack, Order, SetCandidate
from app.motion.samples import Sample
from app.session import Session
from app.settings import BUILT_IN, Settings
from tests.estimator.walks import estimate, foot, one_by_one, rows_of, table_of

HINDSIGHT = BUILT_IN["hindsight"]
SAMPLES = foot("strides=8&noise=1&rate_hz=100")
WALK = one_by_one(SAMPLES)


def fed(samples: list[Sample], settings: Settings = HINDSIGHT) -> Session:
    session = Session(settings)
    for sample in samples:
        session.take(sample)
    return session


def halt(session: Session) -> None:
    """A halt, and what the shell does then."""
    session.apply(Order(LookBack(), "hindsight", 0))
    while (job := session.applying.wanted) is not None:
        session.applying.adopt(job, job.run())


def rows(session: Session) -> Floats:
    return rows_of(session.main.feet["foot"].tracker)


def test_a_halt_gives_the_smoothed_walk_of_the_batch() -> None:
    session = fed(WALK)
    live = rows_of(estimate(SAMPLES, BUILT_IN["default"]))
    assert rows(session).tobytes() == live.tobytes()
    assert session.snapshot().main.smoothed_s is None
    halt(session)
    whole = estimate(SAMPLES, HINDSIGHT)
    finish(whole, table_of(SAMPLES.matrix))
    assert rows(session).tobytes() == rows_of(whole).tobytes() != live.tobytes()
    seen = session.snapshot()
    assert seen.main.smoothed_s == seen.t_s
    assert seen.undo_depth == 0
    assert seen.changes[-1].what == "smoothed in hindsight"


def test_after_a_halt_the_walk_goes_on_live_and_the_next_one_smooths_it_all() -> None:
    session = fed(WALK[:600])
    halt(session)
    before = rows(session).copy()
    for sample in WALK[600:]:
        session.take(sample)
    live = rows_of(estimate(SAMPLES, BUILT_IN["default"]))
    settled = 500  # a swing under way at the halt is corrected when it ends
    assert rows(session)[:settled].tobytes() == before[:settled].tobytes()
    assert rows(session)[-1].tobytes() == live[-1].tobytes()
    halt(session)
    once = fed(WALK)
    halt(once)
    assert rows(session).tobytes() == rows(once).tobytes()


def test_only_hindsight_looks_back_and_only_once() -> None:
    for settings in (BUILT_IN["default"], Settings(), Settings(hindsight=True)):
        session = fed(WALK[:300], settings)
        halt(session)
        assert session.snapshot().main.smoothed_s is None
    session = fed(WALK[:300])
    halt(session)
    session.apply(Order(LookBack(), "hindsight", 0))
    assert session.applying.wanted is None


def test_a_ghost_stays_through_it() -> None:
    session = fed(WALK[:400])
    session.apply(Order(SetCandidate((("gait_factor", 40.0),)), "me", 0))
    session.apply(Order(LookBack(), "hindsight", 0))
    assert session.applying.settings.gait_factor == 40.0
    while (job := session.applying.wanted) is not None:
        session.applying.adopt(job, job.run())
    assert session.applying.candidate is not None
    assert session.applying.candidate.settings.gait_factor == 40.0
    assert session.main.settings == HINDSIGHT
    assert session.main.smoothed_s is not None
