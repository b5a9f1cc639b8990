"""Channels by their meta-data: ours come back as they went, others are scaled by their units."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.mounting import parse_axes
from app.formats.units import G_MPS2
from app.formats.wire.lsl import CHANNELS, SHOE_AXES, Channel, StreamReader, row, sensor_of
from app.motion.samples import Sample

SAMPLE = Sample("left", 0, 10, 7, (0.1, 0.2, -9.8), (1.0, 2.0, 3.0), (20.0, 1.0, 44.0))


@pytest.mark.parametrize("channels", [6, 9])
def test_ours_come_back(channels: int) -> None:
    reader = StreamReader("left", CHANNELS[:channels], SHOE_AXES, None)
    got = reader.read(10, row(SAMPLE, channels), 7)
    assert got == (SAMPLE if channels == 9 else SAMPLE._replace(field_b=None))
    assert reader.notes == []


def test_a_missing_field_is_none() -> None:
    reader = StreamReader("left", CHANNELS, SHOE_AXES, None)
    assert reader.read(10, row(SAMPLE._replace(field_b=None), 9), 7) == SAMPLE._replace(field_b=None)


def test_other_units_orders_and_axes() -> None:
    labels = ["t_aux", "GyroX", "GyroY", "GyroZ", "AccX", "AccY", "AccZ"]
    units = ["", "deg/s", "deg/s", "deg/s", "g", "g", "g"]
    reader = StreamReader("foot", [Channel(a, b) for a, b in zip(labels, units, strict=True)], "", None)
    got = reader.read(1, [5.0, 90.0, 0.0, 180.0, 0.0, 0.0, 1.0], 0)
    assert got is not None
    np.testing.assert_allclose(got.specific_force_b, (0, 0, -G_MPS2))  # z up
    np.testing.assert_allclose(got.angular_rate_b, (math.pi / 2, 0, -math.pi))
    assert any("axes" in note for note in reader.notes)
    told = StreamReader("foot", CHANNELS, "", parse_axes("y,x,-z")).read(1, row(SAMPLE, 9), 0)
    assert told is not None
    np.testing.assert_allclose(told.specific_force_b, (0.2, 0.1, 9.8))


def test_a_unit_that_is_not_told_is_assumed_aloud() -> None:
    reader = StreamReader("foot", [Channel(c.label, "") for c in CHANNELS], SHOE_AXES, None)
    assert len(reader.notes) == 3
    assert reader.read(10, row(SAMPLE, 9), 7) is not None


def test_a_stream_of_something_else_is_not_usable() -> None:
    assert not StreamReader("foot", [Channel("Fp1", "uV"), Channel("Fp2", "uV")], "", None).usable


@given(st.lists(st.tuples(st.integers(0, 50), st.lists(st.floats(), max_size=10)), max_size=20))
def test_any_rows_give_finite_samples_with_increasing_stamps(rows: list[tuple[int, list[float]]]) -> None:
    reader = StreamReader("left", CHANNELS[:6], SHOE_AXES, None)
    got = [s for stamp, numbers in rows if (s := reader.read(stamp, numbers, 0)) is not None]
    assert all(np.isfinite([*s.specific_force_b, *s.angular_rate_b]).all() for s in got)
    assert [s.device_ns for s in got] == sorted({s.device_ns for s in got})
    assert len(got) + reader.rejected == len(rows)


@pytest.mark.parametrize(
    ("told", "name", "sensor"),
    [("left", "x", "left"), ("", "IMU_Right_foot", "right"), ("", "IMU", "foot"), ("other", "left", "foot")],
)
def test_which_foot(told: str, name: str, sensor: str) -> None:
    assert sensor_of(told, name) == sensor
