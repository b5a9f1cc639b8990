"""Heart: the formulas of the 2001 report: nulls and scales from extremes and from known turns.

Bachmann et al. 2001, "Sensor Calibration", equations (1) to (5), and its Appendix B for the order. There an
accelerometer reads +1 g on the axis that points down; here it reads −g, which changes places of max and min.
"""

from __future__ import annotations

import numpy as np

from app.motion.basics import Floats


def null(highest: Floats, lowest: Floats) -> Floats:
    """Equations (1) and (3): half way between the extremes."""
    return (highest + lowest) / 2.0


def scale(highest: Floats, lowest: Floats, units: float) -> Floats:
    """Equations (2) and (4): the factor that makes the extremes ±``units``."""
    return 2.0 * units / (highest - lowest)


def turn_scale(known_rad: float, read_rad: float) -> float:
    """Equation (5): the turn that was made over the turn that the sensor saw, at a scale of one."""
    return known_rad / read_rad


def turned(rates: Floats, steps_s: Floats, null_radps: Floats) -> Floats:
    """The integral [3] of rates [n, 3] less the null, rad; ``steps_s`` [n − 1] are between them."""
    mean = (rates[1:] + rates[:-1]) / 2.0 - null_radps
    integral: Floats = steps_s @ mean
    return integral


def extremes(field: Floats, smooth: int = 9) -> tuple[Floats, Floats]:
    """Highest and lowest reading [3] of each axis in fields [n, 3], noise smoothed away first."""
    window = np.ones(smooth) / smooth
    smoothed = np.column_stack([np.convolve(axis, window, mode="valid") for axis in field.T])
    return smoothed.max(axis=0), smoothed.min(axis=0)
