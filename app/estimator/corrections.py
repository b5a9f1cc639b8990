"""Heart: what a step reports is applied to the rows behind it, each row by itself."""

from __future__ import annotations

from app.compiled import kernel
from app.estimator import events as e
from app.estimator import state as s
from app.estimator.gait import STANCE, SWING
from app.estimator.state import Record
from app.estimator.strapdown import without_bias
from app.motion.basics import Floats


@kernel
def correct(rows: Floats, first_row: int, samples: Floats, event: Floats, _: Record) -> None:
    """Apply ``event`` to ``rows`` [k, 13], whose first has the number ``first_row``.

    ``samples`` [k, 10] are the same rows' samples. Rows outside the event stay untouched.
    """
    happened = int(event[e.HAPPENED])
    bias = (event[e.EPSILON], event[e.EPSILON + 1], event[e.EPSILON + 2])
    for i in range(rows.shape[0]):
        number = first_row + i
        if number <= event[e.LIFT_ROW] or number > event[e.ROW]:
            continue
        if happened & s.SWING_FOUND:
            rows[i, 10] = SWING
        if happened & s.STRIDE and number <= event[e.CONTACT_ROW]:
            # (9) solved for the true velocity, v − ε·t, and its integral
            since_lift_s = (samples[i, 0] - event[e.LIFT_NS]) * 1e-9
            raw = (rows[i, 0], rows[i, 1], rows[i, 2])
            rows[i, 0], rows[i, 1], rows[i, 2] = without_bias(raw, bias, since_lift_s)
            for axis in range(3):
                rows[i, 3 + axis] -= bias[axis] * since_lift_s
            rows[i, 10] = SWING
        elif happened & (s.STRIDE | s.FLICKER):
            for axis in range(3):
                rows[i, axis] = event[e.END + axis]
                rows[i, 3 + axis] = 0.0
            rows[i, 10] = STANCE
