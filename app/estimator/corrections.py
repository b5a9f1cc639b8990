"""Heart: what a step reports is applied to the rows behind it, each row by itself."""

from __future__ import annotations

from enum import IntEnum

from app.compiled import kernel
from app.estimator import state as s
from app.estimator.gait import STANCE, SWING
from app.estimator.strapdown import without_bias
from app.motion.basics import Floats


class Event(IntEnum):
    """Columns of an event, float64 [22]: what happened, and which rows change by it."""

    HAPPENED = 0
    LIFT_ROW = 1  # rows after it change
    CONTACT_ROW = 2  # the first quiet row of the stance
    ROW = 3  # the row just made; rows up to and with it change
    LIFT_NS = 4
    SWING_S = 5  # from the lift to the contact
    EPSILON = 6  # 6…8: ε of eq. (10), m/s²
    START = 9  # 9…11: position at the lift
    END = 12  # 12…14: position at the contact
    APPLIED = 15  # 1: the rows are corrected already
    # the Kalman filter's: what its updates since the contact changed, of position (at ``EPSILON``) and …
    SLOWED = 16  # 16…18: of velocity, m/s
    TURNED = 19  # 19…21: of attitude, a turn in n, rad


EVENT_WIDTH = 22
_HAPPENED, _LIFT_ROW, _CONTACT_ROW, _ROW = 0, 1, 2, 3
_LIFT_NS, _EPSILON, _END = int(Event.LIFT_NS), int(Event.EPSILON), int(Event.END)


@kernel
def correct(rows: Floats, first_row: int, samples: Floats, event: Floats) -> None:
    """Apply ``event`` to ``rows`` [k, 13], whose first has the number ``first_row``.

    ``samples`` [k, 10] are the same rows' samples. Rows outside the event stay untouched.
    """
    happened = int(event[_HAPPENED])
    bias = (event[_EPSILON], event[_EPSILON + 1], event[_EPSILON + 2])
    for i in range(rows.shape[0]):
        number = first_row + i
        if number <= event[_LIFT_ROW] or number > event[_ROW]:
            continue
        if happened & s.SWING_FOUND:
            rows[i, 10] = SWING
        if happened & s.STRIDE and number <= event[_CONTACT_ROW]:
            # (9) solved for the true velocity, v − ε·t, and its integral
            since_lift_s = (samples[i, 0] - event[_LIFT_NS]) * 1e-9
            raw = (rows[i, 0], rows[i, 1], rows[i, 2])
            rows[i, 0], rows[i, 1], rows[i, 2] = without_bias(raw, bias, since_lift_s)
            for axis in range(3):
                rows[i, 3 + axis] -= bias[axis] * since_lift_s
            rows[i, 10] = SWING
        elif happened & (s.STRIDE | s.FLICKER):
            for axis in range(3):
                rows[i, axis] = event[_END + axis]
                rows[i, 3 + axis] = 0.0
            rows[i, 10] = STANCE
