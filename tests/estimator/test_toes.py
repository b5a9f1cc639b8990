"""The toe's direction: found from strides of a sensor that looks elsewhere; odd steps do not fool it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.blocks import Blocks
from app.estimator.strides import Step
from app.estimator.toes import STRIDES, Toes
from app.estimator.tracker import Tracker
from app.motion.samples import Samples
from app.rotation import from_yaw, multiply, rotate, yaw_of
from app.settings import Settings
from tests.estimator.walks import foot, table_of

KALMAN = Settings(estimator="kalman", sensor_height_m=0.0)


def mounted(samples: Samples, turn_rad: float, tilt_rad: float = 0.0) -> Blocks:
    """The same walk as a sensor reads it that sits turned to the left on the shoe, and tilted."""
    matrix = samples.matrix.copy()
    half = 0.5 * tilt_rad
    q = multiply(from_yaw(turn_rad), (math.cos(half), math.sin(half), 0.0, 0.0))
    for first in (1, 4):
        matrix[:, first : first + 3] = [rotate(q, tuple(v)) for v in matrix[:, first : first + 3].tolist()]
    return table_of(matrix)


@pytest.mark.parametrize("query", ["strides=9&rate_hz=100", "strides=14&rate_hz=100&path=square&size_m=6"])
@pytest.mark.parametrize(("turn_rad", "tilt_rad"), [(1.5, 0.0), (-0.6, 0.3), (1.0, math.pi), (0.3, 0.0)])
def test_a_sensor_that_looks_elsewhere_is_found_out(query: str, turn_rad: float, tilt_rad: float) -> None:
    tracker, toes = Tracker(KALMAN), Toes()
    tracker.advance(mounted(foot(query), turn_rad, tilt_rad))
    toe = toes.look(tracker.steps, tracker.rows)
    assert toe is not None
    left_rad = -turn_rad if tilt_rad == math.pi else turn_rad  # upside down, what was left is right
    assert abs(math.remainder(toe.angle_rad - left_rad, math.tau)) < 0.05
    straight = Tracker(KALMAN)
    straight.advance(table_of(foot(query).matrix))
    row, true = (t.rows.table(t.rows.end - 1, t.rows.end)[0, 6:10].tolist() for t in (tracker, straight))
    shown = yaw_of(multiply(tuple(row), toe.q_bs))
    # its own north is where its x axis looks at the start
    assert abs(math.remainder(shown - left_rad - yaw_of(tuple(true)), math.tau)) < 0.06


def test_a_sensor_that_looks_along_the_toe_turns_nothing() -> None:
    tracker, toes = Tracker(KALMAN), Toes()
    tracker.advance(table_of(foot("strides=12&rate_hz=100").matrix))
    assert toes.look(tracker.steps, tracker.rows) is None


def steps(ways: list[float], heading_rad: float = 0.0, length_m: float = 1.2, gap_at: int = -1) -> list[Step]:
    """Strides each into its own direction, rad, while the sensor looks to ``heading_rad``."""
    made, place = [], np.zeros(2)
    for i, way in enumerate([0.0, *ways]):
        place = place + length_m * np.array([math.cos(way), math.sin(way)])
        where = (float(place[0]), float(place[1]))
        gap_s = 1.0 if i == gap_at else 0.0
        made.append(Step(i, i + 1.0, 0.5, length_m, where, i, i, heading_rad, gap_s, 0.0, 1e-3, 0.0))
    return made


def rows_for(count: int) -> Blocks:
    table = Blocks(13)
    rows = np.zeros((count, 13))
    rows[:, 6] = 1.0
    table.extend(rows)
    return table


def angle(ways: list[float], **rest: float) -> float | None:
    found = steps(ways, **rest)  # type: ignore[arg-type]
    toe = Toes().look(found, rows_for(len(found)))
    return toe.angle_rad if toe else None


def test_odd_steps_do_not_fool_it() -> None:
    ahead, back, aside = 0.5, 0.5 + math.pi, 0.5 + math.pi / 2
    assert angle([ahead] * STRIDES) == pytest.approx(0.5)
    assert angle([ahead] * (STRIDES - 1)) is None
    assert angle([back, ahead, aside, ahead, ahead, ahead, ahead]) == pytest.approx(0.5)
    assert angle([back, aside] * 6) is None
    assert angle([back] * STRIDES) is None
    assert angle([back] * 2 * STRIDES) == pytest.approx(math.remainder(back, math.tau))
    assert angle([ahead] * 9, length_m=0.2) is None
    assert angle([0.5 + 0.1 * (-1) ** k for k in range(9)]) == pytest.approx(0.5, abs=0.11)


def test_it_is_found_once_and_anew_after_a_gap() -> None:
    first = [0.5] * STRIDES + [1.5] * 20
    assert angle(first) == pytest.approx(0.5)
    assert angle(first, gap_at=STRIDES + 2) == pytest.approx(1.5)


def test_it_does_not_matter_when_it_is_looked_at() -> None:
    made = steps([0.5 + math.pi, 0.4, 0.6, 0.5, 0.45, 0.55, 0.5])
    rows, toes = rows_for(len(made)), Toes()
    for end in range(len(made) + 1):
        toe = toes.look(made[:end], rows)
    assert toe == Toes().look(made, rows)
