"""Calibrations on disk: by sensor, undone by one move, redone by another."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.calibration.words import Calibration, Correction
from app.home import calibrations
from app.motion.basics import InputError
from app.motion.samples import Sample
from app.motion.source import SourceInfo

KEY = "serial:/dev/ttyUSB0 left"


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calibrations, "folder", lambda: tmp_path / "config" / "calibrations")


def kept(method: str = "fit") -> Calibration:
    return Calibration(KEY, "2026-11-22", method)


def test_none_is_none_and_what_was_saved_is_loaded() -> None:
    assert calibrations.load(KEY) is None
    calibrations.save(kept())
    assert calibrations.load(KEY) == kept()
    assert calibrations.load(f"{KEY}2") is None


def test_it_is_undone_and_redone() -> None:
    assert not calibrations.undo(KEY)
    calibrations.save(kept())
    assert calibrations.undo(KEY)
    assert calibrations.load(KEY) is None
    assert calibrations.was_undone(KEY)
    assert calibrations.redo(KEY)
    assert calibrations.load(KEY) == kept()
    assert not calibrations.was_undone(KEY)


def test_the_one_before_stays_beside_the_new() -> None:
    calibrations.save(kept("report"))
    path = calibrations.save(kept())
    assert '"report"' in path.with_suffix(".before").read_text("utf-8")


def test_names_that_look_alike_have_files_of_their_own() -> None:
    assert calibrations.path_of("a/b") != calibrations.path_of("a:b")
    assert calibrations.path_of("../../etc/x").parent == calibrations.folder()


def test_a_damaged_or_foreign_file_is_one_line() -> None:
    path = calibrations.save(kept())
    path.write_text("{")
    with pytest.raises(InputError, match="not JSON"):
        calibrations.load(KEY)
    calibrations.path_of("other").write_text(path.with_suffix(".json").read_text() or "{")
    calibrations.save(kept())
    calibrations.path_of("other").write_bytes(path.read_bytes())
    with pytest.raises(InputError, match="expected 'other'"):
        calibrations.load("other")


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "config").write_text("a file")
    with pytest.raises(InputError, match="cannot be saved"):
        calibrations.save(kept())


def test_serial_numbers_go_before_names() -> None:
    info = SourceInfo("serial:/dev/ttyUSB0", "GX1", serials={"left": "1234"})
    assert calibrations.key_of(info, "left") == "1234"
    assert calibrations.key_of(info, "right") == "serial:/dev/ttyUSB0 right"
    both = replace(
        info, name="serial:/dev/ttyUSB0, serial:/dev/ttyUSB1", places={"right": "serial:/dev/ttyUSB1"}
    )
    assert calibrations.key_of(both, "right") == "serial:/dev/ttyUSB1 right"


def test_recordings_are_left_as_they_were_recorded() -> None:
    assert calibrations.meant_for(SourceInfo("serial:x", "GX1"))
    assert calibrations.meant_for(SourceInfo("sim:walk", "simulator", duration_s=3.0))
    assert not calibrations.meant_for(SourceInfo("walk.mcap", "Stridescope recording", duration_s=3.0))


def test_a_source_s_samples_are_corrected_from_the_first_on() -> None:
    info = SourceInfo("serial:/dev/ttyUSB0", "GX1")
    sample = Sample("left", 0, 0, 0, (0.5, 0.0, -9.8), (0.0, 0.0, 0.0))
    calibrations.save(Calibration(KEY, "2026-11-22", "fit", Correction((0.5, 0.0, 0.0))))
    corrections = calibrations.Corrections(lambda: info)
    assert corrections.apply(sample).specific_force_b == (0.0, 0.0, -9.8)
    other = sample._replace(sensor="right")
    assert corrections.apply(other) is other
