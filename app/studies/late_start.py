"""Heart: what it costs to begin a stride's integration late: the papers' lost metres, most likely."""

from __future__ import annotations

import numpy as np

from app.motion.basics import Floats
from app.studies import steps
from app.studies.words import Curve, Plot

#: What 120 m lose between 0.14 and 0.16 s, in words (checked by a test).
SHORT = "1.7 to 5.0 m of 120 m"
HEEL_OFF_S = 0.4


def shortfall_m(late_samples: int, rate_hz: float = 50.0, distance_m: float = 120.0) -> float:
    """How much of a walk is missing when each stride is integrated from so many samples after heel-off on.

    The papers' Gaussian step without any noise, zero-velocity update included.
    """
    t, a = steps.even_grid(rate_hz, steps.gaussian)
    first = round(HEEL_OFF_S * rate_hz) + late_samples
    t, a = t[first:], a[first:]
    velocity = steps.trapezoid(t, a)[1]
    velocity = velocity - velocity[-1] * (t - t[0]) / (t[-1] - t[0])
    return distance_m * (1.0 - float(steps.trapezoid(t, velocity)[1][-1]))


def shortfall_plot() -> Plot:
    """The loss against the delay, with the printed losses."""
    late = np.arange(9)
    seconds: Floats = late / 50.0
    lost = np.array([shortfall_m(int(k)) for k in late])
    curves = (
        Curve("integration begins late", seconds, lost),
        Curve("printed without noise, 3.33 m", seconds, np.full(9, 3.33)),
        Curve("printed with noise, 1.75 m", seconds, np.full(9, 1.75)),
    )
    note = (
        "Why the printed walks are too short, most likely: the detector sees a swing late, and what went"
        " before is lost unless the integration is dated back."
    )
    return Plot("Metres lost of 120 by a late start", "delay after heel-off, s", "lost, m", curves, note)
