"""What the estimator's tests walk on: simulated walks, and rows made by hand."""

from __future__ import annotations

from functools import cache

import numpy as np

from app.blocks import Blocks
from app.estimator.tracker import Tracker, track
from app.motion.basics import Floats, Role
from app.motion.samples import SAMPLE_WIDTH, Sample, Samples
from app.settings import Settings
from app.simulate.walk import SimulatedWalk, make_walk

G = 9.80665
PAPERS = Settings()


@cache
def walk(query: str = "") -> SimulatedWalk:
    """A simulated walk by its SPEC's query; nobody may write into it."""
    return make_walk(dict(part.split("=") for part in query.split("&") if part))


def foot(query: str = "", number: int = 0) -> Samples:
    """The samples of one foot of it."""
    return walk(query).recording.sensors[number]


def rows_of(tracker: Tracker) -> Floats:
    """All rows still there, a copy [n, 13]."""
    return tracker.rows.table(tracker.rows.start, tracker.rows.end)


def estimate(samples: Samples, settings: Settings = PAPERS, **changes: float | bool | str) -> Tracker:
    """The whole recording under these settings."""
    return track(samples, settings.with_changes(changes))


def samples_of(t_s: Floats, force_b: Floats, rate_b: Floats, field_b: Floats | None = None) -> Samples:
    """Samples from columns: times [n], force, rate and field [n, 3] or one [3] for all."""
    matrix = np.full((len(t_s), SAMPLE_WIDTH), np.nan)
    matrix[:, 0] = np.rint((t_s - t_s[0]) * 1e9)
    matrix[:, 1:4], matrix[:, 4:7] = force_b, rate_b
    if field_b is not None:
        matrix[:, 7:10] = field_b
    return Samples("foot", Role.FOOT, 0, matrix, np.zeros(len(t_s), np.uint16))


def still(seconds: float, rate_hz: float = 100.0, gravity: float = G) -> Samples:
    """A foot flat at rest."""
    return samples_of(
        np.arange(round(seconds * rate_hz)) / rate_hz, np.array([0.0, 0.0, -gravity]), np.zeros(3)
    )


def table_of(matrix: Floats) -> Blocks:
    """A matrix as a table of blocks."""
    table = Blocks(SAMPLE_WIDTH)
    table.extend(matrix)
    return table


def without(samples: Samples, begin_s: float, end_s: float) -> Samples:
    """The samples with a hole in time."""
    t_s = samples.matrix[:, 0] * 1e-9
    keep = (t_s < begin_s) | (t_s >= end_s)
    return Samples(samples.sensor, samples.role, 0, samples.matrix[keep], samples.saturation[keep])


def one_by_one(samples: Samples) -> list[Sample]:
    """The same samples as a live source yields them."""
    return [
        Sample(
            samples.sensor, i, int(row[0]), int(row[0]), tuple(row[1:4]), tuple(row[4:7]), tuple(row[7:10])
        )
        for i, row in enumerate(samples.matrix.tolist())
    ]
