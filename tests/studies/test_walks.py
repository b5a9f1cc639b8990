"""Fifty walks: Table 11's drifts and Table 10's spreads come back, with the right signs only."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.motion.estimate import ROW_WIDTH
from app.studies import walks
from app.studies.catalogue import STUDIES
from app.studies.late_start import SHORT, shortfall_m
from app.studies.monte_carlo import Errors, WalkConfig, footprints, ideal, walk_many
from app.studies.verdicts import Judge
from app.studies.walks import CASES, EAST, NORTH, BiasConfig
from app.studies.words import Done, Row, Verdict

#: Compiling beside other work takes minutes.
pytestmark = pytest.mark.timeout(600)

SMALL = replace(WalkConfig(), walks=4, strides=5)


def east_rows(config: BiasConfig) -> dict[str, Row]:
    _, truth = ideal(config, config.strides)
    found = {}
    for which in CASES:
        steps = walk_many(config, config.biased(which), config.strides, 1, range(config.walks))
        found[which] = walks.table_11(Judge("walk-bias"), which, steps[:, -1] - truth)[0]
    return found


def test_table_11_east_means() -> None:
    found = east_rows(BiasConfig())
    for which, within in {"force": 0.04, "rate": 0.03, "field": 0.04, "all": 0.03}.items():
        assert abs(found[which].got - found[which].printed) < within
        assert found[which].verdict is Verdict.REPRODUCED
        assert "signs" in found[which].needs


def test_the_wrong_signs_turn_table_11_to_not_reproduced() -> None:
    wrong = replace(BiasConfig(), walks=10, force_signs=(1.0, -1.0, -1.0), field_signs=(1.0, 1.0, 1.0))
    found = east_rows(wrong)
    assert {found[which].verdict for which in ("force", "field", "all")} == {Verdict.NOT_REPRODUCED}


def test_table_10_spreads_at_scale_1_and_a_spread_proportional_to_the_noise() -> None:
    config = WalkConfig()
    _, truth = ideal(config, config.strides)
    spread = {}
    for scale in (0.1, 1.0, 10.0):
        steps = walk_many(config, config.noise(scale), config.strides, 2, range(config.walks))
        spread[scale] = np.std(steps[:, -1] - truth, axis=0, ddof=1)
    assert spread[1.0][EAST] == pytest.approx(0.034, rel=0.3)
    np.testing.assert_allclose(spread[1.0], 10 * spread[0.1], rtol=0.1)
    np.testing.assert_allclose(spread[10.0][:2], 10 * spread[1.0][:2], rtol=0.2)


def test_without_errors_the_estimate_is_the_truth() -> None:
    config = WalkConfig()
    _, truth = ideal(config, 100)
    end = walk_many(config, Errors(), 100, 0, range(1))[0, -1]
    assert abs(end[NORTH] - truth[NORTH]) < 0.07
    assert abs(end[EAST] - truth[EAST]) < 1e-6


def test_how_the_walks_are_shared_out_changes_no_bit() -> None:
    together = walk_many(SMALL, SMALL.noise(1.0), 5, 0, range(4))
    apart = [walk_many(SMALL, SMALL.noise(1.0), 5, 0, range(k, k + 1)) for k in (3, 1, 0, 2)]
    np.testing.assert_array_equal(together[[3, 1, 0, 2]], np.concatenate(apart))
    assert len(np.unique(together[:, -1, EAST])) == 4


def test_a_missed_stride_is_no_number() -> None:
    config = replace(SMALL, threshold_radps=15.0)
    matrix, _ = ideal(config, 5)
    found = footprints(matrix, config.settings, 5, np.empty((len(matrix), ROW_WIDTH)))
    assert np.isnan(found).all()


@pytest.mark.parametrize("name", ["walk-noise", "walk-bias"])
def test_the_whole_study_on_few_walks(name: str) -> None:
    experiment = STUDIES[name]
    config = replace(experiment.config, walks=2)
    done = [Done(task.run(*task.arguments), 0.0) for task in experiment.tasks(config)]
    study = experiment.conclude(config, done)
    assert {row.study for row in study.rows} == {name}
    assert study.config["seed"] == 2012
    north = [row for row in study.rows if row.item.endswith("north mean")]
    assert {row.verdict for row in north} == {Verdict.NOT_REPRODUCED}
    assert all("back" in row.why for row in north)


def test_a_late_start_loses_what_the_papers_lost() -> None:
    assert shortfall_m(0) < 0.2
    assert shortfall_m(7) < 1.75 < 3.33 < shortfall_m(8)
    assert f"{shortfall_m(7):.1f} to {shortfall_m(8):.1f} m of 120 m" == SHORT
