"""Benchmarks: stride lengths beside motion capture's, at the heel (gaitmap's sample recording)."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from app.settings import Settings
from app.shell import batch
from benchmarks.measured import DATA

IMU_HZ, MOCAP_HZ = 204.8, 100.0
HEEL = {"left": "L_FCC", "right": "R_FCC"}


class Length(NamedTuple):
    """One stride from still foot to still foot: its length as found and as captured, m."""

    foot: str
    found_m: float
    true_m: float


def lengths(settings: Settings) -> Iterator[Length]:
    """Every stride that the sample's own list names, from its least velocity to the next."""
    folder = DATA / "gaitmap_feet"
    done = batch.process(str(folder / "imu_sample.csv"), settings)
    with (folder / "mocap_sample.csv").open(newline="") as text:
        names, _, *rows = list(csv.reader(text))
    capture = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows]) * 1e-3
    with (folder / "stride_events_sample.csv").open(newline="") as text:
        strides = list(csv.DictReader(text))
    for stride in strides:
        foot = stride["foot"]
        tracker = done.trackers[foot]
        begin, end = round(float(stride["start"])), round(float(stride["end"]))
        at = [names.index(HEEL[foot]) + axis for axis in (0, 1)]
        seconds = np.array([begin, end]) / IMU_HZ
        heel = [np.interp(seconds, np.arange(len(capture)) / MOCAP_HZ, capture[:, column]) for column in at]
        ours = tracker.rows.table(begin, begin + 1)[0, :2], tracker.rows.table(end, end + 1)[0, :2]
        true_m = float(np.hypot(heel[0][1] - heel[0][0], heel[1][1] - heel[1][0]))
        if np.isfinite(true_m):
            yield Length(foot, float(np.linalg.norm(ours[1] - ours[0])), true_m)
