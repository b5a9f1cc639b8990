"""Heart: what a walk has taught of its sensor's gyro bias, for the next one to begin with."""

from __future__ import annotations

import numpy as np

from app.estimator.standing import PRIOR_RADPS
from app.estimator.tracker import Tracker
from app.motion.samples import GyroBias

#: A bias is worth remembering when each axis is surer than this, half of what is known of any gyro, rad/s.
MOST_DOUBT_RADPS = 0.5 * PRIOR_RADPS


def learnt(tracker: Tracker) -> GyroBias | None:
    """The bias by the walk's rests; None where none said anything of it, or too little.

    What the filter made of it in walking is left out: at low rates it takes the errors of swings for bias.
    """
    state = tracker.state
    if "bias_info" not in (state.dtype.names or ()) or not tracker.levelled:
        return None
    info = state["bias_info"][0]
    told_by_rests = info - state["known_info"][0] - 1.0 / PRIOR_RADPS**2
    doubt = 1.0 / np.sqrt(info)
    if np.any(told_by_rests <= 0.0) or np.any(doubt > MOST_DOUBT_RADPS):
        return None
    x, y, z = (state["bias_sum"][0] / info).tolist()
    u, v, w = doubt.tolist()
    return GyroBias((x, y, z), (u, v, w))
