"""Benchmarks: run by gaitmap's own Python: one foot's samples in, gaitmap's trajectory out, over and over."""

from __future__ import annotations

import sys

import numpy as np
import pandas as pd
from gaitmap.trajectory_reconstruction import RtsKalman
from scipy.spatial.transform import Rotation


def estimate(given: str, made: str) -> None:
    """Level by the first half second, as gaitmap wants it, and its ``RtsKalman`` as it comes."""
    data = np.load(given)
    t_s, force, rate = data["t_s"], data["force"], data["rate"]
    rest = force[t_s < t_s[0] + 0.5].mean(axis=0)
    level = Rotation.align_vectors([[0.0, 0.0, 1.0]], [rest / np.linalg.norm(rest)])[0]
    table = pd.DataFrame(
        np.hstack([level.apply(force), np.degrees(level.apply(rate))]),
        columns=["acc_x", "acc_y", "acc_z", "gyr_x", "gyr_y", "gyr_z"],
    )
    rate_hz = 1.0 / float(np.median(np.diff(t_s)))
    found = RtsKalman().estimate(table, sampling_rate_hz=rate_hz)
    np.save(made, found.position_.to_numpy()[1:, -3:])


def main() -> None:
    """Two paths a line; a line back when it is done. Its compiler takes a minute, so one process does all."""
    for line in sys.stdin:
        estimate(*line.split())
        print("done", flush=True)


if __name__ == "__main__":
    main()
