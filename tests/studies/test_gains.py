"""Gains: one for the whole stride ruins a walk, the valley of two is flat, and the surface is the sweep's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.estimator.tracker import track
from app.settings import Settings
from app.simulate.options import WalkOptions
from app.simulate.walk import simulate
from app.studies import gains
from app.studies.gains import GAINS_STANCE, GAINS_SWING, Config, Surface
from app.studies.words import Done, Study, Verdict

#: Compiling beside other work takes minutes.
pytestmark = pytest.mark.timeout(600)


@pytest.fixture(scope="module")
def study() -> Study:
    config = replace(Config(), walks=1, straight_walks=4)
    return gains.conclude(config, [Done(task.run(*task.arguments), 0.0) for task in gains.tasks(config)])


def test_a_constant_gain_costs_more_than_a_tenth_of_the_way(study: Study) -> None:
    row = study.rows[0]
    assert 12.0 < row.got < 17.0
    assert row.verdict is Verdict.CLOSE
    assert "grid" in row.why


def test_measured_tables_have_no_data(study: Study) -> None:
    assert {row.verdict for row in study.rows[1:]} == {Verdict.NO_DATA}
    assert study.rows[1].got == 0.0  # k_d


def test_the_adaptive_gain_gets_the_lap_right(study: Study) -> None:
    (_, distance, adaptive, *constant), *_ = study.tables[0].lines
    assert float(adaptive) < 0.01 * float(distance)
    assert max(float(c) for c in constant) > 10 * float(adaptive)


def test_the_surface_is_the_live_estimate() -> None:
    samples = simulate(WalkOptions(path="square", laps=1, noise=1.0)).recording.sensors[0]
    found: Surface = gains.survey("square", True, samples, Settings())
    assert found.fine_m.shape == (len(GAINS_STANCE), len(GAINS_SWING))
    live = track(samples, Settings(gain_stance=float(GAINS_STANCE[5]), gain_swing=0.0))
    end = live.rows.table(live.rows.end - 1, live.rows.end)[0]
    assert found.fine_m[5, 0] == float(np.hypot(end[0], end[1]))
    assert found.adaptive_m == pytest.approx(found.fine_m[9, 0], rel=1e-9)


def test_recorded_walks_join_the_table_but_not_the_rows() -> None:
    samples = simulate(WalkOptions(path="square", laps=1, noise=1.0)).recording.sensors[0]
    config = replace(Config(), walks=1, straight_walks=2)
    tasks = [*gains.tasks(config), *gains.recorded_tasks({"mine": samples})]
    found = gains.conclude(config, [Done(task.run(*task.arguments), 0.0) for task in tasks])
    assert [line[0] for line in found.tables[0].lines] == ["lap 1", "mine"]
    assert sum(row.item.startswith("Table 13") for row in found.rows) == 2
