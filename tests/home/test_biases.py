"""Gyro biases on disk, by sensor."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.home import biases, calibrations
from app.home.biases import Remembered
from app.motion.basics import InputError
from app.motion.samples import GyroBias

FOUND = Remembered("3DM-GX1 <1234>", GyroBias((0.1 + 0.2, -0.004, 0.0), (3e-4, 1e-3, 5e-4)), "2026-11-22", "")


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calibrations, "folder", lambda: tmp_path / "config" / "calibrations")


def test_what_was_saved_is_loaded_by_its_sensor_only() -> None:
    assert biases.load(FOUND.sensor) is None
    biases.save(FOUND)
    assert biases.load(FOUND.sensor) == FOUND
    assert biases.load("another") is None
    newer = FOUND._replace(made="2026-11-23", calibrated="2026-11-01")
    biases.save(newer)
    assert biases.load(FOUND.sensor) == newer


@pytest.mark.parametrize("text", ["", "{", "[]", '{"sensor": "another"}', "x" * 5000])
def test_a_file_that_is_none_of_ours_is_one_line(text: str) -> None:
    path = biases.path_of(FOUND.sensor)
    path.parent.mkdir(parents=True)
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match="gyro bias") as told:
        biases.load(FOUND.sensor)
    assert "\n" not in str(told.value)


@given(st.text())
def test_any_text_is_a_bias_or_none(text: str) -> None:
    assert biases.from_json(text) is None


numbers = st.floats(-0.9, 0.9)
doubts = st.floats(1e-9, 0.9)


@given(
    st.text(),
    st.tuples(numbers, numbers, numbers),
    st.tuples(doubts, doubts, doubts),
    st.text(),
    st.none() | st.floats(-50, 125),
)
def test_any_bias_comes_back(
    sensor: str, rate: tuple, doubt: tuple, made: str, celsius: float | None
) -> None:
    found = Remembered(sensor, GyroBias(rate, doubt), made, "", celsius)
    assert biases.from_json(biases.to_json(found)) == found


@pytest.mark.parametrize("warmth", ['"hot"', "true", "1e9", "NaN", "null", "[]"])
def test_a_file_without_a_temperature_is_a_bias_all_the_same(warmth: str) -> None:
    text = biases.to_json(FOUND).replace('"temperature_c": null', f'"temperature_c": {warmth}')
    assert biases.from_json(text) == FOUND
    older = text.replace(f',\n "temperature_c": {warmth}', "")
    assert "temperature" not in older
    assert biases.from_json(older) == FOUND
