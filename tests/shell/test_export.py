"""A recording in other people's formats."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.__main__ import main
from app.formats.plain import encode
from app.simulate.walk import make_walk
from app.sources.files import load

STRAIGHT = {"path": "straight", "feet": "2", "still_s": "1.5", "strides": "6"}


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("export") / "walk.csv"
    path.write_bytes(encode(make_walk(STRAIGHT).recording))
    return path


def test_samples_come_back_from_csv(recording: Path, tmp_path: Path) -> None:
    out = tmp_path / "again.csv"
    assert main(["export", str(recording), "--format", "csv", "--out", str(out)]) == 0
    for one, other in zip(load(recording).sensors, load(out).sensors, strict=True):
        np.testing.assert_array_equal(one.matrix, other.matrix)


@pytest.mark.parametrize(
    ("kind", "files", "begins"),
    [
        ("tum", ["out_left.x", "out_right.x"], "0.000000000 "),
        ("strides", ["out.x"], "foot,start_s"),
        ("sto", ["out.x"], "DataRate=100"),
        ("gpx", ["out.x"], "<?xml"),
        ("kml", ["out.x"], "<?xml"),
        ("geojson", ["out.x"], '{"type": "FeatureCollection"'),
    ],
)
def test_every_format_is_written_once(
    recording: Path, tmp_path: Path, capsys, kind: str, files: list[str], begins: str
) -> None:
    ask = ["export", str(recording), "--format", kind, "--out", str(tmp_path / "out.x"), "--origin", "48,11"]
    assert main(ask) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == files
    assert (tmp_path / files[0]).read_text().startswith(begins)
    assert main(ask) == 2
    assert "File exists" in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["gpx", "kml", "geojson"])
def test_a_map_needs_an_origin(recording: Path, capsys, kind: str) -> None:
    assert main(["export", str(recording), "--format", kind]) == 2
    assert "--origin" in capsys.readouterr().err


def test_what_cannot_be_is_one_line(recording: Path, capsys) -> None:
    ask = ["export", str(recording), "--format", "gpx", "--origin", "48,11"]
    for wrong in (["--declination", "nan"], ["--origin", "x"], ["--out", "/no/such/folder/x"]):
        assert main([*ask, *wrong]) == 2
        assert capsys.readouterr().err.count("\n") == 1
