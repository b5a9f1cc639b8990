"""Channels by their meta-data: ours come back as they went, others are scaled by their units."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.mounting import parse_axes
from app.formats.wire.lsl import CHANNELS, SHOE_AXES, Channel, StreamReader, row, sensor_of
from app.motion.basics import G_MPS2
from app.motion.samples import Sample

SAMPLE = Sample("left", 0, 10_000_000_000, 7, (0.1, 0.2, -9.8), (1.0, 2.0, 3.0), (20.0, 1.0, 44.0))


@pytest.mark.parametrize("channels", [6, 9])
def test_ours_come_back(channels: int) -> None:
    reader = StreamReader("left", CHANNELS[:channels], SHOE_AXES, None)
    got = reader.read(10.0, row(SAMPLE, channels), 7)
    assert got == (SAMPLE if channels == 9 else SAMPLE._replace(field_b=None))
    assert reader.notes == []


def test_a_missing_field_is_none() -> None:
    reader = StreamReader("left", CHANNELS, SHOE_AXES, None)
    assert reader.read(10.0, row(SAMPLE._replace(field_b=None), 9), 7) == SAMPLE._replace(field_b=None)


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
    assert reader.read(10.0, row(SAMPLE, 9), 7) is not None


def test_a_stream_of_something_else_is_not_usable() -> None:
    assert not StreamReader("foot", [Channel("Fp1", "uV"), Channel("Fp2", "uV")], "", None).usable


def stamps_of(told_s: list[float], arrive_s: list[float]) -> list[float]:
    """Seconds that a reader gives the rows it takes, in whole milliseconds."""
    reader = StreamReader("left", CHANNELS, SHOE_AXES, None)
    numbers, made = row(SAMPLE, 9), []
    for t_s, host_s in zip(told_s, arrive_s, strict=True):
        if (sample := reader.read(t_s, numbers, round(host_s * 1e9))) is not None:
            made.append(round(sample.device_ns * 1e-9, 3))
    assert len(made) + reader.rejected == len(told_s)
    return made


EVEN = [100.0 + 0.01 * i for i in range(100)]


@pytest.mark.parametrize("wild", [1e9, 99.0, 0.0, math.nan, math.inf, -math.inf, 1e300, -5.0])
@pytest.mark.parametrize("at", [1, 50, 98])
def test_a_lone_wild_stamp_costs_its_own_row(wild: float, at: int) -> None:
    rest = [*EVEN[:at], *EVEN[at + 1 :]]
    made = stamps_of([*EVEN[:at], wild, *EVEN[at + 1 :]], EVEN)
    np.testing.assert_allclose(made, rest, atol=0.002)


@pytest.mark.parametrize("shift_s", [-90.0, -0.5, 5000.0])
def test_a_clock_that_was_set_anew_goes_on_behind_a_gap(shift_s: float) -> None:
    told = EVEN[:50] + [t_s + shift_s for t_s in EVEN[50:]]
    made = stamps_of(told, EVEN)
    steps = np.diff(made)
    assert len(made) > 90
    assert (steps > 0.0).all()
    assert (steps > 0.249).sum() == 1
    assert made[-1] - made[0] < 2.0  # at the pace of this machine, not thousands of seconds on


def test_what_waited_for_the_network_keeps_its_own_times() -> None:
    assert stamps_of(EVEN, [t_s if t_s < 100.5 else 130.0 for t_s in EVEN]) == [round(t_s, 3) for t_s in EVEN]


STAMPS = st.one_of(st.integers(0, 50).map(float), st.floats())


@given(st.lists(st.tuples(STAMPS, st.lists(st.floats(), max_size=10)), max_size=20))
def test_any_rows_give_finite_samples_with_increasing_stamps(rows: list[tuple[float, list[float]]]) -> None:
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
