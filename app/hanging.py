"""Heart: a sensor that hangs on a rod, as its lesson shows it: the angle, the true one, the period."""

from __future__ import annotations

import numpy as np

from app.motion.basics import Floats, Quaternion
from app.motion.snapshot import PendulumView
from app.rotation import pitch_of

#: A swing smaller than this has no period that one could tell.
LEAST_SWING_RAD = 0.01


def pendulum_view(rod_m: float, q_nb: Quaternion, true_q_nb: Quaternion, recent: Floats) -> PendulumView:
    """The pendulum at one instant; ``recent`` [k, 4] are the last seconds as ``truth.errors`` gives them."""
    t_s, _, angle, true = recent.T
    return PendulumView(
        rod_m,
        q_nb,
        true_q_nb,
        angle_rad=pitch_of(q_nb),
        true_rad=pitch_of(true_q_nb),
        worst_rad=float(np.abs(angle - true).max(initial=0.0)),
        period_s=period(t_s, angle),
        true_period_s=period(t_s, true),
    )


def period(t_s: Floats, angle: Floats) -> float | None:
    """Seconds from one upward pass through the middle to the next, on average; None before the second one."""
    if len(t_s) < 2 or np.ptp(angle) < LEAST_SWING_RAD:
        return None
    off = angle - angle.mean()
    up = np.flatnonzero((off[:-1] < 0.0) & (off[1:] >= 0.0))
    passes = t_s[up] - off[up] * (t_s[up + 1] - t_s[up]) / (off[up + 1] - off[up])
    return float((passes[-1] - passes[0]) / (len(passes) - 1)) if len(passes) > 1 else None
