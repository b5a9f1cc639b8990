"""Studies from the command line: rows as scripts rely on them, a report, one line for what is wrong."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.__main__ import main
from app.studies.catalogue import STUDIES

#: Compiling beside other work takes minutes.
pytestmark = pytest.mark.timeout(600)

CONTRACT = {"study", "item", "printed", "got", "unit", "verdict", "why"}
VERDICTS = {"reproduced", "close", "not reproduced", "no data"}


def test_json_is_one_object_with_the_rows_that_scripts_read(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["study", "integrators", "--json", "--jobs", "1"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert len(rows) > 24
    for row in rows:
        assert set(row) >= CONTRACT
        assert row["study"] == "integrators"
        assert row["verdict"] in VERDICTS
        assert isinstance(row["got"], float)
        assert isinstance(row["printed"], float)
        assert row["why"] or row["verdict"] == "reproduced"
    assert list(tmp_path.iterdir()) == []  # a script that did not ask for files gets none


def test_a_person_gets_the_rows_and_a_report(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["study", "integrators", "--jobs", "1"]) == 0
    told = capsys.readouterr().out
    assert "Table 4, 20 Hz, position error: printed 40.15, got 40.15 %" in told
    assert (tmp_path / "studies/report.html").stat().st_size < 5_000_000
    assert json.loads((tmp_path / "studies/rows.json").read_text("utf-8"))["rows"]


@pytest.mark.parametrize(("arguments", "says"), [
    (["study", "juggling"], "study juggling: expected all or one of integrators"),
    (["study", "integrators", "--jobs", "0"], "--jobs 0: expected 1 to 1024"),
])  # fmt: skip
def test_wrong_input_is_one_line(arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert says in error
    assert error.count("\n") == 1


def test_a_folder_that_cannot_be_written(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert main(["study", "integrators", "--jobs", "1", "--out", str(tmp_path / "file")]) == 2
    assert "--out" in capsys.readouterr().err


@pytest.mark.parametrize("name", STUDIES)
def test_every_study_is_named_as_its_rows_are(name: str) -> None:
    experiment = STUDIES[name]
    assert all(callable(task.run) for task in experiment.tasks(experiment.config))
