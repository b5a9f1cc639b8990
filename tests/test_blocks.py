"""Blocks: a table that grows and forgets, against a plain array."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.blocks import BLOCK, Blocks


@given(
    st.lists(st.integers(0, 3000), max_size=8), st.integers(0, 3), st.integers(0, 9000), st.integers(0, 9000)
)
def test_it_is_the_array_that_was_appended(sizes: list[int], drops: int, a: int, b: int) -> None:
    table, whole = Blocks(2), np.empty((0, 2))
    for size in sizes:
        more = np.arange(2 * size, dtype=float).reshape(size, 2) + len(whole)
        table.extend(more)
        whole = np.vstack([whole, more])
    for _ in range(min(drops, len(whole) // BLOCK)):
        table.drop_oldest()
    begin, end = min(a, b, len(whole)), min(max(a, b), len(whole))
    assert np.array_equal(table.table(begin, end), whole[max(begin, table.start) : end].reshape(-1, 2))
    assert (table.end, len(table)) == (len(whole), len(whole) - table.start)
    for row in range(table.start, table.end, 501):
        block, place = table.block(row)
        assert np.array_equal(block[place], whole[row])


def test_a_share_sees_what_was_there_whatever_comes_or_goes() -> None:
    table = Blocks(1)
    table.extend(np.arange(2.0 * BLOCK + 10)[:, None])
    shared = table.share()
    before = shared.table(0, shared.end)
    table.extend(np.full((BLOCK, 1), -1.0))
    table.drop_oldest()
    table.drop_oldest()
    assert (shared.start, shared.end) == (0, 2 * BLOCK + 10)
    assert np.array_equal(shared.table(0, shared.end), before)


def test_it_never_moves_what_it_holds() -> None:
    table = Blocks(1)
    table.extend(np.zeros((10, 1)))
    first, _ = table.block(0)
    table.extend(np.zeros((5 * BLOCK, 1)))
    assert table.block(0)[0] is first
    assert table.nbytes == 6 * BLOCK * 8
