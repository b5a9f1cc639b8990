"""Heart: readings missing by the number that a device gives each: a damaged number is none.

Few missing are believed at once, many when the next number follows: a number that was damaged is followed by
none, and a device that began anew has lost nothing.
"""

from __future__ import annotations

#: So many are believed at once.
FEW = 16


class Count:
    """The numbers of one device, of so many ``bits``."""

    def __init__(self, bits: int) -> None:
        self._wrap = 1 << bits
        self._last: int | None = None
        self._odd: int | None = None

    def missing(self, number: int) -> int:
        """How many are seen to be missing with this one."""
        number %= self._wrap
        last, odd, self._odd = self._last, self._odd, None
        step = 1 if last is None else (number - last) % self._wrap
        if 0 < step <= FEW:
            self._last = number
            return max(step - 1 - (odd is not None), 0)  # the odd one came too
        if odd is None or not 0 < (number - odd) % self._wrap <= FEW:
            self._odd = number
            return 0
        self._last = number
        return step - 2 if step < self._wrap // 2 else 0
