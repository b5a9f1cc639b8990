"""A source onto the disk by command, and opened again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.__main__ import main
from app.formats.reading import read
from app.sources.files import load

SPEC = "sim:walk?path=straight&feet=2&still_s=1.5&strides=4&seed=3&noise=1&speed=0"


def test_what_is_recorded_opens_as_the_same_walk(tmp_path: Path, capsys) -> None:
    assert main(["record", "--source", SPEC, "--record", str(tmp_path / "a")]) == 0
    (path,) = (tmp_path / "a").glob("*.mcap")
    assert path.name in capsys.readouterr().out
    from app.simulate.walk import make_walk

    query = dict(
        pair.split("=") for pair in SPEC.partition("?")[2].split("&") if not pair.startswith("speed")
    )
    made = make_walk(query).recording
    for one, other in zip(made.sensors, load(path).sensors, strict=True):
        np.testing.assert_array_equal(one.matrix, other.matrix)


def test_it_ends_after_the_seconds_told(tmp_path: Path) -> None:
    slow = SPEC.replace("speed=0", "speed=1")
    assert main(["record", "--source", slow, "--record", str(tmp_path), "--seconds", "0.5"]) == 0
    (path,) = tmp_path.glob("*.mcap")
    journal = read(path.name, path.read_bytes()).journal
    assert journal is not None
    assert 0 < journal.elapsed_ns[-1] < 3e9  # of a walk of 5.9 s


@pytest.mark.parametrize("wrong", [["--seconds", "0"], ["--seconds", "nan"], ["--record", "/proc/none"]])
def test_what_cannot_be_is_one_line(tmp_path: Path, capsys, wrong: list[str]) -> None:
    assert main(["record", "--source", SPEC, "--record", str(tmp_path), *wrong]) == 2
    assert capsys.readouterr().err.count("\n") == 1
