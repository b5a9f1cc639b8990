"""A line is refused by its decimals only where the board prints ever so many; any other is always taken."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.decimals import CHANGED, Decimals

Written = Callable[[float], str]
FIXED: list[Written] = [lambda x, d=d: f"{x:.{d}f}" for d in (2, 3, 6)]  # type: ignore[misc]
OTHERS: list[Written] = [
    repr,
    "{:g}".format,
    lambda x: repr(round(x, 4)),
    lambda x: f"{x:#.5g}",
    "{:.0f}".format,
]
OTHERS += [lambda x: f"{x:.4f}".rstrip("0"), lambda x: f"{x:.3e}", lambda x: f"{x:.1f}"]


def numbers(seed: int, count: int) -> Iterator[list[float]]:
    """A foot that stands, then walks: a time, three forces, three rates."""
    draw = random.Random(seed)
    for i in range(count):
        swing = 0.0 if i < count // 3 else 8.0 * math.sin(i / 15)
        yield [i / 100, *(c + swing + draw.gauss(0, 0.05) for c in (0.0, 0.3, 9.8)),
               *(swing / 3 + draw.gauss(0, 0.01) for _ in range(3))]  # fmt: skip


def lines(written: Written, seed: int = 1, count: int = 3000) -> list[list[str]]:
    return [[written(x) for x in line] for line in numbers(seed, count)]


@pytest.mark.parametrize("written", [*FIXED, *OTHERS])
@pytest.mark.parametrize("seed", [1, 2])
def test_what_a_board_prints_is_taken_however_it_prints(written: Written, seed: int) -> None:
    decimals = Decimals()
    assert all(decimals.hold(cells) for cells in lines(written, seed))


@pytest.mark.parametrize("written", FIXED)
def test_a_digit_too_many_or_too_few_is_seen(written: Written) -> None:
    decimals = Decimals()
    *before, last = lines(written)
    for cells in before:
        decimals.hold(cells)
    seen = 0
    for column in range(1, len(last)):
        for damaged in (last[column][:-1], last[column] + "7"):
            cells = [*last]
            cells[column] = damaged
            seen += not decimals.hold(cells)
            assert decimals.hold(last)
    assert seen == 12


@pytest.mark.parametrize("first", FIXED)
@pytest.mark.parametrize("then", [*FIXED, *OTHERS])
def test_a_board_that_prints_otherwise_is_soon_believed(first: Written, then: Written) -> None:
    decimals = Decimals()
    for cells in lines(first):
        decimals.hold(cells)
    refused = sum(not decimals.hold(cells) for cells in lines(then, 2))
    assert refused <= 20 * CHANGED  # each of its forms may take its turn


def test_before_it_is_proven_every_line_holds() -> None:
    decimals = Decimals()
    draw = random.Random(3)
    assert all(decimals.hold([f"{draw.random():.{draw.randrange(1, 9)}f}"] * 6) for _ in range(3000))


@given(st.lists(st.lists(st.text("0123456789.-+e ", max_size=30), min_size=1, max_size=4), max_size=60))
def test_any_cells(rows: list[list[str]]) -> None:
    decimals = Decimals()
    assert all(decimals.hold(cells) for cells in rows)  # too few to prove anything
