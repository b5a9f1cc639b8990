"""A foot's last seconds as the plot has them: the walk's rows, thinned, on the clock all sensors share."""

from __future__ import annotations

import numpy as np
import pytest

from app.blocks import BLOCK
from app.clocks import FixedClock
from app.graphs import GRAPH_POINTS, GRAPH_S
from app.motion.estimate import VELOCITY, RowColumn
from app.motion.samples import ClockLine
from app.motion.snapshot import Graph
from app.session import Session
from tests.estimator.walks import PAPERS
from tests.sessions import LONG, fed, main_rows

#: Ten seconds are every third of 800 rows, and reach over the end of a block, which three does not divide.
RATE_HZ = 80.0
WALK = [sample._replace(device_ns=i * 12_500_000) for i, sample in enumerate(LONG[: BLOCK + 310])]
COUNT = BLOCK + 300


def shown(graph: Graph) -> list[int]:
    """The rows that a graph shows, by their times."""
    numbers = np.rint(graph.t_s * RATE_HZ).astype(int)
    np.testing.assert_allclose(graph.t_s, numbers / RATE_HZ, rtol=0, atol=1e-9)
    return [int(number) for number in numbers]


def test_every_point_is_a_row_at_its_time() -> None:
    session = fed(Session(PAPERS), WALK[:COUNT])
    graph = session.snapshot().graphs["foot"]
    rows = main_rows(session)[shown(graph)]
    assert np.array_equal(graph.statistic, rows[:, RowColumn.STATISTIC])
    assert np.array_equal(graph.threshold, rows[:, RowColumn.THRESHOLD])
    assert np.array_equal(graph.swing, rows[:, RowColumn.PHASE])
    assert set(graph.swing) == {0.0, 1.0}
    assert np.array_equal(graph.height_m, -rows[:, RowColumn.DOWN])
    np.testing.assert_allclose(graph.speed_mps, np.sqrt((rows[:, VELOCITY] ** 2).sum(axis=1)), atol=1e-12)


def test_it_is_evenly_thinned_and_ten_seconds_long() -> None:
    graph = fed(Session(PAPERS), WALK[:COUNT]).snapshot().graphs["foot"]
    numbers = shown(graph)
    apart = set(np.diff(numbers))
    assert len(apart) == 1
    step = apart.pop()
    assert GRAPH_POINTS * (step - 1) < GRAPH_S * RATE_HZ <= GRAPH_POINTS * step
    assert COUNT - 1 - step < numbers[-1] < COUNT
    first = COUNT - 1 - round(GRAPH_S * RATE_HZ)
    assert first <= numbers[0] < first + step


def test_the_same_rows_are_shown_from_one_graph_to_the_next() -> None:
    session = fed(Session(PAPERS), WALK[:COUNT])
    before = shown(session.snapshot().graphs["foot"])
    for sample in WALK[COUNT:]:
        session.take(sample)
        now = shown(session.snapshot().graphs["foot"])
        assert set(now) - set(before) <= set(range(before[-1] + 1, len(WALK)))


def test_its_times_are_on_the_clock_that_all_sensors_share() -> None:
    lines = {"left": ClockLine(0, 5_000_000_000, 0.0), "right": ClockLine(0, 7_000_000_000, 0.01)}
    session = Session(PAPERS, clock=lambda sensor: FixedClock(lines[sensor]))
    for sample in WALK[:240]:
        for sensor in lines:
            session.take(sample._replace(sensor=sensor))
    left, right = (session.snapshot().graphs[sensor].t_s for sensor in lines)
    assert (left[0], left[-1]) == pytest.approx((0.0, 239 / RATE_HZ), abs=1e-9)
    assert (right[0], right[-1]) == pytest.approx((2.0, 2.0 + 1.01 * 239 / RATE_HZ), abs=1e-9)
