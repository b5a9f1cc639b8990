"""Heart: the papers' step over a table: rows as they come, and what happened."""

from __future__ import annotations

from app.compiled import kernel, part
from app.estimator import state as s
from app.estimator.corrections import correct
from app.estimator.papers import reading_at, step
from app.estimator.state import Record, State
from app.estimator.strapdown import bias_of_swing
from app.motion.basics import Floats


@kernel
def run(
    state: Record, samples: Floats, rows: Floats, begin: int, end: int, events: Floats
) -> tuple[int, int]:
    """Step through ``samples`` [k, 10] from ``begin`` to ``end`` into ``rows`` [k, 13].

    Stops early when ``events`` [m, 22] is full. Returns the next sample's place and the events' count.
    """
    now = state[0]
    count = 0
    for i in range(begin, end):
        if count == events.shape[0]:
            return i, count
        reading = reading_at(samples, i)
        happened = step(now, reading)
        # A swing's rows are what is known now; its zero-velocity update corrects them.
        rows[i, 0], rows[i, 1], rows[i, 2] = now.px + now.sx, now.py + now.sy, now.pz + now.sz
        rows[i, 3], rows[i, 4], rows[i, 5] = now.vx, now.vy, now.vz
        rows[i, 6], rows[i, 7], rows[i, 8], rows[i, 9] = now.q0, now.q1, now.q2, now.q3
        rows[i, 10], rows[i, 11], rows[i, 12] = now.phase, now.statistic, now.threshold_radps
        if happened & s.REPORTED:
            write_event(events[count], now, happened)
            count += keep_event(events[count], rows[: i + 1], samples[: i + 1])
    return end, count


@part
def write_event(event: Floats, now: State, happened: int) -> None:
    """Which rows change, and by what, in the columns of ``Event``."""
    event[0], event[1], event[2], event[3] = happened, now.lift_row, now.end_row, now.row - 1.0
    event[4], event[5] = now.lift_ns, now.end_swing_s
    event[12], event[13], event[14] = now.px, now.py, now.pz
    event[15] = 0.0
    if happened & s.STRIDE:
        end_velocity = (now.end_vx, now.end_vy, now.end_vz)
        event[6], event[7], event[8] = bias_of_swing(end_velocity, now.end_swing_s)
        event[9], event[10], event[11] = now.from_x, now.from_y, now.from_z


@part
def keep_event(event: Floats, rows: Floats, samples: Floats) -> int:
    """Apply an event whose rows are all here, the last of them just made; 1 if more than that is to do."""
    first = int(event[3]) - rows.shape[0] + 1  # the number of row 0
    begin = int(event[1]) + 1 - first
    if begin < 0:
        return 1
    correct(rows[begin:], first + begin, samples[begin:], event)
    event[15] = 1.0
    return 1 if int(event[0]) & (s.STRIDE | s.SEGMENT) else 0
