"""A verdict says what the digits, the bound or chance allow, and gives a reason where it is not the best."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.studies.verdicts import Judge, last_place
from app.studies.walks import _spread
from app.studies.words import Row, Verdict

JUDGE = Judge("test")


@pytest.mark.parametrize(("text", "unit"), [
    ("40.15", 0.01), ("7", 1.0), ("-0.04155", 1e-5), ("1.705e-13", 1e-16), ("2e3", 1e3),
])  # fmt: skip
def test_the_last_place_of_a_number_as_printed(text: str, unit: float) -> None:
    assert last_place(text) == pytest.approx(unit)


@given(st.integers(-99999, 99999), st.integers(0, 5), st.floats(-0.499, 0.499))
def test_what_rounds_to_the_printed_digits_is_reproduced(digits: int, decimals: int, off: float) -> None:
    printed = f"{digits / 10**decimals:.{decimals}f}"
    row = JUDGE.digits("x", printed, (digits + off) / 10**decimals, "m")
    assert row.verdict is Verdict.REPRODUCED
    assert row.printed_as == printed


@pytest.mark.parametrize(("got", "verdict"), [
    (40.15, Verdict.REPRODUCED),
    (40.1551, Verdict.CLOSE),
    (40.5, Verdict.CLOSE),
    (40.6, Verdict.NOT_REPRODUCED),
    (-40.15, Verdict.NOT_REPRODUCED),
    (math.nan, Verdict.NOT_REPRODUCED),
    (math.inf, Verdict.NOT_REPRODUCED),
])  # fmt: skip
def test_digits(got: float, verdict: Verdict) -> None:
    assert JUDGE.digits("x", "40.15", got, "%").verdict is verdict


@pytest.mark.parametrize(("got", "verdict"), [
    (1.99, Verdict.REPRODUCED), (2.1, Verdict.CLOSE), (2.3, Verdict.NOT_REPRODUCED),
])  # fmt: skip
def test_bounds(got: float, verdict: Verdict) -> None:
    row = JUDGE.bound("x", "< 2", got, "deg")
    assert (row.verdict, row.printed, row.printed_as) == (verdict, 2.0, "< 2")


@pytest.mark.parametrize(("got", "verdict"), [
    (1.0 + 0.31, Verdict.REPRODUCED), (1.0 + 0.36, Verdict.NOT_REPRODUCED), (0.5, Verdict.NOT_REPRODUCED),
])  # fmt: skip
def test_chance_allows_three_standard_errors(got: float, verdict: Verdict) -> None:
    assert JUDGE.chance("x", "1.0", got, "m", error=0.1).verdict is verdict


def test_fifty_walks_spreads_are_held_to_two() -> None:
    """The same law at three would call 0.05 and 0.073 the same."""
    walks = 0.073 * np.sqrt(49 / 50) * np.tile([-1.0, 1.0], 25)
    assert _spread(JUDGE, "x", "0.05", walks).verdict is Verdict.NOT_REPRODUCED
    assert _spread(JUDGE, "x", "0.06", walks).verdict is Verdict.REPRODUCED


@pytest.mark.parametrize("row", [
    JUDGE.digits("x", "1.0", 2.0, "m"),
    JUDGE.digits("x", "1.000", 1.001, "m"),
    JUDGE.bound("x", "> 5", 1.0, "m"),
    JUDGE.chance("x", "1", 4.0, "m", error=0.1),
    JUDGE.round_off("x", "1e-13", 1e-3, "m", below=1e-9),
    JUDGE.round_off("x", "1e-13", 1e-14, "m", below=1e-9),
    JUDGE.no_data("x", "1", 2.0, "m", "never published"),
])  # fmt: skip
def test_whatever_is_not_reproduced_says_why(row: Row) -> None:
    assert row.verdict is not Verdict.REPRODUCED
    assert row.why


def test_a_reason_given_for_the_worst_is_not_told_of_what_is_reproduced() -> None:
    assert JUDGE.digits("x", "1.0", 1.0, "m", why="a wrong sign").why == ""
    assert JUDGE.digits("x", "1.0", 9.0, "m", why="a wrong sign").why == "a wrong sign"
