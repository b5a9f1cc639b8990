"""The page to hand in: the whole walk's error, every setting with its unit, the seed, and nobody's markup."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest

from app.motion.basics import InputError
from app.motion.snapshot import Snapshot
from app.motion.source import Link
from app.motion.status import Status
from app.session import Session
from app.settings import LIMITS, Settings
from app.shell.hand_in import Seen, made, plots_of
from app.simulate import lab
from app.sources.opening import open_source
from tests.estimator.walks import one_by_one

EVIL = "<img src=x onerror=alert(1)>"


def seen(spec: str, name: str = "Gyro bias") -> Seen:
    """A lesson from its first sample to the last."""
    source = open_source(spec)
    (lesson,) = (one for one in lab.LESSONS if one.name == name)
    spoiling, info = lab.Lab(), source.info
    spoiling.errors = lesson.errors
    session = Session(lesson.settings, truth=info.truth, rod_m=info.rod_m)
    for sample in one_by_one(source.recording.sensors[0]):  # type: ignore[attr-defined]
        session.take(spoiling.spoil(sample) or sample)
        if sample.seq % 100 == 0:
            session.snapshot()
    snapshot = session.snapshot()
    status = Status(info, Link.ENDED, errors=asdict(lesson.errors), lesson=name)
    return Seen(snapshot, status, session.errors_so_far(), source.made_by, dark=False)


@pytest.fixture(scope="module")
def walk() -> Seen:
    return seen("sim:walk?distance_m=30&rate_hz=50&seed=41")


def test_the_error_is_that_of_the_whole_walk(walk: Seen) -> None:
    (table,) = walk.errors.values()
    assert table[0, 0] == 0.0
    assert table[-1, 0] == pytest.approx(walk.snapshot.t_s)
    assert table[0, 1] == pytest.approx(0.0, abs=1e-9)
    way, error = plots_of(walk.snapshot, walk.errors)
    assert [curve.label for curve in way.curves] == ["Foot: estimate", "Foot: truth"]
    estimate, truth = way.curves
    apart = np.hypot(estimate.x[-1] - truth.x[-1], estimate.y[-1] - truth.y[-1])
    assert error.curves[0].y[-1] > 0.3
    assert error.curves[0].y[-1] == pytest.approx(apart, abs=0.25)  # the trails are thinned


def test_it_says_everything_with_its_unit(walk: Seen) -> None:
    name, body = made(walk)
    page = body.decode()
    assert name.startswith("sim-walk-Gyro-bias-")
    assert name.endswith(".html")
    for limit in (*LIMITS.values(), *lab.LIMITS.values()):
        assert limit.label in page
    for told in (lab.LESSONS[1].notice, "0.5 °/s", "1.05 1/s", "41, of the simulator", "seed=41"):
        assert told in page
    assert len(body) < 5_000_000


def test_a_pendulum_has_angles(walk: Seen) -> None:
    swung = seen("sim:pendulum?duration_s=8")
    angle, error = plots_of(swung.snapshot, swung.errors)
    assert angle.y_label == "angle from the vertical, °"
    assert np.ptp(angle.curves[1].y) > 40.0
    assert np.abs(angle.curves[0].y - angle.curves[1].y - error.curves[0].y).max() < 1e-9
    assert "True angle" in made(swung)[1].decode()


def test_nobodys_text_is_markup(walk: Seen) -> None:
    info = replace(walk.status.source, name=EVIL)
    status = replace(walk.status, lesson=EVIL, source=info)
    name, body = made(walk._replace(status=status, made_by=EVIL))
    assert EVIL not in body.decode()
    assert "<" not in name
    assert "/" not in name


def test_before_the_first_sample_there_is_nothing(walk: Seen) -> None:
    nothing: Snapshot = Session(Settings()).snapshot()
    with pytest.raises(InputError, match="no samples yet"):
        made(walk._replace(snapshot=nothing))
