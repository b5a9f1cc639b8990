"""The attitude study: the laws of the 2001 report, and what FQA and QUEST are said to do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import opinions
from app.studies import attitude
from app.studies.attitude import Config, errors_deg
from app.studies.motions import MOTIONS, Sensor
from app.studies.verdicts import Judge
from app.studies.words import Done, Study, Verdict

#: Compiling beside other work takes minutes.
pytestmark = pytest.mark.timeout(600)


def concluded(config: Config) -> Study:
    done = [Done(task.run(*task.arguments), 1e-3) for task in attitude.tasks(config)]
    return attitude.conclude(config, done)


@pytest.fixture(scope="module")
def study() -> Study:
    return concluded(Config())


def test_what_is_reproduced_and_what_is_not(study: Study) -> None:
    verdicts = {row.item: row.verdict for row in study.rows}
    assert all(v is Verdict.REPRODUCED for item, v in verdicts.items() if item.startswith("Eq. (12)"))
    assert verdicts["III-B: tilt error of FQA that a bent field adds"] is Verdict.REPRODUCED
    assert verdicts["III-B: angle from QUEST to TRIAD, two perfect vectors"] is Verdict.REPRODUCED
    assert verdicts["III-B: angle from QUEST to TRIAD, two noisy vectors"] is Verdict.NOT_REPRODUCED


def test_half_the_gain_turns_eq_12_to_not_reproduced(monkeypatch: pytest.MonkeyPatch) -> None:
    right = attitude.decay
    monkeypatch.setattr(attitude, "decay", lambda config, gain: right(config, 0.5 * gain))
    rows = attitude._convergence_rows(Judge("attitude"), Config())
    assert {row.verdict for row in rows} == {Verdict.NOT_REPRODUCED}


def test_every_method_is_scored_on_every_motion(study: Study) -> None:
    whole, vertical, cost = study.tables
    assert [line[0] for line in whole.lines] == list(attitude.METHODS)
    assert whole.head[1:] == tuple(MOTIONS)
    for table in (whole, vertical):
        assert all(0.0 < float(v) < 120.0 for line in table.lines for v in line[1:])
    assert all(float(line[1]) > 0.0 for line in cost.lines)
    assert "every" in study.config


def test_the_same_seed_gives_the_same_rows() -> None:
    small = replace(Config(), sensor=Sensor(rate_hz=25.0))
    assert concluded(small).rows == concluded(small).rows


def test_outside_opinions_agree_where_the_motion_is_gentle() -> None:
    tasks = opinions.tasks(Config())
    assert {task.arguments[0] for task in tasks} == set(MOTIONS)
    motion = MOTIONS["tilt table"](Sensor())
    for task in tasks:
        if task.arguments[0] == "tilt table":
            found = task.run(*task.arguments)
            whole, _ = errors_deg(motion, found.q_nb)
            assert np.sqrt(np.mean(whole**2)) < 2.0, found.method
