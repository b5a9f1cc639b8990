"""Heart: where the toe is, told by how the foot turns as it walks.

Before it leaves the ground a foot rolls over its toe, heel up, by some 60 degrees; before it lands
it lifts the toe by 20. So the sideways axis is the level one it turns about most, and the larger of
the two tilts against the stance before and after is toe down. Only a clear case is believed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from app.formats.mounting import Axes, turn
from app.motion.basics import Floats
from app.motion.samples import GAP_NS, Samples

_STANCE_RADPS = 0.6
_STANCE_S = 0.1  # a swinging foot turns back without standing: it is slow, but not for long
_STANCES = 4  # fewer between swings are no walk
_LEAST_RAD = math.radians(25)
_CLEARER = 1.5  # the larger tilt over the smaller
_SIDEWAYS = 2.0  # energy about the sideways axis over that about the other level one


def face_forward(samples: Samples, axes: Axes) -> Axes | None:
    """``axes`` turned about down so that the toe leads, or None where the turning does not tell.

    ``samples`` are still in the sensor's axes.
    """
    rate = turn(samples.matrix[:, 4:7], axes)
    stands = _stands(rate, samples.rate_hz)
    if np.count_nonzero(stands[1:] & ~stands[:-1]) < _STANCES:
        return None
    energy = (rate[:, :2] ** 2).sum(axis=0)
    sideways = int(np.argmax(energy))
    if energy[sideways] < _SIDEWAYS * energy[1 - sideways]:
        return None
    down_tilt, up_tilt = _tilts(samples.matrix[:, 0], rate[:, sideways], stands)
    if max(down_tilt, up_tilt) < max(_LEAST_RAD, _CLEARER * min(down_tilt, up_tilt)):
        return None
    sign = 1 if down_tilt > up_tilt else -1
    toe, right, down = axes
    if sideways == 1:
        return ((toe[0], sign * toe[1]), (right[0], sign * right[1]), down)
    return ((right[0], -sign * right[1]), (toe[0], sign * toe[1]), down)


def _stands(rate: Floats, rate_hz: float) -> NDArray[np.bool_]:
    """Where the foot turns slowly, and has done and goes on doing so for a while."""
    rows = max(int(_STANCE_S * rate_hz), 1)
    slow: NDArray[np.bool_] = maximum_filter1d(np.linalg.norm(rate, axis=1), rows) < _STANCE_RADPS
    return slow


def _tilts(elapsed_ns: Floats, rate: Floats, stands: NDArray[np.bool_]) -> tuple[float, float]:
    """How far the foot tilts by this rate, either way, against the stances around it, rad."""
    steps_s = np.minimum(np.diff(elapsed_ns), GAP_NS) * 1e-9
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * steps_s)])
    angle -= np.interp(elapsed_ns, elapsed_ns[stands], angle[stands])
    low, high = np.percentile(angle, [5, 95])
    return max(-float(low), 0.0), max(float(high), 0.0)
