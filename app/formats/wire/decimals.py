"""Heart: text lines without a checksum, told damaged by their decimals where a board prints ever so many.

A digit that was lost or came to it changes how many stand behind the point. That tells only where the board
prints a fixed number of them, which has to be proven first, column by column: some cells end in a nought
(the shortest form of a number never does), and small and large numbers have as many decimals (numbers of so
many significant digits do not). Until then, and where it is not so, every line holds.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

#: One line in so many is learnt from.
EVERY = 4
#: Cells of a column before it can be judged, and of each size of number.
ENOUGH, ENOUGH_OF_A_SIZE = 100, 10
#: So many of the cells have the usual decimals, or the line is worse than this can help with; of damaged
#: lines at 1 % of bytes 94 % have.
USUAL = 0.8
#: One in ten ends in a nought by chance.
NOUGHTS = 0.03
#: So many lines in a row that do not fit, in the same way: the board prints otherwise now.
CHANGED = 4


class Decimals:
    """Learns one layout of lines."""

    def __init__(self) -> None:
        self._lines = 0
        self._odd = (0, 0)  # column and decimals that did not fit
        self._in_a_row = 0
        self._seen: list[Counter[tuple[int, int]]] = []  # of each column: (decimals, digits) → cells
        self._noughts: list[int] = []
        self._proven: dict[int, int] = {}  # column → where its point stands, from the end

    def hold(self, cells: Sequence[str]) -> bool:
        """Whether a line's cells have the decimals that they always have; learns from them, too."""
        if len(cells) != len(self._seen):
            self._begin(len(cells))
        self._lines += 1
        if self._lines % EVERY == 0:
            self._learn(cells)
        for column, point in self._proven.items():
            if cells[column][point : point + 1] != ".":
                return self._is_changed(column, cells)
        self._in_a_row = 0
        return True

    def _begin(self, count: int) -> None:
        self._lines = self._in_a_row = 0
        self._seen = [Counter() for _ in range(count)]
        self._noughts = [0] * count
        self._proven = {}

    def _is_changed(self, column: int, cells: Sequence[str]) -> bool:
        odd = (column, len(cells[column].partition(".")[2]))
        self._in_a_row = self._in_a_row + 1 if odd == self._odd else 1
        self._odd = odd
        if self._in_a_row < CHANGED:
            return False
        self._begin(len(cells))
        return True

    def _learn(self, cells: Sequence[str]) -> None:
        judged = self._lines % (EVERY * ENOUGH) == 0
        for column, cell in enumerate(cells):
            if column in self._proven:
                continue
            whole, point, fraction = cell.partition(".")
            if not point or not (digits := whole.lstrip("+-") + fraction).isdigit() or len(cell) > 24:
                self._seen[column][0, 0] += 1
                continue
            self._seen[column][len(fraction), len(digits.lstrip("0"))] += 1
            self._noughts[column] += len(fraction) > 1 and fraction[-1] == "0"
            if judged and (usual := self._fixed(column)):
                self._proven[column] = -1 - usual

    def _fixed(self, column: int) -> int:
        """How many decimals a column always has; 0 where that is not proven."""
        seen = self._seen[column]
        count, by_decimals, sizes = seen.total(), Counter[int](), Counter[int]()
        for (decimals, digits), cells in seen.items():
            by_decimals[decimals] += cells
            sizes[digits] += cells
        usual, most = by_decimals.most_common(1)[0]
        large = [size for size, cells in sizes.items() if cells >= ENOUGH_OF_A_SIZE]
        alike = sum(seen[usual, size] >= USUAL * sizes[size] for size in large)
        proven = count >= ENOUGH and most >= USUAL * count and self._noughts[column] >= NOUGHTS * count
        return usual if proven and usual > 1 and alike >= 2 else 0
