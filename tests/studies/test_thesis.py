"""Um's method: right where his assumptions hold, and his phases told apart."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.studies import heading, stairs
from app.studies.experiments import Case, Outcome, walk_case
from app.studies.heading import straight, turning
from app.studies.legs import Sensor
from app.studies.thesis import Phase, swing_windows, travelled
from app.studies.thesis import heading as heading_of
from app.studies.words import Done, Verdict

#: Compiling beside other work takes minutes.
pytestmark = pytest.mark.timeout(600)

CLEAN = Sensor(noise=0.0, bias=0.0)


def outcome(
    legs: tuple, quantity: str = "distance", sensor: Sensor = CLEAN, compensate: bool = True
) -> Outcome:
    return walk_case(Case("x", "1", 1.0, quantity, legs, 0.55, compensate), sensor, 3)


def test_without_errors_a_straight_walk_has_its_length() -> None:
    for method, walked in outcome(straight(12.0, 10)).by.items():
        assert walked.distance_m == pytest.approx(12.0, rel=0.015), method
        assert walked.steps == 10, method


@pytest.mark.parametrize("turns", [1, 2, 4])
def test_turns_are_found_by_every_method(turns: int) -> None:
    for method, walked in outcome(turning(turns), "turned").by.items():
        assert walked.turned_deg == pytest.approx(90.0 * turns, abs=3.0), method


def test_the_compensation_takes_out_a_constant_error() -> None:
    t = np.linspace(0.0, 0.4, 41)
    error = np.tile([0.5, -0.2, 0.1], (41, 1))
    np.testing.assert_allclose(travelled(t, error, compensate=True), 0.0, atol=1e-12)
    np.testing.assert_allclose(travelled(t, error, compensate=False), 0.5 * error[0] * 0.4**2, rtol=1e-9)


def test_windows_join_over_short_gaps_and_leave_out_blips() -> None:
    t = np.linspace(0.0, 3.98, 200)
    rate = np.zeros(200)
    rate[20:30], rate[33:45] = 2.0, 2.0  # one swing with a gap of 60 ms
    rate[100:103] = 2.0  # a blip
    assert swing_windows(t, rate, 0.5) == [(20, 45)]


def test_drift_in_straight_swings_is_not_taken_for_a_turn() -> None:
    t = np.linspace(0.0, 19.98, 1000)
    windows = [(100, 130), (160, 190), (400, 430)]
    drift = np.full(1000, math.radians(0.5))
    turn = drift.copy()
    turn[400:430] += math.radians(90.0) / 0.6
    still, phases = heading_of(t, drift, windows)
    assert still == 0.0
    turned, with_turn = heading_of(t, turn, windows)
    assert math.degrees(turned) == pytest.approx(90.0, abs=5.0)
    assert phases[110] == Phase.SWING
    assert with_turn[410] == Phase.TURNING_SWING
    assert phases[50] == Phase.INITIAL
    assert phases[140] == Phase.INITIAL
    assert Phase.STANCE in heading_of(t, drift, [(100, 130), (140, 190)])[1]


def test_every_line_of_the_thesis_has_a_row_without_data() -> None:
    config = stairs.Config()
    done = [Done(task.run(*task.arguments), 0.0) for task in stairs.tasks(config)]
    study = stairs.conclude(config, done)
    assert len(study.rows) == 10
    assert {row.verdict for row in study.rows} == {Verdict.NO_DATA}
    for line in study.tables[0].lines:
        true, _, *found = (float(v) for v in line[1:])
        assert all(abs(f - true) < 0.12 for f in found), line


def test_the_tables_of_level_walks_are_whole() -> None:
    tables = [case.item.split(",")[0] for case in heading.cases(heading.Config())]
    counts = {name: tables.count(name) for name in dict.fromkeys(tables)}
    assert counts == {
        "Table 2": 3, "Table 3": 5, "Table 4": 5, "Table 5": 7, "IV-B: 150 m": 1, "Table 8": 4, "Table 9": 3,
        "Table 10": 4, "Table 11": 3,
    }  # fmt: skip


def test_the_study_of_headings_tells_all_methods() -> None:
    config = heading.Config()
    tasks = heading.tasks(config)
    few = [tasks[k] for k in (0, 3, 21, 25, -1)]  # 25: Table 9
    study = heading.conclude(config, [Done(task.run(*task.arguments), 0.0) for task in few])
    assert len(study.rows) == 4
    assert len(study.tables[0].lines) == 5
    assert {curve.label for curve in study.plots[0].curves} == {"truth", "papers", "Kalman"}
    assert set(study.plots[2].curves[0].y) == {0.0, 1.0, 2.0, 3.0}
