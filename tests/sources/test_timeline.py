from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.motion.basics import Role
from app.motion.recording import Recording
from app.motion.samples import Samples
from app.sources.timeline import Timeline

STEPS = st.lists(st.integers(1, 50), min_size=0, max_size=20)


def samples(sensor: str, role: Role, start: int, steps: list[int]) -> Samples:
    matrix = np.random.default_rng(len(steps)).normal(size=(len(steps) + 1, 10))
    matrix[:, 0] = np.cumsum([0, *steps])
    matrix[::2, 7:] = np.nan
    return Samples(sensor, role, start, matrix, np.arange(len(matrix), dtype=np.uint16))


@given(st.integers(-50, 50), STEPS, STEPS, st.lists(st.integers(0, 45), max_size=5))
def test_cuts_join_to_all_samples_in_time_order(
    start: int, left_steps: list[int], right_steps: list[int], cuts: list[int]
) -> None:
    left, right = samples("left", Role.LEFT, 0, left_steps), samples("right", Role.RIGHT, start, right_steps)
    timeline = Timeline(Recording("x", "f", (left, right)))
    edges = sorted({0, len(timeline), *(min(cut, len(timeline)) for cut in cuts)})
    found = [s for a, b in pairwise(edges) for s in timeline.cut(a, b, 7)]
    assert len(found) == len(left) + len(right) == len(timeline)
    assert [s.device_ns for s in found] == sorted(s.device_ns for s in found)
    assert [s.device_ns - found[0].device_ns for s in found] == [
        timeline.elapsed_ns(i) for i in range(len(found))
    ]
    for foot in (left, right):
        own = [s for s in found if s.sensor == foot.sensor]
        assert [s.seq for s in own] == list(range(len(foot)))
        assert [s.saturation for s in own] == foot.saturation.tolist()
        np.testing.assert_array_equal(
            [(*s.specific_force_b, *s.angular_rate_b) for s in own], foot.matrix[:, 1:7]
        )
        assert [s.field_b for s in own] == [
            None if i % 2 == 0 else tuple(row) for i, row in enumerate(foot.matrix[:, 7:].tolist())
        ]
        assert {s.host_ns for s in own} == {7}


@given(STEPS, st.integers(-10, 1100))
def test_due_counts_the_samples_taken_by_then(steps: list[int], elapsed: int) -> None:
    foot = samples("foot", Role.FOOT, 10**18, steps)
    timeline = Timeline(Recording("x", "f", (foot,)))
    assert timeline.due(elapsed) == sum(e <= elapsed for e in foot.matrix[:, 0])
    assert timeline.duration_ns == sum(steps)
