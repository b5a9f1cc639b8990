"""Readings by their times, in whatever order they come."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.readings import Readings
from app.motion.samples import GAP_NS

MS = 1_000_000


def of(*stamps: int) -> Readings:
    made = Readings()
    for stamp in stamps:
        made.add(stamp, (float(stamp), 0.0, -2.0 * stamp))
    return made


@given(st.lists(st.integers(0, 10**8), min_size=2, max_size=50, unique=True), st.floats(0, 1))
def test_a_line_is_found_again_between_its_points(stamps: list[int], where: float) -> None:
    first, last = min(stamps), max(stamps)
    stamp = first + round(where * (last - first))
    value = of(*stamps).at(stamp)
    assert value == pytest.approx((stamp, 0.0, -2.0 * stamp))


def test_nothing_is_invented_outside_or_across_a_gap() -> None:
    readings = of(10 * MS, 20 * MS, 20 * MS + GAP_NS + 1)
    assert readings.at(9 * MS) is None
    assert readings.at(15 * MS) is not None
    assert readings.at(30 * MS) is None
    assert readings.at(20 * MS + GAP_NS + 2) is None
    assert of().at(0) is None


@given(st.lists(st.integers(0, 1000), max_size=50), st.integers(0, 1000))
def test_what_is_popped_is_sorted_and_gone(stamps: list[int], until: int) -> None:
    readings = of(*stamps)
    taken = [stamp for stamp, _ in readings.pop(until)]
    assert taken == sorted(s for s in stamps if s <= until)
    assert [stamp for stamp, _ in readings.pop(10**9)] == sorted(s for s in stamps if s > until)


def test_the_newest_before_is_given_unless_it_is_old() -> None:
    readings = of(10, 20)
    assert readings.before(19, 100) == (10.0, 0.0, -20.0)
    assert readings.before(20, 0) == (20.0, 0.0, -40.0)
    assert readings.before(9, 100) is None
    assert readings.before(500, 100) is None
    readings.forget(19)
    assert readings.before(19, 100) == (10.0, 0.0, -20.0), "the one before is still needed"


def test_readings_that_nobody_fetches_are_forgotten() -> None:
    readings = of(*range(70_000))
    assert len(readings.pop(10**9)) <= 20_000
