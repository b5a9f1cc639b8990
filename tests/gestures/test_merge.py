"""Two feet merged by their stamps, and what counts as a change."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.gestures.merge import changes, readings
from app.gestures.words import Decision, standing
from app.motion.basics import MotionId, Role
from app.motion.samples import SAMPLE_WIDTH, Samples

stamps = st.lists(st.integers(0, 10**9), unique=True, max_size=30).map(sorted)


def samples(role: Role, device_ns: int, elapsed: list[int]) -> Samples:
    matrix = np.zeros((len(elapsed), SAMPLE_WIDTH))
    matrix[:, 0] = elapsed
    matrix[:, 4] = np.arange(len(elapsed))
    return Samples(role.value, role, device_ns, matrix, np.zeros(len(elapsed), np.uint16))


@given(stamps, stamps, st.integers(0, 2**61))
def test_every_sample_comes_once_in_the_order_of_time(a: list[int], b: list[int], start: int) -> None:
    feet = {Role.LEFT: samples(Role.LEFT, start, a), Role.RIGHT: samples(Role.RIGHT, start + 7, b)}
    merged = list(readings(feet))
    assert [r.t_ns for r in merged] == sorted([start + t for t in a] + [start + 7 + t for t in b])
    for role, elapsed in ((Role.LEFT, a), (Role.RIGHT, b)):
        assert [r.angular_rate_b[0] for r in merged if r.foot is role] == list(range(len(elapsed)))


def test_each_reading_has_its_own_orientation() -> None:
    feet = {Role.LEFT: samples(Role.LEFT, 0, [0, 10]), Role.RIGHT: samples(Role.RIGHT, 0, [5])}
    turned = {Role.LEFT: np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0]]), Role.RIGHT: np.array([[0, 0, 0, 1.0]])}
    assert [r.q_nb for r in readings(feet, turned)] == [(1, 0, 0, 0), (0, 0, 0, 1), (0, 1, 0, 0)]


def test_another_reason_alone_is_no_change() -> None:
    forward = Decision(3, MotionId.FORWARD, 1.0, 0.0, 0.9, True, 1.0, "both feet march")
    said = [
        standing(1, "a"),
        standing(2, "b"),
        forward,
        forward._replace(t_ns=4, reason="still"),
        standing(5, "a"),
    ]
    assert [d.t_ns for d in changes(said)] == [3, 5]
