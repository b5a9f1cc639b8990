"""Heart: the papers' step over a table: its rows, and which of them its events change."""

from __future__ import annotations

from app.compiled import kernel, part
from app.estimator import events as e
from app.estimator import state as s
from app.estimator.corrections import correct
from app.estimator.papers import reading_at, step
from app.estimator.running import first_changed, is_told
from app.estimator.state import Record, State
from app.estimator.strapdown import bias_of_swing
from app.motion.basics import Floats


@part
def write_row(rows: Floats, i: int, now: State) -> None:
    """What is known now; a swing's rows are corrected by its zero-velocity update."""
    rows[i, 0], rows[i, 1], rows[i, 2] = now.px + now.sx, now.py + now.sy, now.pz + now.sz
    rows[i, 3], rows[i, 4], rows[i, 5] = now.vx, now.vy, now.vz
    rows[i, 6], rows[i, 7], rows[i, 8], rows[i, 9] = now.q0, now.q1, now.q2, now.q3
    rows[i, 10], rows[i, 11], rows[i, 12] = now.phase, now.statistic, now.threshold_radps


@part
def write_event(event: Floats, now: State, happened: int) -> None:
    """Which rows change, and by what, in the columns of ``events.py``."""
    event[e.HAPPENED], event[e.ROW] = happened, now.row - 1.0
    event[e.LIFT_ROW], event[e.CONTACT_ROW] = now.lift_row, now.end_row
    event[e.LIFT_NS], event[e.SWING_S] = now.lift_ns, now.end_swing_s
    event[e.END], event[e.END + 1], event[e.END + 2] = now.px, now.py, now.pz
    if happened & s.STRIDE:
        bias = bias_of_swing((now.end_vx, now.end_vy, now.end_vz), now.end_swing_s)
        event[e.EPSILON], event[e.EPSILON + 1], event[e.EPSILON + 2] = bias
        event[e.START], event[e.START + 1], event[e.START + 2] = now.from_x, now.from_y, now.from_z


@kernel
def run(
    state: Record, samples: Floats, rows: Floats, begin: int, end: int, events: Floats
) -> tuple[int, int]:
    """Step through ``samples`` [k, 10] from ``begin`` to ``end`` into ``rows`` [k, 13]: see ``running.py``.

    Stops early when ``events`` [m, 22] is full. Returns the next sample's place and the events' count.
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
            first = first_changed(event, i)
            if first >= 0:
                correct(rows[first : i + 1], int(event[e.LIFT_ROW]) + 1, samples[first : i + 1], event, state)
            count += is_told(event, first, happened)
    return end, count
