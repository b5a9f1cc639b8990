"""Benchmarks: how often the 95 % ellipse holds the truth, in the Vicon room."""

from __future__ import annotations

import numpy as np
import scipy.io

from app.blocks import Blocks
from app.estimator.tracker import Tracker
from app.estimator.trust import CHI2_95, unknown_m2
from app.motion.basics import Floats
from app.motion.samples import SAMPLE_WIDTH
from app.settings import Settings
from app.sources.files import load
from benchmarks.measured import DATA
from benchmarks.scoring import mirrored, up

#: Samples between two looks, and before the first.
EVERY, FIRST = 100, 400


def coverage(settings: Settings) -> float:
    """Share of looks at which the truth was inside, all trials together, in per cent.

    Start pinned to the truth's, the yaw by least squares over the looks; then nothing is fitted.
    """
    inside: list[bool] = []
    for path in sorted((DATA / "pyshoe_vicon").glob("*.mat")):
        trial = scipy.io.loadmat(path, variable_names=["gt", "ts"])
        inside += looks(path.stem, load(path).sensors[0].matrix, trial, settings)
    return 100.0 * float(np.mean(inside))


def looks(name: str, matrix: Floats, trial: dict[str, Floats], settings: Settings) -> list[bool]:
    """One trial's."""
    seconds, truth = trial["ts"].ravel(), mirrored(trial["gt"])[:, :2]
    truth = truth[np.searchsorted(seconds - seconds[0], matrix[:, 0] * 1e-9 - 1e-6)]
    table, tracker = Blocks(SAMPLE_WIDTH), Tracker(settings)
    found, doubts, at = [], [], list(range(FIRST, len(matrix), EVERY))
    for end in at:
        table.extend(matrix[table.end : end + 1])
        tracker.advance(table)
        found.append(up(tracker.rows.table(end, end + 1)[:, :3])[0, :2])
        flip = np.array([[1.0, -1.0], [-1.0, 1.0]])  # east to west
        doubts.append(tracker.state["P"][0, :2, :2] * flip + unknown_m2(tracker.state) * np.eye(2))
    e, t = np.array(found), truth[at] - truth[0]
    yaw = np.arctan2(np.sum(e[:, 0] * t[:, 1] - e[:, 1] * t[:, 0]), np.sum(e * t))
    c, s = np.cos(yaw), np.sin(yaw)
    away = e - t @ np.array([[c, -s], [s, c]])
    return [bool(d @ np.linalg.solve(P, d) < CHI2_95) for d, P in zip(away, doubts, strict=True)]
