from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats import table
from app.formats.raw import NO_STAMP
from app.formats.table import floats, nanoseconds, read_columns, read_head, shifted_floats, to_text, words
from app.motion.basics import InputError


def columns(data: bytes) -> tuple[np.ndarray, dict[str, int]]:
    text = to_text("x.csv", data)
    found, unread = read_columns("x.csv", text, read_head(text), 0, {0: floats, 1: floats})
    return np.column_stack([found[0], found[1]]), unread


@pytest.mark.parametrize(
    "data",
    [
        b"a,b\n1,2.5\n3,4\n",
        b"a,b\n1,2.5\n3,4",
        b"a,b\r\n1,2.5\r\n3,4\r\n",
        b"a,b\r1,2.5\r3,4\r",
        b"\xef\xbb\xbfa,b\n1,2.5\n3,4\n",
        "a,b\n1,2.5\n3,4\n".encode("utf-16"),
        b"# note\n\n a , b \n1, 2.5\n# more\n\n3,4\n\n",
        b"# a long note\n" * 10_000 + b"a,b\n1,2.5\n# more\n3,4\n",
        b"a;b\n1;2,5\n3;4\n",
        b"a\tb\n1\t2.5\n3\t4.0\n",
        b'"a","b"\n"1","2.5"\n"3","4"\n',
        b"a,b\n+1,.25e1\n3.,4E0\n",
    ],
)
def test_every_dialect_gives_the_same_numbers(data: bytes) -> None:
    numbers, unread = columns(data)
    assert numbers.tolist() == [[1, 2.5], [3, 4]]
    assert not unread


def test_rows_of_the_wrong_width_are_counted() -> None:
    numbers, unread = columns(b"a,b\n1,2\n3\n4,5,6\n7,8\n9")
    assert numbers.tolist() == [[1, 2], [7, 8]]
    assert unread == {"wrong number of cells": 2, "truncated row": 1}


def test_cells_that_are_no_numbers_are_nan() -> None:
    numbers, _ = columns(b"a,b\n1,NaN\nx,\n-inf,2\n")
    np.testing.assert_array_equal(numbers, [[1, np.nan], [np.nan, np.nan], [-np.inf, 2]])


@pytest.mark.parametrize("data", [b"a,b\n", b"a,b", b"a,b\n\n\n", b"a,b\n1\n"])
def test_a_header_alone_is_no_recording(data: bytes) -> None:
    with pytest.raises(InputError, match="no whole row"):
        columns(data)


def test_the_size_of_a_block_does_not_matter(monkeypatch) -> None:
    data = b"a,b\n" + b"".join(b"%d,%d\n" % (i, i * i) for i in range(500)) + b"7"
    whole, unread = columns(data)
    for size in (1, 7, 100, 3000):
        monkeypatch.setattr(table, "_BLOCK_BYTES", size)
        numbers, again = columns(data)
        np.testing.assert_array_equal(numbers, whole)
        assert again == unread == {"truncated row": 1}


@given(st.decimals(-(10**9), 10**9, places=9))
def test_seconds_become_exact_nanoseconds(seconds: Decimal) -> None:
    assert nanoseconds(9)([str(seconds)]).tolist() == [int(seconds * 10**9)]


@pytest.mark.parametrize(("digits", "cell", "ns"), [(6, "1.5", 1_500_000), (3, "2", 2000), (0, "17", 17)])
def test_other_units_of_time(digits: int, cell: str, ns: int) -> None:
    assert nanoseconds(digits)([cell]).tolist() == [ns]


@pytest.mark.parametrize("cell", ["", "x", "nan", "inf", "1e30", "-1e300", "1e400"])
def test_unreadable_stamps(cell: str) -> None:
    assert nanoseconds(9)([cell, "1"]).tolist() == [NO_STAMP, 10**9]


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=-1e300, max_value=1e300))
def test_a_decimal_shift_is_undone_exactly(value: float) -> None:
    cell = str(Decimal(repr(value)).scaleb(-2))
    assert shifted_floats(2)([cell]).tolist() == [value]


def test_words_are_small_and_bare() -> None:
    assert words([' "Left"', "RIGHT "]).tolist() == ["left", "right"]


def test_binary_is_refused() -> None:
    with pytest.raises(InputError, match="binary"):
        to_text("x.bin", b"ab\0cd")
