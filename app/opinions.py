"""Edge to the peers: outside opinions on the attitude study, by ahrs and imufusion where they are there.

Both want x forward, y left, z up and an accelerometer that reads +g: our axes turned half around x.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence

import numpy as np

from app.motion.basics import G_MPS2, Floats
from app.studies.attitude import Config, Found
from app.studies.motions import MOTIONS
from app.studies.words import Task

_HALF_TURN = np.array([1.0, -1.0, -1.0])
_SAME_TURN = np.array([1.0, 1.0, -1.0, -1.0])


def tasks(config: Config) -> Sequence[Task]:
    """Each package that is there, on every motion."""
    there = [
        (package, run)
        for package, run in (("ahrs", ahrs_madgwick), ("imufusion", imufusion_ahrs))
        if importlib.util.find_spec(package)
    ]
    return [
        Task(run, (name, make(config.sensor).samples), timed=True)
        for _, run in there
        for name, make in MOTIONS.items()
    ]


def ahrs_madgwick(motion: str, samples: Floats) -> Found:
    """Madgwick's gradient filter as the package ahrs has it, its own gain."""
    from ahrs.filters import Madgwick

    rate_hz = 1e9 / float(np.median(np.diff(samples[:, 0])))
    force, rate, field = (samples[:, i : i + 3] * _HALF_TURN for i in (1, 4, 7))
    found = Madgwick(gyr=rate, acc=force, mag=field, frequency=rate_hz, q0=[1.0, 0.0, 0.0, 0.0])
    return Found("ahrs Madgwick", motion, np.asarray(found.Q) * _SAME_TURN)


def imufusion_ahrs(motion: str, samples: Floats) -> Found:
    """x-io's Fusion with its own settings, which reject what disturbs; it starts by itself."""
    import imufusion

    filter_ = imufusion.Ahrs()
    force, rate, field = (samples[:, i : i + 3] * _HALF_TURN for i in (1, 4, 7))
    q = np.empty((len(samples), 4))
    filter_.set_sample_period(float(np.median(np.diff(samples[:, 0]))) * 1e-9)
    for i in range(len(samples)):
        filter_.update(np.degrees(rate[i]), force[i] / G_MPS2, field[i])
        q[i] = filter_.get_quaternion()
    return Found("imufusion", motion, q * _SAME_TURN)
