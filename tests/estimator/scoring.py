"""Errors against measured truth: RMSE after the best yaw and translation, in percent of the path."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import scipy.io

from app.estimator.tracker import Tracker
from app.motion.basics import Floats
from app.settings import Settings
from app.sources.files import load
from tests.estimator.walks import estimate, rows_of

#: Lifts the foot in place: no path to take a share of.
IN_PLACE = "2018-02-09-11-16-53"


def fitted(estimate_n: Floats, truth_n: Floats) -> Floats:
    """The estimate [n, d] turned about down and moved onto the truth, by least squares."""
    a, b = estimate_n - estimate_n.mean(axis=0), truth_n - truth_n.mean(axis=0)
    c = float((a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]).sum())
    s = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
    yaw = np.arctan2(s, c)
    turned = a.copy()
    turned[:, 0] = np.cos(yaw) * a[:, 0] - np.sin(yaw) * a[:, 1]
    turned[:, 1] = np.sin(yaw) * a[:, 0] + np.cos(yaw) * a[:, 1]
    moved: Floats = turned + truth_n.mean(axis=0)
    return moved


def rmse(estimate_n: Floats, truth_n: Floats) -> float:
    return float(np.sqrt(((fitted(estimate_n, truth_n) - truth_n) ** 2).sum(axis=1).mean()))


def path_m(truth_n: Floats) -> float:
    return float(np.linalg.norm(np.diff(truth_n[:, :2], axis=0), axis=1).sum())


def walked(file: Path, settings: Settings) -> tuple[Tracker, Floats]:
    """The estimate of a recording of one foot, and its samples' seconds on the file's own clock."""
    samples = load(file).sensors[0]
    return estimate(samples, settings), (samples.device_ns + samples.matrix[:, 0]) * 1e-9


def vicon_percent(file: Path, settings: Settings) -> float:
    """3-D, all samples; the room's y is mirrored, its z is up."""
    tracker, t_s = walked(file, settings)
    mat = scipy.io.loadmat(str(file))
    truth = mat["gt"] * [1.0, 1.0, -1.0]  # x and y as north and east, down negated
    stamps = mat["ts"].ravel()
    at_rows = np.column_stack([np.interp(t_s, stamps, truth[:, axis]) for axis in range(3)])
    return 100.0 * rmse(rows_of(tracker)[:, :3], at_rows) / path_m(truth[::10])


def corridor_percent(file: Path, settings: Settings) -> float:
    """2-D, at the measured footprints."""
    tracker, t_s = walked(file, settings)
    points = file.with_name(f"{file.stem}_strideIndex_timestamp_gcpX_gcpY.csv")
    with points.open(newline="") as text:
        cells = [row for row in csv.reader(text) if row and _is_number(row[0])]
    table = np.array([[float(cell) for cell in row] for row in cells])
    rows = np.clip(np.searchsorted(t_s, table[:, 1]), 0, len(t_s) - 1)
    truth = table[:, 2:4]
    return 100.0 * rmse(rows_of(tracker)[rows, :2], truth) / path_m(truth)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
