"""Heart: a tracker that goes on from a saved state, as if it had taken all samples before it."""

from __future__ import annotations

import numpy as np

from app.estimator.methods import METHODS
from app.estimator.strides import Contact
from app.estimator.tracker import Checkpoint, Tracker
from app.motion.estimate import ROW_WIDTH, Saved
from app.settings import Settings


def landed(settings: Settings, saved: Saved) -> Tracker | None:
    """The tracker at the saved row; None if the state is of other settings.

    The rows before it are not known and say where the foot stands there; strides are counted, not told.
    """
    kind = METHODS[settings.estimator].begin(settings, None).dtype
    if saved.settings != settings or len(saved.state) != kind.itemsize or len(saved.newest) != ROW_WIDTH:
        return None
    state = np.frombuffer(saved.state, kind).copy()
    contact = saved.contact and Contact(*saved.contact)
    tracker = Tracker(settings, 0, Checkpoint(state, saved.strides, saved.distance_m, contact))
    tracker.state = state  # to the bit, and not as under settings that may have changed
    tracker.rows.grow(saved.row)
    for piece, _ in tracker.rows.pieces(0, saved.row):
        piece[:] = saved.newest
    return tracker
