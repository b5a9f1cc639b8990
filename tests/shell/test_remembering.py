"""Gyro biases from one walk to the next: kept by serial number, told before the first sample, in the log."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.applying import Asked
from app.home import biases, calibrations
from app.motion.basics import Role
from app.motion.commands import KnowBias, Order
from app.motion.recording import Journal, Recording
from app.motion.source import SourceInfo
from app.session import Session
from app.settings import Settings
from app.shell import batch
from app.shell.remembering import Remembering, found_when
from tests.estimator.walks import foot, one_by_one, rows_of

KALMAN = Settings(estimator="kalman")
LIVE = SourceInfo("serial:/dev/ttyUSB0", "GX1", {"foot": Role.FOOT}, serials={"foot": "1234"})
SAMPLES = one_by_one(foot("strides=3&rate_hz=100&noise=1"))


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calibrations, "folder", lambda: tmp_path / "calibrations")


def walked(remembering: Remembering) -> Session:
    session = Session(KALMAN)
    for sample in SAMPLES:
        if (order := remembering.order(sample.sensor)) is not None:
            session.apply(order)
        session.take(sample)
    return session


def live(calibrated: str = "", info: SourceInfo = LIVE) -> Remembering:
    return Remembering(lambda: info, lambda _: calibrated)


def test_a_walk_is_remembered_by_the_next_of_the_same_sensor_and_calibration() -> None:
    first = live()
    session = walked(first)
    assert not session.biases
    first.keep(session)
    again = walked(live())
    assert set(again.biases) == {"foot"}
    assert "gyro bias remembered" in again.applying.changes[0].what
    assert not walked(live(calibrated="2026-11-01")).biases
    assert not walked(live(info=SourceInfo("serial:/dev/ttyUSB0", "GX1", serials={"foot": "99"}))).biases


def test_it_says_when_and_how_warm_the_sensor_was() -> None:
    warm = replace(LIVE, temperatures={"foot": 24.3})
    live(info=warm).keep(walked(live(info=warm)))
    kept = biases.load("1234")
    assert kept is not None
    assert kept.temperature_c == 24.3
    assert found_when(kept._replace(made="2026-11-03T10:00:00+0000")) == "from 3 Nov 2026 at 24 °C"
    assert found_when(kept._replace(made="2026-11-03", temperature_c=None)) == "from 3 Nov 2026"
    assert found_when(kept._replace(made="long ago", temperature_c=None)) == "from long ago"
    snapshot = walked(live()).snapshot()
    assert snapshot.remembered["foot"].endswith(" at 24 °C")
    assert not walked(live(info=replace(LIVE, serials={"foot": "99"}))).snapshot().remembered


def test_a_recording_neither_teaches_nor_is_told() -> None:
    live().keep(walked(live()))
    recorded = live(info=SourceInfo("walk.mcap", "x", serials={"foot": "1234"}, duration_s=9.0))
    assert recorded.order("foot") is None
    biases.path_of("1234").unlink()
    recorded.keep(walked(recorded))
    assert biases.load("1234") is None


def test_the_log_repeats_it_to_the_bit_also_through_a_re_estimation_and_a_restart() -> None:
    live().keep(walked(live()))
    session = walked(live())
    told = [order for _, order in session.log if isinstance(order.command, KnowBias)]
    assert len(told) == 1
    fresh = Session(KALMAN)
    fresh.apply(told[0])
    for sample in SAMPLES:
        fresh.take(sample)
    rows = rows_of(session.main.feet["foot"].tracker)
    assert rows.tobytes() == rows_of(fresh.main.feet["foot"].tracker).tobytes()
    asked = Asked(0, Order(told[0].command, "me", 0))
    job = session.applying._fresh(session.applying._job(asked, KALMAN, False, "again"))
    assert rows.tobytes() == rows_of(job.run().feet["foot"].tracker).tobytes()
    without = Session(KALMAN)
    for sample in SAMPLES:
        without.take(sample)
    assert not np.array_equal(rows, rows_of(without.main.feet["foot"].tracker))


def test_a_damaged_file_is_left_and_the_walk_goes_on() -> None:
    path = biases.path_of("1234")
    path.parent.mkdir(parents=True)
    path.write_text("{")
    assert not walked(live()).biases


def test_a_batch_of_a_recorded_walk_begins_with_its_bias() -> None:
    samples = foot("strides=3&rate_hz=100&noise=1")
    known = KnowBias("foot", (0.002, -0.001, 0.003), (5e-4, 5e-4, 5e-4), "found today")
    count = len(samples)
    rows = (np.zeros(count, np.int64), samples.matrix[:, 0].astype(np.int64))
    journal = Journal(KALMAN, KALMAN, False, *rows, orders=((0, Order(known, "remembered", 0)),))
    recording = Recording("walk.mcap", "Stridescope recording", (samples,), journal=journal)
    session = Session(KALMAN)
    session.apply(Order(known, "remembered", 0))
    for sample in SAMPLES:
        session.take(sample)
    told = rows_of(batch.estimate(recording, KALMAN).trackers["foot"]).tobytes()
    assert told == rows_of(session.main.feet["foot"].tracker).tobytes()
    plain = replace(recording, journal=None)
    assert told != rows_of(batch.estimate(plain, KALMAN).trackers["foot"]).tobytes()
