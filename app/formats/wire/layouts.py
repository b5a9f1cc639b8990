"""Heart: the layout of lines that name each value, so that a name that was damaged changes no column.

A damaged ``t_us`` may read ``t_s``, or be no time at all: the row would be stamped by another clock. So a
first layout is believed when the next row has it too, another one where it differs by what a row may leave
out, or when it stays.
"""

from __future__ import annotations

from app.formats.wire.columns import Columns

#: So many rows in a row of a layout that does not fit: the board prints otherwise now.
CHANGED = 4


class Layouts:
    """Which layouts of one board are believed."""

    def __init__(self) -> None:
        self.usual: Columns | None = None  # the one that is believed
        self._odd: Columns | None = None  # did not fit
        self._in_a_row = 0

    def fits(self, columns: Columns) -> bool:
        """Whether the next row, of this layout, is to be read."""
        usual = self.usual
        if usual is not None and (columns == usual or _agree(columns, usual)):
            self._in_a_row = 0
            return True
        self._in_a_row = self._in_a_row + 1 if columns == self._odd else 1
        self._odd = columns
        if self._in_a_row < (CHANGED if usual else 2):
            return False
        self.usual, self._in_a_row = columns, 0
        return True


def _agree(columns: Columns, usual: Columns) -> bool:
    """Whether rows of both can come from one board: one may lack a field, an orientation, a temperature."""
    kinds = columns.units.keys() & usual.units.keys() | {"force", "rate", "time"}
    alike = all(columns.units.get(kind) == usual.units.get(kind) for kind in kinds)
    return alike and (columns.time is None) == (usual.time is None)
