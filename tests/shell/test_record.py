"""A source onto the disk by command, and opened again."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from app.__main__ import main
from app.formats.reading import read
from app.formats.states import read_state
from app.home.key import key
from app.session import Session
from app.settings import Settings
from app.sources.files import load
from app.sources.timeline import Timeline

SPEC = "sim:walk?path=straight&feet=2&still_s=1.5&strides=4&seed=3&noise=1&speed=0"


@pytest.fixture(autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))


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


def test_a_long_recording_keeps_states_that_this_user_believes(tmp_path: Path) -> None:
    spec = "sim:walk?path=oval&feet=2&duration_s=70&seed=3&noise=1&speed=0"
    assert main(["record", "--source", spec, "--record", str(tmp_path)]) == 0
    (path,) = tmp_path.glob("*.mcap")
    journal = read(path.name, path.read_bytes()).journal
    assert journal is not None
    rows = {(sensor, state.row) for _, sensor, data in journal.states if (state := read_state(data, key()))}
    assert sorted(sensor for sensor, _ in rows) == ["left", "left", "right", "right"]
    assert all(2900 <= row <= 6600 for _, row in rows)
    assert [state[:2] for state in journal.states] == [way[:2] for way in journal.ways]


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


def test_a_sensor_keeps_its_name_warmth_and_orientation_in_its_recording(tmp_path: Path, capsys) -> None:
    """They are known only once it has answered; its orientation is walked by in a replay as it was live."""
    command = [sys.executable, "-m", "app", "emulate", "mip", "--source", "sim:walk?still_s=1&strides=3"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as sensor:
        assert sensor.stdout is not None
        spec = f"serial:{sensor.stdout.readline().strip()}?device=mip&baud=115200"
        told = main(["record", "--source", spec, "--record", str(tmp_path), "--seconds", "6"])
        sensor.kill()
    assert told == 0
    (path,) = tmp_path.glob("*.mcap")
    recording = load(path)
    assert recording.serials["foot"].startswith("MicroStrain/HBK MIP ")
    assert recording.journal is not None
    (_, whose, celsius), *_ = recording.journal.temperatures
    assert whose == "foot"
    assert 24.0 <= celsius < 24.5
    capsys.readouterr()
    assert main(["info", str(path)]) == 0
    assert "24.0 °C at first" in capsys.readouterr().out
    said = "; ".join(recording.assumed)
    assert "read as MicroStrain/HBK MIP at 115200 baud" in said
    assert "firmware" in said
    session = Session(Settings())
    timeline = Timeline(recording)
    for sample in timeline.cut(0, len(timeline), 0):
        session.take(sample)
    own = session.snapshot().own["foot"]
    assert own.distance_m > 1.0
    assert own.tilt_rad < 0.1
