"""Heart: the Kalman filter over a table: rows as they come, and the newest swing's rows when it is over.

An update at the contact corrects the foot at once; the rows of the swing behind it follow. If velocity
errors grow as a sum of independent parts, the most likely path between a sure lift and a corrected
contact is the cubic that joins them (a Wiener process bridged twice), and the attitude's is linear.
"""

from __future__ import annotations

from app.compiled import kernel, part
from app.estimator import events as e
from app.estimator import state as s
from app.estimator.gait import STANCE, SWING
from app.estimator.kalman import step
from app.estimator.kalman_state import RING, RING_P, RING_Q, KalmanState
from app.estimator.papers import reading_at
from app.estimator.running import first_changed, is_told
from app.estimator.state import Record
from app.motion.basics import Floats, Quaternion
from app.rotation import exponential, multiply, normalise

#: √T as an angular rate in rad/s, so that the graph's unit stays.
AS_RATE = 0.1


@part
def write_row(rows: Floats, i: int, now: KalmanState) -> None:
    """What is known now; a swing's rows are corrected when it is over."""
    rows[i, 0], rows[i, 1], rows[i, 2] = now.px, now.py, now.pz
    rows[i, 3], rows[i, 4], rows[i, 5] = now.vx, now.vy, now.vz
    rows[i, 6], rows[i, 7], rows[i, 8], rows[i, 9] = now.q0, now.q1, now.q2, now.q3
    rows[i, 10] = now.phase
    rows[i, 11], rows[i, 12] = AS_RATE * now.statistic**0.5, AS_RATE * now.threshold**0.5


@part
def write_event(event: Floats, now: KalmanState, happened: int) -> None:
    """Which rows change, and by what, in the columns of ``events.py``."""
    event[e.HAPPENED], event[e.ROW] = happened, now.row - 1.0
    event[e.LIFT_ROW], event[e.CONTACT_ROW] = now.done_lift_row, now.done_contact_row
    event[e.LIFT_NS], event[e.SWING_S] = now.done_lift_ns, now.done_swing_s
    event[e.MOVED] = now.corrected_x - now.before_x
    event[e.MOVED + 1] = now.corrected_y - now.before_y
    event[e.MOVED + 2] = now.corrected_z - now.before_z
    event[e.START], event[e.START + 1], event[e.START + 2] = now.start_x, now.start_y, now.start_z
    event[e.END] = now.at_x + now.corrected_x
    event[e.END + 1] = now.at_y + now.corrected_y
    event[e.END + 2] = now.at_z + now.corrected_z
    event[e.SLOWED], event[e.SLOWED + 1], event[e.SLOWED + 2] = now.slowed_x, now.slowed_y, now.slowed_z
    event[e.TURNED] = now.turned_x - now.unturned_x
    event[e.TURNED + 1] = now.turned_y - now.unturned_y
    event[e.TURNED + 2] = now.turned_z - now.unturned_z


@kernel
def correct(rows: Floats, first_row: int, samples: Floats, event: Floats, state: Record) -> None:
    """Apply ``event`` to ``rows`` [k, 13], whose first has the number ``first_row``.

    ``samples`` [k, 10] are the same rows' samples, ``state`` is as the event left it. Rows outside the
    event stay untouched.
    """
    now = state[0]
    happened, contact_row, last_row = int(event[e.HAPPENED]), event[e.CONTACT_ROW], event[e.ROW]
    for i in range(rows.shape[0]):
        number = first_row + i
        if number <= event[e.LIFT_ROW] or number > last_row:
            continue
        if number < contact_row:
            along_swing(rows[i], event, (samples[i, 0] - event[e.LIFT_NS]) * 1e-9)
            rows[i, 10] = SWING if happened & s.STRIDE else STANCE
        else:
            along_stance(rows[i], now, int(last_row) - number)


@part
def along_swing(row: Floats, event: Floats, since_lift_s: float) -> None:
    """The cubic from the lift, where nothing changes, to the contact, where all of it does."""
    swing_s = event[e.SWING_S]
    u = since_lift_s / swing_s
    rise, reach = u * u * (3.0 - 2.0 * u), u * u * (u - 1.0) * swing_s
    rise_rate, reach_rate = 6.0 * u * (1.0 - u) / swing_s, u * (3.0 * u - 2.0)
    for k in range(3):
        moved, slowed = event[e.MOVED + k], event[e.SLOWED + k]
        row[k] += rise * moved + reach * slowed
        row[3 + k] += rise_rate * moved + reach_rate * slowed
    turn = exponential((u * event[e.TURNED], u * event[e.TURNED + 1], u * event[e.TURNED + 2]))
    turn_row(row, turn)


@part
def along_stance(row: Floats, now: KalmanState, back: int) -> None:
    """The corrections that came after this row, which is ``back`` rows behind the newest.

    The ring has a place for every row, also those of a segment before.
    """
    if back >= RING:
        return
    place = (int(now.ring_at) - back) % RING
    row[0] += now.corrected_x - now.ring[place, RING_P]
    row[1] += now.corrected_y - now.ring[place, RING_P + 1]
    row[2] += now.corrected_z - now.ring[place, RING_P + 2]
    turn = exponential(
        (
            now.turned_x - now.ring[place, RING_Q],
            now.turned_y - now.ring[place, RING_Q + 1],
            now.turned_z - now.ring[place, RING_Q + 2],
        )
    )
    turn_row(row, turn)


@part
def turn_row(row: Floats, turn: Quaternion) -> None:
    """Turn a row's attitude in *n*."""
    row[6], row[7], row[8], row[9] = normalise(multiply(turn, (row[6], row[7], row[8], row[9])))


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
