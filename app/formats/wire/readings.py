"""Heart: readings of one sensor by their times, for joining sensors that measure at different moments."""

from __future__ import annotations

from bisect import bisect_left, insort

from app.motion.basics import Vector
from app.motion.samples import GAP_NS

_MOST = 20_000  # waiting for another sensor's


class Readings:
    """One sensor's readings in the order of their times."""

    def __init__(self) -> None:
        self._all: list[tuple[int, Vector]] = []

    def add(self, stamp: int, v: Vector) -> None:
        """A reading, in any order; the oldest go where nobody fetches them."""
        if not self._all or stamp > self._all[-1][0]:
            self._all.append((stamp, v))
        else:
            insort(self._all, (stamp, v))
        if len(self._all) > _MOST:
            del self._all[: _MOST // 2]

    @property
    def last(self) -> int:
        """The newest time; −1 before the first."""
        return self._all[-1][0] if self._all else -1

    def pop(self, until: int) -> list[tuple[int, Vector]]:
        """The readings up to ``until``, which go."""
        count = bisect_left(self._all, (until + 1,))
        taken, self._all = self._all[:count], self._all[count:]
        return taken

    def at(self, stamp: int) -> Vector | None:
        """The value between the readings around; None where there are none near."""
        after = bisect_left(self._all, (stamp,))
        if after < len(self._all) and self._all[after][0] == stamp:
            return self._all[after][1]
        if not 0 < after < len(self._all):
            return None
        (before_ns, a), (after_ns, b) = self._all[after - 1], self._all[after]
        if after_ns - before_ns > GAP_NS:
            return None
        s = (stamp - before_ns) / (after_ns - before_ns)
        return (a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]))

    def before(self, stamp: int, most_ns: int) -> Vector | None:
        """The newest value up to then, if it is not older than ``most_ns``."""
        after = bisect_left(self._all, (stamp + 1,))
        if after == 0 or stamp - self._all[after - 1][0] > most_ns:
            return None
        return self._all[after - 1][1]

    def forget(self, until: int) -> None:
        """All but the last reading up to ``until``."""
        del self._all[: max(bisect_left(self._all, (until + 1,)) - 1, 0)]
