"""Sums of minimum-jerk steps: rest before and after, and derivatives that are derivatives."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.simulate.gestures_steps import Step, sum_of

a_step = st.builds(Step, st.floats(0.0, 5.0), st.floats(0.05, 2.0), st.floats(-1.0, 1.0))
some_steps = st.lists(a_step, max_size=8)


@given(some_steps)
def test_before_all_steps_is_nothing_and_after_them_their_sum(steps: list[Step]) -> None:
    course = sum_of(steps).at(np.array([8.0, -1.0]))
    np.testing.assert_allclose(course.value, [sum(s.size for s in steps), 0.0], atol=1e-12)
    np.testing.assert_array_equal(course.rate, 0.0)
    np.testing.assert_array_equal(course.acceleration, 0.0)


@given(some_steps)
def test_a_sum_is_the_sum_of_its_steps(steps: list[Step]) -> None:
    t = np.linspace(-0.5, 7.5, 83)
    together = sum_of(steps).at(t)
    for i, of_all in enumerate(together):
        alone = sum((sum_of([step]).at(t)[i] for step in steps), np.zeros(len(t)))
        np.testing.assert_allclose(of_all, alone, atol=1e-9)


@given(some_steps)
def test_rate_and_acceleration_are_derivatives(steps: list[Step]) -> None:
    t, h = np.linspace(-0.5, 7.5, 83), 1e-5
    course = sum_of(steps)
    before, now, after = course.at(t - h), course.at(t), course.at(t + h)
    np.testing.assert_allclose((after.value - before.value) / (2 * h), now.rate, atol=1e-3)
    np.testing.assert_allclose((after.rate - before.rate) / (2 * h), now.acceleration, atol=0.3)


@given(some_steps, st.integers(0, 2**32 - 1))
def test_the_order_of_the_instants_does_not_matter(steps: list[Step], seed: int) -> None:
    t = np.linspace(-0.5, 7.5, 40)
    mixed = np.random.default_rng(seed).permutation(40)
    for straight, other in zip(sum_of(steps).at(t), sum_of(steps).at(t[mixed]), strict=True):
        np.testing.assert_allclose(other, straight[mixed], atol=1e-12)
