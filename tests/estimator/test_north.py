"""North: a steady field holds the heading, a bent one never turns it, and no field is no matter."""

from __future__ import annotations

import math

import numpy as np

from app.estimator.smoother import smooth
from app.estimator.tracker import Tracker
from app.motion.basics import Floats
from app.motion.samples import Column, Samples
from app.rotation import yaw_of
from app.settings import BUILT_IN
from tests.estimator.scoring import rmse
from tests.estimator.test_floor import rotated
from tests.estimator.walks import foot, rows_of, table_of, walk

DEFAULT = BUILT_IN["default"]
BLIND = DEFAULT.with_changes({"steady_north": False})
#: Five minutes on a large eight; the gyro's bias comes with time, so that no rest can tell it.
QUERY = "path=eight&size_m=40&strides=300&stride_m=1.3&rate_hz=100"
DRIFT_RADPS = 0.001


def drifting(field_n: Floats | None = None) -> tuple[Samples, Floats]:
    """The walk with a gyro that drifts, in the earth's field and this one [n, 3] µT besides."""
    samples = foot(QUERY)
    t_s = samples.matrix[:, 0] * 1e-9
    position_n, q_nb = walk(QUERY).truth(samples.sensor, t_s)
    matrix = samples.matrix.copy()
    matrix[:, Column.WX + 2] += DRIFT_RADPS * t_s / t_s[-1]
    if field_n is not None:
        matrix[:, Column.MX :] += rotated(q_nb * [1.0, -1.0, -1.0, -1.0], field_n)
    return Samples("foot", samples.role, 0, matrix, samples.saturation), position_n


def errors_m(samples: Samples, truth: Floats, hindsight: bool = False) -> tuple[float, float]:
    """RMSE with the field and without."""
    found = []
    for settings in (DEFAULT, BLIND):
        tracker, table = Tracker(settings), table_of(samples.matrix)
        tracker.advance(table)
        if hindsight:
            smooth(tracker, table)
        found.append(rmse(rows_of(tracker)[:, :3], truth))
    return found[0], found[1]


def test_a_steady_field_holds_the_heading_of_a_gyro_that_drifts() -> None:
    samples, truth = drifting()
    for hindsight, share in ((False, 0.7), (True, 0.5)):
        held, blind = errors_m(samples, truth, hindsight)
        assert held < share * blind


def test_a_bent_field_turns_nothing() -> None:
    truth = drifting()[1]
    bent = np.zeros_like(truth)
    for place in truth[:: len(truth) // 200]:  # a magnet at every other stride
        away = truth - (place + [0.0, 0.7, 0.3])
        bent += 12.0 * np.array([1.0, 0.0, 0.5]) / np.maximum(np.linalg.norm(away, axis=1), 0.3)[:, None] ** 3
    samples, _ = drifting(bent)
    held, blind = errors_m(samples, truth)
    assert held == blind


def test_another_place_whose_field_is_steady_but_turned_does_little() -> None:
    truth = drifting()[1]
    turn = np.radians(20.0) / (1.0 + np.exp(-truth[:, 0]))  # beyond x = 0, over some metres
    flat = 20.0
    bent = np.column_stack([flat * (np.cos(turn) - 1.0), flat * np.sin(turn), 0.0 * turn])
    samples, _ = drifting(bent)
    held, blind = errors_m(samples, truth)
    assert held < 1.1 * blind


def test_a_heading_that_was_knocked_beyond_its_account_is_caught_again() -> None:
    """A turn that the gyro felt and the foot never made: a hundred steady footprints in a row say so."""
    samples, _ = drifting()
    t_s = samples.matrix[:, 0] * 1e-9
    samples.matrix[:, Column.WX + 2] += 0.5 * ((t_s > 60.0) & (t_s < 61.0))
    true = yaw_of(tuple(walk(QUERY).truth("foot", t_s[-1:])[1][0].tolist()))
    off = []
    for settings in (DEFAULT, BLIND):
        tracker = Tracker(settings)
        tracker.advance(table_of(samples.matrix))
        turn = yaw_of(tuple(rows_of(tracker)[-1, 6:10].tolist())) - true
        off.append(abs(math.remainder(turn, math.tau)))
    assert off[0] < 0.1
    assert off[1] > 0.4


def test_the_card_says_what_the_field_does() -> None:
    samples, _ = drifting()
    for settings, holds in ((DEFAULT, True), (BLIND, False)):
        tracker = Tracker(settings)
        tracker.advance(table_of(samples.matrix))
        assert tracker.compass is not None
        assert tracker.compass.steady
        assert tracker.compass.holds == holds


def test_the_start_heading_turns_a_held_walk_as_a_whole() -> None:
    samples, _ = drifting()
    ways = []
    for angle in (0.0, 2.0):
        tracker = Tracker(DEFAULT.with_changes({"start_heading_rad": angle}))
        tracker.advance(table_of(samples.matrix))
        ways.append(rows_of(tracker)[:, :2])
    c, s = math.cos(2.0), math.sin(2.0)
    assert np.allclose(ways[1], ways[0] @ np.array([[c, s], [-s, c]]), atol=1e-6)


def test_no_field_is_as_if_none_were_asked_for() -> None:
    samples = foot(QUERY)
    blind = samples.matrix.copy()
    blind[:, Column.MX :] = np.nan
    ways = []
    for settings in (DEFAULT, BLIND):
        tracker = Tracker(settings)
        tracker.advance(table_of(blind))
        ways.append(rows_of(tracker))
    assert np.array_equal(ways[0], ways[1])
