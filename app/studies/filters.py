"""Heart: the complementary filter alone, over a table of samples: as printed (Euler), and the app's."""

from __future__ import annotations

import numpy as np

from app.compiled import kernel
from app.estimator.attitude import (
    complementary,
    fqa_tilt,
    fqa_yaw,
    share_of,
    static_quaternion,
    turn_between,
)
from app.motion.basics import Floats, Quaternion
from app.rotation import multiply, normalise, pitch_of, roll_of, yaw_of


@kernel
def euler_filter(samples: Floats, gain: float, start: Quaternion, out: Floats) -> None:
    """Fig. 29 to the letter: each sample's rate and error are held until the next, then normalised."""
    q = start
    out[0, 0], out[0, 1], out[0, 2], out[0, 3] = q
    for i in range(1, samples.shape[0]):
        before = samples[i - 1]
        dt_s = (samples[i, 0] - before[0]) * 1e-9
        rate = multiply(q, (0.0, before[4], before[5], before[6]))
        tilt = fqa_tilt((before[1], before[2], before[3]))
        static = static_quaternion(tilt, fqa_yaw(tilt, (before[7], before[8], before[9]), 0.0), q)
        q = normalise(
            (
                q[0] + dt_s * (0.5 * rate[0] + gain * (static[0] - q[0])),
                q[1] + dt_s * (0.5 * rate[1] + gain * (static[1] - q[1])),
                q[2] + dt_s * (0.5 * rate[2] + gain * (static[2] - q[2])),
                q[3] + dt_s * (0.5 * rate[3] + gain * (static[3] - q[3])),
            )
        )
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = q


@kernel
def exact_filter(samples: Floats, gain: float, start: Quaternion, out: Floats) -> None:
    """The app's own step: the turn and the pull of one sample integrated exactly."""
    q = start
    out[0, 0], out[0, 1], out[0, 2], out[0, 3] = q
    for i in range(1, samples.shape[0]):
        before, now = samples[i - 1], samples[i]
        dt_s = (now[0] - before[0]) * 1e-9
        turn = turn_between((before[4], before[5], before[6]), (now[4], now[5], now[6]), dt_s)
        tilt = fqa_tilt((now[1], now[2], now[3]))
        yaw = fqa_yaw(tilt, (now[7], now[8], now[9]), 0.0)
        q = complementary(q, turn, tilt, yaw, share_of(gain, dt_s))
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = q


@kernel
def _angles(q_nb: Floats, out: Floats) -> None:
    for i in range(q_nb.shape[0]):
        q = (q_nb[i, 0], q_nb[i, 1], q_nb[i, 2], q_nb[i, 3])
        out[i, 0], out[i, 1], out[i, 2] = roll_of(q), pitch_of(q), yaw_of(q)


def run_filter(samples: Floats, gain: float, start: Quaternion, *, euler: bool) -> Floats:
    """Orientation q_nb [n, 4] of every sample [n, 10]; the first is ``start``."""
    out = np.empty((len(samples), 4))
    (euler_filter if euler else exact_filter)(samples, gain, start, out)
    return out


def roll_pitch_yaw_deg(q_nb: Floats) -> Floats:
    """Angles [n, 3] in degrees of orientations [n, 4]."""
    out = np.empty((len(q_nb), 3))
    _angles(q_nb, out)
    return np.degrees(out)
