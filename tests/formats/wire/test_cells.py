from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.cells import (
    flat_object,
    force_unit,
    named_cells,
    nanoseconds,
    number,
    readable,
    split_cells,
    time_unit,
    unwrapped,
)

HEADER = b"t_ms,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps,mx_ut,my_ut,mz_ut\n"


@pytest.mark.parametrize(
    ("rest", "unit"), [(1.02, "g"), (9.7, "m/s2"), (985.0, "mg"), (3.0, None), (0.0, None)]
)
def test_units_of_force(rest: float, unit: str | None) -> None:
    assert force_unit(rest) == unit


def test_a_time_that_stands_still_is_taken_for_seconds() -> None:
    assert time_unit(["5", "5", "x"]) == "s"


@pytest.mark.parametrize(
    ("line", "verdict"),
    [
        (b"1,2,3,4,5,6\n", True),
        (HEADER, True),
        (b'{"hello":1}\n', False),
        (b"1,2,3\n", False),
        (b"hello, foot\n", False),
    ],
)
def test_what_reads_like_a_sensor(line: bytes, verdict: bool) -> None:
    assert readable(line) is verdict


@given(st.text(alphabet=st.characters(exclude_characters="\r\n", codec="utf-8"), max_size=60))
def test_any_text_raises_nothing(line: str) -> None:
    line = line.strip()
    split_cells(line)
    named_cells(unwrapped(line) or "")
    flat_object(line)
    number(line)
    nanoseconds(line, 1000)
    readable(line.encode())


@given(st.integers(0, 10**12), st.integers(0, 10**9 - 1))
def test_decimal_times_are_exact_to_the_nanosecond(seconds: int, fraction: int) -> None:
    assert nanoseconds(f"{seconds}.{fraction:09d}", 10**9) == seconds * 10**9 + fraction
    assert nanoseconds(f"{seconds}", 10**6) == seconds * 10**6


@pytest.mark.parametrize(
    ("cell", "ns"),
    [("12:00:01.5", 43_201_500_000_000), ("1e3", 10**12), ("-2", -2 * 10**9), ("nan", None), ("x", None)],
)
def test_other_times(cell: str, ns: int | None) -> None:
    assert nanoseconds(cell, 10**9) == ns


@pytest.mark.parametrize(("line", "count"), [("a,b;c", 2), ("a;b", 2), ("a b  c", 3), ("a\tb c", 2)])
def test_the_first_separator_counts(line: str, count: int) -> None:
    assert len(split_cells(line)) == count


def test_a_wrong_checksum_unwraps_to_nothing() -> None:
    assert unwrapped("$IMU,1*00") is None
    assert unwrapped("IMU,1,2") == "1,2"
    assert unwrapped("ax,ay") == "ax,ay"
