"""The floor: an even one is even, stairs and ramps are not flattened, and the place below is not moved."""

from __future__ import annotations

import numpy as np
import pytest

from app.estimator.floor import LEVEL_SLOPE
from app.estimator.smoother import smooth
from app.estimator.tracker import Tracker
from app.motion.basics import Floats
from app.motion.samples import Samples
from app.settings import BUILT_IN
from tests.estimator.walks import foot, rows_of, samples_of, table_of, walk

DEFAULT = BUILT_IN["default"].with_changes({"sensor_height_m": 0.0})
FREE = DEFAULT.with_changes({"same_floor_m": 0.0})
NOISY = "rate_hz=200&noise=2&seed=7"


def rotated(q_nb: Floats, vectors: Floats) -> Floats:
    w, u = q_nb[:, :1], q_nb[:, 1:]
    t = 2.0 * np.cross(u, vectors)
    turned: Floats = vectors + w * t + np.cross(u, t)
    return turned


def uphill(query: str, slope: float) -> Samples:
    """A straight walk whose every swing rises by a share of its way: what a ramp adds to the force."""
    samples = foot(query)
    q_nb = walk(query).truth(samples.sensor, samples.matrix[:, 0] * 1e-9)[1]
    force_n = rotated(q_nb, samples.matrix[:, 1:4])
    force_n[:, 2] -= slope * force_n[:, 0]
    force_b = rotated(q_nb * [1.0, -1.0, -1.0, -1.0], force_n)
    return samples_of(samples.matrix[:, 0] * 1e-9, force_b, samples.matrix[:, 4:7])


def risen_m(samples: Samples, hindsight: bool, free: bool = False) -> float:
    tracker = Tracker(FREE if free else DEFAULT)
    table = table_of(samples.matrix)
    tracker.advance(table)
    if hindsight:
        smooth(tracker, table)
    rows = rows_of(tracker)
    return -float(rows[-1, 2] - rows[0, 2])


@pytest.mark.parametrize("hindsight", [False, True])
def test_a_level_walk_ends_at_its_height(hindsight: bool) -> None:
    samples = foot(f"strides=40&{NOISY}")
    tilted = samples.matrix.copy()
    tilted[:, 1] += 0.15  # an accelerometer's bias, which a still start takes for a tilt
    biased = Samples("foot", samples.role, 0, tilted, samples.saturation)
    assert abs(risen_m(biased, hindsight, free=True)) > 0.10
    assert abs(risen_m(biased, hindsight)) < 0.02


@pytest.mark.parametrize("hindsight", [False, True])
def test_stairs_keep_their_height(hindsight: bool) -> None:
    query = f"path=stairs&strides=20&{NOISY}"
    samples = foot(query)
    truth = walk(query).truth(samples.sensor, samples.matrix[-1:, 0] * 1e-9)[0]
    true_m = -float(truth[0, 2])
    assert true_m > 2.0
    assert risen_m(samples, hindsight) == pytest.approx(true_m, abs=0.05)


@pytest.mark.parametrize("hindsight", [False, True])
def test_a_ramp_is_found_after_some_strides(hindsight: bool) -> None:
    query = "strides=40&stride_m=1.2&rate_hz=100"
    way_m = 40 * 1.2
    for slope in (0.04, -0.08):
        found = risen_m(uphill(query, slope), hindsight)
        assert found == pytest.approx(slope * way_m, abs=8 * 1.2 * abs(slope))
    assert abs(risen_m(uphill(query, 0.5 * LEVEL_SLOPE), hindsight)) < 0.05


def test_the_floor_leaves_the_way_as_it_is() -> None:
    samples = foot(f"strides=40&{NOISY}")
    ways = []
    for settings in (DEFAULT, FREE):
        tracker = Tracker(settings)
        tracker.advance(table_of(samples.matrix))
        ways.append(rows_of(tracker)[:, :2])
    assert np.abs(ways[0] - ways[1]).max() < 0.05


def test_hindsight_leaves_no_seam_where_a_floor_begins() -> None:
    samples = foot(f"path=stairs&strides=12&{NOISY}")
    tracker, table = Tracker(DEFAULT), table_of(samples.matrix)
    tracker.advance(table)
    smooth(tracker, table)
    rows = rows_of(tracker)
    steps = np.diff(rows[:, 2])
    expected = 0.5 * (rows[:-1, 5] + rows[1:, 5]) / 200
    assert np.abs(steps - expected).max() < 0.01
