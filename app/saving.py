"""Heart: what a recording keeps of the estimate now and then: opening and seeking need not begin anew."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import numpy as np

from app.blocks import Blocks
from app.estimator.tracker import Tracker
from app.motion.estimate import Saved, Way
from app.session import Session
from app.tracks import Track
from app.trail import TOLERANCES_M, TrailBuilder, coarser

#: Seconds of a walk between two states.
EVERY_S = 30.0

Due = tuple[str, Saved, Callable[[], Way]]


class _Last(NamedTuple):
    """What was saved last of a sensor: the row it stands before, and when."""

    row: int
    at_s: float


class Saver:
    """Belongs to one recording; tells which feet are due."""

    def __init__(self) -> None:
        self._whole = False
        self._track: Track | None = None
        self._last: dict[str, _Last] = {}

    def begin(self, session: Session) -> None:
        """A recording, or its source, begins here. One begun in a walk is replayed as a walk of its own."""
        self._whole = not any(store.samples.end for store in session.stores.values())
        self._track = None

    def due(self, session: Session) -> Iterator[Due]:
        """Sensor, state and the way since the last, of feet that stand and were not saved for a while."""
        if not self._whole or session.main.smoothed_s is not None:
            return
        if session.main is not self._track:  # another estimate of the whole walk: its way is another
            self._track, self._last = session.main, {}
        for sensor, foot in session.main.feet.items():
            tracker, now_s = foot.tracker, session.stores[sensor].elapsed_s
            last = self._last.get(sensor) or _Last(0, 0.0)
            if now_s - last.at_s >= EVERY_S and tracker.levelled and tracker.settled_end == tracker.rows.end:
                self._last[sensor] = _Last(tracker.rows.end, now_s)
                rows, breaks = tracker.rows.share(), tuple(tracker.segments)
                yield sensor, saved(tracker), partial(way, rows, last.row, breaks)


def saved(tracker: Tracker) -> Saved:
    """A tracker's estimate after its newest row."""
    newest = tracker.rows.table(tracker.rows.end - 1, tracker.rows.end)[0].tolist()
    return Saved(
        settings=tracker.settings,
        row=tracker.rows.end,
        state=tracker.state.tobytes(),
        newest=tuple(newest),
        strides=tracker.stride_count,
        distance_m=tracker.distance_m,
        contact=tracker.contact,
    )


def way(rows: Blocks, first: int, breaks: tuple[int, ...]) -> Way:
    """The trail over settled rows from ``first`` on; ``breaks`` are the rows where a segment begins."""
    builder = TrailBuilder("way")
    edges = [row for row in breaks if first < row < rows.end]
    joined = first if first in breaks else max(first - 1, 0)  # to what came before
    for begin, end in zip([joined, *edges], [*edges, rows.end], strict=True):
        for piece, _ in rows.pieces(begin, end):
            builder.add(piece)
        builder.lift_pen()
    segments = np.concatenate([piece.segments for piece in builder.finished()])
    return Way(max(first, rows.start), rows.end, coarser(segments, TOLERANCES_M[1]))
