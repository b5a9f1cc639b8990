"""Before the walk: a calibration is made, kept, applied, undone; a pre-flight ends as a mark."""

from __future__ import annotations

import asyncio
import threading
from pathlib import Path

import numpy as np
import pytest

from app.calibration.guide import Guide
from app.calibration.words import Calibration, Correction
from app.home import calibrations
from app.motion.basics import InputError, Role
from app.motion.commands import Calibrate, CheckFirst
from app.motion.samples import Sample
from app.motion.source import Link, SourceInfo
from app.motion.status import Status
from app.session import Session
from app.settings import Settings
from app.shell.before import Before
from app.simulate.calibration import make_calibration
from app.sources.timeline import Timeline

LIVE = SourceInfo("serial:/dev/ttyUSB0", "GX1", {"foot": Role.FOOT}, serials={"foot": "1234"})
FLAT = Sample("foot", 0, 0, 0, (0.5, 0.0, -9.8), (0.01, 0.0, 0.0), (20.0, 0.0, 40.0))


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calibrations, "folder", lambda: tmp_path / "calibrations")


def before(info: SourceInfo = LIVE, marks: list[str] | None = None) -> Before:
    return Before(lambda: info, (marks if marks is not None else []).append)


def test_a_sensor_without_a_calibration_is_left_as_it_is() -> None:
    assert before().sample(FLAT) is FLAT
    assert not before().wants_each


def test_a_kept_calibration_is_applied_by_serial_number_and_undone_by_one_order() -> None:
    calibrations.save(Calibration("1234", "2026-11-22", "fit", Correction((0.5, 0.0, 0.0))))
    now = before()
    assert now.sample(FLAT).specific_force_b == (0.0, 0.0, -9.8)
    session = Session(Settings())
    shown = now.look(session.snapshot(), Status(LIVE, Link.LIVE)).calibration
    assert shown is not None
    assert shown.applied == {"foot": "2026-11-22"}
    assert "undone" in now.calibrate(Calibrate("undo", "foot"))
    assert now.sample(FLAT).specific_force_b[0] == 0.5
    assert before().sample(FLAT).specific_force_b[0] == 0.5
    now.calibrate(Calibrate("redo"))
    assert now.sample(FLAT).specific_force_b[0] == 0.0


def test_a_recording_is_never_corrected() -> None:
    calibrations.save(Calibration("walk.mcap foot", "2026-11-22", "fit", Correction((0.5, 0.0, 0.0))))
    recorded = before(SourceInfo("walk.mcap", "Stridescope recording", duration_s=10.0))
    assert recorded.sample(FLAT) is FLAT
    with pytest.raises(InputError, match="cannot be calibrated"):
        recorded.calibrate(Calibrate("start"))


def test_a_damaged_file_is_told_and_the_walk_goes_on() -> None:
    path = calibrations.path_of("1234")
    path.parent.mkdir(parents=True)
    path.write_text("{")
    now = before()
    assert now.sample(FLAT) is FLAT
    shown = now.look(Session(Settings()).snapshot(), Status(LIVE, Link.LIVE)).calibration
    assert shown is not None
    assert "not JSON" in shown.damaged


def follow(now: Before, timeline: Timeline) -> None:
    """Be led through a calibration to its last sample."""
    samples = timeline.cut(0, len(timeline), 0)
    now.sample(samples[0])
    now.calibrate(Calibrate("start", "foot"))
    for sample in samples[1:]:
        now.sample(sample)


def test_a_guided_calibration_is_found_saved_and_used() -> None:
    true = make_calibration({"seed": "2"})
    timeline = Timeline(true.recording)
    now = before()

    async def lead() -> None:
        follow(now, timeline)
        while not now.look(Session(Settings()).snapshot(), Status(LIVE, Link.LIVE)).calibration.found:  # type: ignore[union-attr]
            await asyncio.sleep(0.05)

    with pytest.raises(InputError, match="no sample yet"):
        now.calibrate(Calibrate("start"))
    asyncio.run(asyncio.wait_for(lead(), 60.0))
    assert "saved and applied" in now.calibrate(Calibrate("save"))
    kept = calibrations.load("1234")
    assert kept is not None
    np.testing.assert_allclose(kept.force.null, true.force.null, atol=0.005)
    read = tuple(true.force.read(np.array([[0.0, 0.0, -9.80665]]))[0].tolist())
    corrected = now.sample(FLAT._replace(specific_force_b=read)).specific_force_b
    np.testing.assert_allclose(corrected, [0.0, 0.0, -9.80665], atol=0.02)
    with pytest.raises(InputError, match="no calibration to save"):
        now.calibrate(Calibrate("save"))


def test_a_calibration_can_be_given_up() -> None:
    now = before()
    now.sample(FLAT)
    now.calibrate(Calibrate("start"))
    assert now.wants_each
    now.calibrate(Calibrate("cancel"))
    assert not now.wants_each


def test_the_preflight_ends_as_a_mark() -> None:
    marks: list[str] = []
    now = before(marks=marks)
    with pytest.raises(InputError, match="no sample yet"):
        now.check(CheckFirst("start"), {})
    now.check(CheckFirst("start"), {"foot": Role.FOOT})
    session = Session(Settings())
    for i in range(600):
        sample = now.sample(FLAT._replace(device_ns=i * 10_000_000, host_ns=i * 10_000_000, seq=i))
        session.take(sample)
    status = Status(LIVE, Link.LIVE)
    for _ in range(2):
        shown = now.look(session.snapshot(), status).preflight
        assert shown is not None
        now.check(CheckFirst("skip"), {})
        now._next_s = 0.0
    shown = now.look(session.snapshot(), status).preflight
    assert shown is not None
    assert shown.done
    assert [mark.split(":")[0] for mark in marks] == ["pre-flight with remarks"]
    assert "still good" in marks[0]
    assert "loop bad (skipped)" in marks[0]


def test_a_calibration_given_up_while_it_is_worked_out_leaves_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    timeline = Timeline(make_calibration({"seed": "2"}).recording)
    go_on, results = threading.Event(), Guide.results

    def slowly(guide: Guide, made: str) -> tuple[Calibration, Calibration]:
        go_on.wait(60.0)
        return results(guide, made)

    monkeypatch.setattr(Guide, "results", slowly)
    now = before()

    async def lead() -> None:
        follow(now, timeline)
        await asyncio.sleep(0.1)
        now.calibrate(Calibrate("cancel"))
        go_on.set()
        assert now._fitting is not None
        await now._fitting

    asyncio.run(asyncio.wait_for(lead(), 60.0))
    with pytest.raises(InputError, match="no calibration to save"):
        now.calibrate(Calibrate("save"))
