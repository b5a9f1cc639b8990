"""Heart: how sure the Kalman filter is of where the foot is, from its covariance, and that in a word."""

from __future__ import annotations

import math

import numpy as np

from app.estimator.state import Record
from app.motion.estimate import Trust

#: A χ² of two parts is below this in 95 of 100 cases.
CHI2_95 = 5.991
#: Without a stance for so long the integral is no longer to be believed.
LOST_S = 2.0
#: How far swings miss the zero velocity of the stance behind them, as χ² of three parts on average: what
#: fits is within 3; far beyond, the samples are not those of a walking foot, or not as they are said to be.
UNFIT, LOST_UNFIT = 12.0, 30.0
#: Good is an ellipse within half a metre, or this share of the distance walked.
GOOD_M, GOOD_SHARE = 0.5, 0.02
#: What an accelerometer misses beyond its range goes the same way each stride: lost beyond this share.
LOST_SHARE = 0.1


def trust_of(record: Record, distance_m: float) -> Trust | None:
    """The ellipse and the word; None while level is being sought. ``distance_m`` is how far it walked."""
    state = record[0]
    if not state["levelled"]:
        return None
    values, vectors = np.linalg.eigh(state["P"][:2, :2] + unknown_m2(record) * np.eye(2))
    minor_m, major_m = (math.sqrt(CHI2_95 * max(float(value), 0.0)) for value in values)
    angle_rad = math.atan2(float(vectors[1, 1]), float(vectors[0, 1]))
    hungry_s = float(state["elapsed_ns"] - state["quiet_ns"]) * 1e-9
    if hungry_s > LOST_S:
        return Trust(major_m, minor_m, angle_rad, "lost", f"no stance for {hungry_s:.0f} s")
    unfit = float(state["unfit"])
    if unfit > UNFIT:
        why = "swings do not end at rest: another rate or unit than the sensor's?"
        return Trust(major_m, minor_m, angle_rad, "lost" if unfit > LOST_UNFIT else "drifting", why)
    if major_m > max(GOOD_M, GOOD_SHARE * distance_m):
        missed_m = float(state["missed_m"])
        word = "lost" if missed_m > max(GOOD_M, LOST_SHARE * distance_m) else "drifting"
        why = "the accelerometer's range is too small: " if 4.0 * missed_m > major_m else ""
        return Trust(major_m, minor_m, angle_rad, word, f"{why}may be {major_m:.1f} m off")
    return Trust(major_m, minor_m, angle_rad, "good", "")


def unknown_m2(record: Record) -> float:
    """σ² of where the foot is beside P, m²: swings that did not end at rest, or went beyond the range."""
    return float(record["unknown_m2"][0] + record["missed_m"][0] ** 2)
