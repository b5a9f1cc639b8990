"""Steps: all are found where γ is set back, and too many where it is not, as the papers print it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.studies import gait
from app.studies.gait import STEPS, Config, count_literally, count_steps, slide
from app.studies.words import Done, Study, Verdict


@pytest.fixture(scope="module")
def study() -> Study:
    config = Config()
    return gait.conclude(config, [Done(task.run(*task.arguments), 0.0) for task in gait.tasks(config)])


def test_table_3_every_step_is_found(study: Study) -> None:
    rows = [row for row in study.rows if row.item.startswith("Table 3")]
    assert [row.got for row in rows] == [float(n) for n in STEPS]
    assert {row.verdict for row in rows} == {Verdict.NO_DATA}


def test_the_printed_pseudo_code_finds_too_many(study: Study) -> None:
    rows = {row.item: row for row in study.rows}
    kept = rows["Fig. 12, γ set back: steps found in 100 of a smooth foot"]
    literal = rows["Fig. 12, to the letter: steps found in 100 of a smooth foot"]
    assert kept.verdict is Verdict.REPRODUCED
    assert literal.verdict is Verdict.NOT_REPRODUCED
    assert literal.got > 150
    assert "γ" in literal.why


@given(st.lists(st.tuples(st.integers(6, 30), st.integers(6, 30)), max_size=20))
def test_clean_swings_are_counted_once(phases: list[tuple[int, int]]) -> None:
    parts = [np.concatenate([np.zeros(rest), np.full(swing, 5.0)]) for rest, swing in phases]
    signal = np.concatenate([*parts, np.zeros(10)])
    assert count_steps(signal, 1.0, 0.06, 0.02) == len(phases)
    assert count_literally(signal, 1.0, 3) == len(phases)


def test_a_flicker_of_one_sample_counts_for_the_printed_one_only() -> None:
    swing = np.full(20, 5.0)
    swing[10] = 0.5
    signal = np.concatenate([np.zeros(20), swing, np.zeros(20)])
    assert count_steps(signal, 1.0, 0.06, 0.02) == 1
    twice = np.concatenate([signal, signal])
    assert count_literally(twice, 1.0, 3) > 2


def test_an_uncorrected_slide_runs_away_as_half_bias_t_squared() -> None:
    made = slide(Config(noise=0.0), 2.0, 5)
    drift = made.raw_mps[-1] / 15.0
    assert made.raw_m == pytest.approx(2.0 + 0.5 * drift * 15.0**2, abs=1e-3)
    assert made.corrected_m == pytest.approx(2.0, abs=1e-3)


def test_table_2_in_shape(study: Study) -> None:
    rows = {row.item: row for row in study.rows}
    for metres in (1, 2, 3):
        assert abs(rows[f"Table 2, {metres} m, corrected"].got - metres) < 0.03
        assert abs(rows[f"Table 2, {metres} m, uncorrected"].got - metres) > 0.5
