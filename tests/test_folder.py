"""A folder of recordings: each as if it were processed alone, whatever the number of workers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from app.__main__ import main
from app.formats.plain import encode
from app.simulate.walk import make_walk

#: Compiling beside other work takes minutes.
pytestmark = pytest.mark.timeout(600)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("walks")
    for k in range(3):
        walk = make_walk({"strides": str(4 + k), "noise": "1", "seed": str(k), "feet": str(1 + k % 2)})
        (place / f"walk {k}.csv").write_bytes(encode(walk.recording))
    (place / "notes.txt").write_text("no recording")
    (place / "inner").mkdir()
    return place


def told(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    assert main(["process", *arguments, "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def without_times(summary: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in summary.items() if key != "estimator_s"}


def test_a_folder_is_its_recordings(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    whole = told(capsys, str(folder), "--jobs", "1")
    assert [one["recording"] for one in whole["recordings"]] == [f"walk {k}.csv" for k in range(3)]
    for one in whole["recordings"]:
        alone = told(capsys, str(folder / one["recording"]))
        assert without_times(one) == without_times(alone)
    assert [one["file"] for one in whole["skipped"]] == ["notes.txt"]
    assert "expected" in whole["skipped"][0]["why"]
    assert 0.0 < whole["estimator_s"] < whole["seconds"]


def test_the_number_of_workers_changes_nothing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one, two = (told(capsys, str(folder), "--jobs", jobs)["recordings"] for jobs in ("1", "2"))
    assert list(map(without_times, one)) == list(map(without_times, two))


def test_tables_go_into_a_folder_each(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["process", str(folder), "--out", str(tmp_path), "--jobs", "1"]) == 0
    text = capsys.readouterr().out
    assert "3 recordings, 1 files skipped" in text
    assert "skipped notes.txt" in text
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"walk {k}.csv" for k in range(3)]
    assert (tmp_path / "walk 1.csv" / "trajectory.csv").exists()


def test_settings_and_what_files_do_not_say_hold_for_all(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = told(capsys, f"{folder}?foot=left", "--set", "gain_stance=2", "--jobs", "1")
    assert {one["settings"]["gain_stance"] for one in found["recordings"]} == {2.0}


def test_a_folder_without_recordings_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "notes.txt").write_text("bring shoes")
    assert main(["process", str(tmp_path), "--json"]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert "no recording among the 1 files" in told.err
