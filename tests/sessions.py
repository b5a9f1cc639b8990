"""Walks, and sessions that are given samples and orders."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from app.motion.basics import Floats, Vector
from app.motion.commands import (
    ApplyCandidate,
    Command,
    DropCandidate,
    KeepAs,
    Order,
    ReplaceCandidate,
    RestartHere,
    SetApplyAtOnce,
    SetCandidate,
    SwapAB,
    Undo,
)
from app.motion.samples import Sample
from app.motion.snapshot import Trail
from app.session import Session
from app.settings import Settings
from tests.estimator.walks import PAPERS, foot, one_by_one, rows_of

REST: Vector = (0.0, 0.0, -9.8)
ZERO: Vector = (0.0, 0.0, 0.0)
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


LONG = one_by_one(foot("path=oval&size_m=60&duration_s=1200&rate_hz=50"))


def length_of(trail: Trail) -> float:
    segments = np.concatenate([*(p.segments for p in trail.pieces), trail.growing, trail.provisional])
    return float(np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum())


def sample(ns: int, force: Vector = REST, rate: Vector = ZERO, field: Vector | None = None) -> Sample:
    return Sample("foot", 0, ns, ns, force, rate, field)
