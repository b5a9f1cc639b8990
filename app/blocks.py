"""Heart: rows in fixed-size blocks, so that nothing is ever copied to grow, and the oldest can go."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from app.motion.basics import Floats

#: Rows in a block: 4096 rows are 41 s at 100 Hz.
BLOCK = 4096


class Blocks:
    """A float64 table [n, width] that grows by blocks. Row numbers stay valid when old blocks go."""

    def __init__(self, width: int, start: int = 0) -> None:
        """An empty table whose first row will be number ``start`` (a multiple of ``BLOCK``)."""
        self.width = width
        self.start = start  # the oldest row still here
        self.end = start  # one past the newest row
        self._blocks: list[Floats] = []

    def __len__(self) -> int:
        return self.end - self.start

    @property
    def nbytes(self) -> int:
        """Memory of all blocks, in bytes."""
        return len(self._blocks) * BLOCK * self.width * 8

    def block(self, row: int) -> tuple[Floats, int]:
        """The block that holds ``row``, and the row's place in it."""
        return self._blocks[(row - self.start) // BLOCK], (row - self.start) % BLOCK

    def grow(self, rows: int) -> None:
        """Make place for ``rows`` more rows at the end; their content is undefined."""
        self.end += rows
        while len(self._blocks) * BLOCK < self.end - self.start:
            self._blocks.append(np.empty((BLOCK, self.width)))

    def extend(self, table: Floats) -> None:
        """Append the rows of ``table`` [k, width]."""
        begin = self.end
        self.grow(len(table))
        for piece, row in self.pieces(begin, self.end):
            piece[:] = table[row - begin : row - begin + len(piece)]

    def pieces(self, begin: int, end: int) -> Iterator[tuple[Floats, int]]:
        """Views that cover rows ``begin`` to ``end`` (without ``end``), each with its first row number."""
        row = max(begin, self.start)
        while row < end:
            block, place = self.block(row)
            count = min(BLOCK - place, end - row)
            yield block[place : place + count], row
            row += count

    def table(self, begin: int, end: int) -> Floats:
        """A copy of rows ``begin`` to ``end``, float64 [k, width]."""
        views = [piece for piece, _ in self.pieces(begin, end)]
        return np.concatenate(views) if views else np.empty((0, self.width))

    def drop_oldest(self) -> None:
        """Let the oldest block go."""
        self._blocks.pop(0)
        self.start = min(self.start + BLOCK, self.end)

    def share(self) -> Blocks:
        """A second view of the rows that are here now, for a reader in another thread.

        Rows are only ever appended to a sample table, so what is shared never changes.
        """
        other = Blocks(self.width, self.start)
        other.end = self.end
        other._blocks = list(self._blocks)
        return other
