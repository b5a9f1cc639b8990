"""Heart: an estimator's step over a table, the same for one sample or a million: rows, and what happened."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from app.estimator import events as e
from app.estimator import state as s
from app.estimator.papers import Reading, reading_at
from app.estimator.state import Record
from app.motion.basics import Floats

Run = Callable[[Record, Floats, Floats, int, int, Floats], tuple[int, int]]
Correct = Callable[[Floats, int, Floats, Floats, Record], None]


def run_of(
    step: Callable[[Any, Reading], int],
    write_row: Callable[[Floats, int, Any], None],
    write_event: Callable[[Floats, Any, int], None],
    correct: Correct,
) -> Run:
    """The run of an estimator that is made of these compiled parts; to be compiled as one kernel."""

    def run(
        state: Record, samples: Floats, rows: Floats, begin: int, end: int, events: Floats
    ) -> tuple[int, int]:
        """Step through ``samples`` [k, 10] from ``begin`` to ``end`` into ``rows`` [k, 13].

        An event whose rows are all here, the last of them just made, is applied at once; those of which
        more is to do are told. Stops early when ``events`` [m, 22] is full. Returns the next sample's
        place and the events' count.
        """
        now = state[0]
        count = 0
        for i in range(begin, end):
            if count == events.shape[0]:
                return i, count
            happened = step(now, reading_at(samples, i))
            write_row(rows, i, now)
            if happened & s.REPORTED:
                event = events[count]
                write_event(event, now, happened)
                first = int(event[e.LIFT_ROW]) + 1
                back = int(event[e.ROW]) - first  # of the first row that changes, behind the newest
                event[e.APPLIED] = back <= i
                if back <= i:
                    correct(rows[i - back : i + 1], first, samples[i - back : i + 1], event, state)
                if back > i or happened & (s.STRIDE | s.SEGMENT):
                    count += 1
        return end, count

    return run
