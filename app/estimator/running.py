"""Heart: what the runs of both estimators share: the way from a step to rows and to what happened.

A run is the same for one sample or a million. An event whose rows are all here, the last of them just
made, is applied at once; those of which more is to do are told. The loop itself stands in ``papers_run.py``
and in ``kalman_run.py``: numba keeps no kernel for the next start that is made of functions given to it.
"""

from __future__ import annotations

from collections.abc import Callable

from app.compiled import part
from app.estimator import events as e
from app.estimator import state as s
from app.estimator.state import Record
from app.motion.basics import Floats

Run = Callable[[Record, Floats, Floats, int, int, Floats], tuple[int, int]]
Correct = Callable[[Floats, int, Floats, Floats, Record], None]


@part
def first_changed(event: Floats, i: int) -> int:
    """The place of the first row that changes, where the newest, ``event``'s, is at ``i``; < 0: not here."""
    return i - (int(event[e.ROW]) - int(event[e.LIFT_ROW]) - 1)


@part
def is_told(event: Floats, first: int, happened: int) -> int:
    """1 if more is to do than what was done from row ``first`` on; and note in ``event`` that it was."""
    event[e.APPLIED] = first >= 0
    return 1 if first < 0 or happened & (s.STRIDE | s.SEGMENT) else 0
