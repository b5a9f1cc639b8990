"""Missing readings by their numbers: a damaged number counts for nothing, many only when it goes on."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.counting import Count


@given(
    start=st.integers(0, 70_000),
    steps=st.lists(st.one_of(st.integers(1, 10), st.integers(100, 5000)), min_size=1, max_size=60),
)
def test_what_is_missing_is_counted_over_wraps_and_long_cuts(start: int, steps: list[int]) -> None:
    """Each cut is followed by a reading that follows it."""
    count, number, told, missing = Count(16), start, 0, 0
    count.missing(number)
    for step in steps:
        number += step
        told += count.missing(number)
        number += 1
        told += count.missing(number)
        missing += step - 1
    assert told == missing


@given(damaged=st.sets(st.integers(5, 95), max_size=20), wrong=st.integers(1000, 60_000))
def test_a_damaged_number_is_none(damaged: set[int], wrong: int) -> None:
    count = Count(16)
    told = sum(count.missing((wrong * (1 + i % 7) if i in damaged else i) & 0xFFFF) for i in range(100))
    alone = all({i - 1, i + 1}.isdisjoint(damaged) for i in damaged)
    assert told == 0 or not alone or any((wrong * (1 + i % 7)) & 0xFFFF < 200 for i in damaged)


def test_a_device_that_began_anew_lost_nothing() -> None:
    count = Count(16)
    assert [count.missing(number) for number in (5000, 5001, 0, 1, 2)] == [0, 0, 0, 0, 0]
