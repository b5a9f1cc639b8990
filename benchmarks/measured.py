"""Benchmarks: the measured walks in ../shared/data: an estimate scored against its truth."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import scipy.io

from app.motion.basics import Floats
from app.motion.samples import Samples
from app.settings import Settings
from app.shell import batch
from app.sources.files import load
from benchmarks import scoring

DATA = Path(__file__).resolve().parent.parent.parent / "shared" / "data"
#: Lifts the foot in place: 0.1 m of path, so no share of it means anything.
IN_PLACE = "2018-02-09-11-16-53"


#: What estimates: our settings, or a peer: one foot's samples → positions [n, 3] (x, y, z up).
How = Settings | Callable[[Samples], Floats]


class Score(NamedTuple):
    """One recording's error: RMSE in m over all samples or footprints, and the path in m."""

    name: str
    rmse_m: float
    path_m: float
    found_m: float = 0.0  # the estimate's own path, through the same points
    strides: int = 0  # found
    true_strides: int = 0  # footprints, but for the first
    rise_m: float = 0.0  # height at the end
    pyshoe_m: float = 0.0  # the Vicon room: the error in the metric of that data set's authors

    @property
    def length_percent(self) -> float:
        """By how much the estimate's path is too long, as a share of the true one."""
        return 100.0 * (self.found_m / self.path_m - 1.0)

    @property
    def percent(self) -> float:
        """RMSE as a share of the path."""
        return 100.0 * self.rmse_m / self.path_m


class Estimate(NamedTuple):
    """One foot's estimate: seconds since the file's first row [n], positions [n, 3] (north, west, up)."""

    t_s: Floats
    position: Floats
    summary: dict[str, Any]


def estimate(path: Path, settings: How) -> Estimate:
    """What the app makes of a recording of one foot, as ``process`` does it; or what a peer makes of it."""
    if not isinstance(settings, Settings):
        samples = load(path).sensors[0]
        return Estimate(samples.matrix[:, 0] * 1e-9, settings(samples), {"strides": 0})
    done = batch.process(str(path), settings)
    (sensor,), (tracker,) = done.recording.sensors, done.trackers.values()
    rows = tracker.rows.table(tracker.rows.start, tracker.rows.end)
    return Estimate(sensor.matrix[:, 0] * 1e-9, scoring.up(rows[:, :3]), batch.foot_summary(tracker))


def vicon(settings: How) -> Iterator[Score]:
    """Every trial of pyshoe_vicon: 3-D, over all samples."""
    for path in sorted((DATA / "pyshoe_vicon").glob("*.mat")):
        trial = scipy.io.loadmat(path, variable_names=["gt", "ts"])
        seconds, truth = trial["ts"].ravel(), scoring.mirrored(trial["gt"])
        found = estimate(path, settings)
        # rows that the importer dropped have no estimate: match by time
        rows = np.searchsorted(seconds - seconds[0], found.t_s - 1e-6)
        truth = truth[rows]
        yield Score(
            path.stem,
            scoring.rmse_m(found.position, truth),
            scoring.path_m(truth, scoring.PATH_EVERY),
            scoring.path_m(found.position, scoring.PATH_EVERY),
            pyshoe_m=scoring.pyshoe_m(found.position, truth),
        )


def corridor(settings: How) -> Iterator[Score]:
    """Every recording of hallway_gcp: 2-D, at the footprints, whose times their file gives."""
    for prints in sorted((DATA / "hallway_gcp").glob("*_strideIndex_timestamp_gcpX_gcpY.csv")):
        path = prints.with_name(prints.name.partition("_strideIndex")[0] + ".csv")
        table = np.loadtxt(prints, delimiter=",", skiprows=1)
        truth = scoring.mirrored(table[:, 2:4])
        found = estimate(path, settings)
        rows = np.clip(np.searchsorted(found.t_s, table[:, 1] - 1e-3), 0, len(found.t_s) - 1)
        score = scoring.rmse_m(found.position[rows, :2], truth)
        yield Score(
            path.stem,
            score,
            scoring.path_m(truth),
            scoring.path_m(found.position[rows]),
            int(found.summary["strides"]),
            len(truth) - 1,
            float(found.position[-1, 2] - found.position[0, 2]),
        )


def closures(
    folder: str, settings: Settings, taught_by: str | None = None
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Name and summary of every foot of every recording that ends where it began.

    ``taught_by`` is another recording of the same sensor, whose gyro bias they begin with.
    """
    for path in sorted((DATA / folder).glob("*.csv")):
        try:
            done = batch.process(str(path), settings, taught_by and str(DATA / taught_by))
        except ValueError:  # tables of truth lie beside the recordings
            continue
        for foot, tracker in done.trackers.items():
            yield f"{path.stem} {foot}", batch.foot_summary(tracker)
