"""Heart: everything that has to be compiled, one by one, so that a start can show it and no sample waits."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from app.blocks import Blocks
from app.estimator import events as e
from app.estimator.compass import FOOTPRINTS, CompassWatch
from app.estimator.methods import METHODS
from app.estimator.smoother import smooth
from app.estimator.strides import Contact, lift_above_line, stride_to
from app.estimator.sweep import sweep
from app.estimator.tracker import Tracker
from app.gestures.default import DefaultDecoder
from app.gestures.words import FootReading
from app.motion.basics import G_MPS2, Role
from app.motion.estimate import ROW_WIDTH
from app.motion.samples import SAMPLE_WIDTH
from app.rotation import conjugate, from_yaw, multiply, rotate, yaw_of
from app.settings import BUILT_IN, Settings
from app.trail import TrailBuilder, coarser


def still_samples(count: int = 8) -> Blocks:
    """A foot at rest, 100 Hz."""
    table = Blocks(SAMPLE_WIDTH)
    rows = np.zeros((count, SAMPLE_WIDTH))
    rows[:, 0] = np.arange(count) * 10_000_000
    rows[:, 3] = -G_MPS2
    table.extend(rows)
    return table


def parts(estimator: str) -> Iterator[tuple[str, Callable[[], None]]]:
    """What is compiled for a walk under ``estimator``, in words, and the call that compiles it.

    The other estimator is compiled when somebody first asks for it, by the worker that re-estimates.
    """
    samples = still_samples()
    rows, event = np.zeros((1, ROW_WIDTH)), np.zeros(e.WIDTH)
    rows[0, 6] = 1.0

    def orientations() -> None:
        yaw_of(from_yaw(0.1))
        rotate((1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
        multiply(conjugate(from_yaw(0.1)), from_yaw(0.1))

    def strides() -> None:
        stride_to(Contact(0.0, (0.0, 0.0, 0.0), 0.0), rows, event, 1, 0.0)
        lift_above_line(rows, event)

    def walk() -> None:
        tracker = Tracker(Settings(estimator=estimator))
        tracker.advance(samples)
        METHODS[estimator].correct(rows, 0, samples.table(0, 1), event, tracker.state)

    def trails() -> None:
        TrailBuilder("warm").add(rows)
        coarser(np.zeros((2, 2, 3), np.float32), 1.0)

    def field() -> None:
        watch = CompassWatch()
        for _ in range(FOOTPRINTS):
            watch.add(samples.table(0, 1), rows)
        _ = watch.view

    def search() -> None:
        sweep(samples, Settings(), np.ones(1), np.ones(1))

    yield "orientations", orientations
    if estimator == "kalman":
        yield "the Kalman filter", walk
    else:
        yield "the papers' estimator", walk
        yield "the look at the magnetic field", field
        yield "the search for gains", search
    yield "strides", strides
    yield "trails", trails


def warm_hindsight() -> None:
    """Compile what only a walk that is over needs."""
    samples = still_samples()
    tracker = Tracker(BUILT_IN["hindsight"])
    tracker.advance(samples)
    smooth(tracker, samples)


def warm_up(estimator: str = "papers", tell: Callable[[str], None] = lambda what: None) -> None:
    """Compile, or load from the cache, what a walk needs; ``tell`` hears what is next."""
    for what, compile_it in parts(estimator):
        tell(what)
        compile_it()


def warm_attitude() -> None:
    """Compile what the papers' decoder needs besides: an orientation."""
    Tracker(Settings()).advance(still_samples())


def warm_gestures() -> None:
    """Compile what two feet in the town need."""
    decoder = DefaultDecoder()
    for k in range(4):
        for foot in (Role.LEFT, Role.RIGHT):
            decoder.take(FootReading(foot, k * 10_000_000, (0.0, 0.0, -9.81), (0.0, 0.0, 0.0)))
    decoder.watch(1_000_000_000)
    yaw_of(from_yaw(0.1))
