"""Laws of rotations, and SciPy's Rotation as a second opinion (it counts xyzw)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from app import rotation
from app.motion.basics import Floats, Quaternion, Vector

NEAR = 1e-12


def numbers(size: float) -> st.SearchStrategy[float]:
    return st.floats(-size, size)


def vectors(size: float) -> st.SearchStrategy[Vector]:
    return st.tuples(numbers(size), numbers(size), numbers(size))


def quaternions() -> st.SearchStrategy[Quaternion]:
    parts = st.tuples(numbers(1.0), numbers(1.0), numbers(1.0), numbers(1.0))
    return parts.filter(lambda q: math.hypot(*q) > 0.1).map(rotation.normalise)


def scipys(q: Quaternion) -> Rotation:
    return Rotation.from_quat([q[1], q[2], q[3], q[0]])


def assert_same_turn(p: Quaternion, q: Quaternion) -> None:
    """q and −q are one rotation."""
    assert_allclose(np.array(p) * math.copysign(1.0, float(np.dot(p, q))), q, atol=NEAR)


@given(quaternions(), quaternions())
def test_closure(p: Quaternion, q: Quaternion) -> None:
    assert math.hypot(*rotation.multiply(p, q)) == pytest.approx(1.0, abs=NEAR)


@given(quaternions())
def test_identity(q: Quaternion) -> None:
    one = (1.0, 0.0, 0.0, 0.0)
    assert rotation.multiply(one, q) == q == rotation.multiply(q, one)


@given(quaternions())
def test_inverse(q: Quaternion) -> None:
    assert_allclose(rotation.multiply(q, rotation.conjugate(q)), (1.0, 0.0, 0.0, 0.0), atol=NEAR)


@given(quaternions(), quaternions(), quaternions())
def test_associativity(p: Quaternion, q: Quaternion, r: Quaternion) -> None:
    left = rotation.multiply(rotation.multiply(p, q), r)
    assert_allclose(left, rotation.multiply(p, rotation.multiply(q, r)), atol=NEAR)


@given(quaternions(), vectors(100.0))
def test_rotate_is_scipys(q: Quaternion, v: Vector) -> None:
    assert_allclose(rotation.rotate(q, v), scipys(q).apply(np.array(v)), atol=1e-10)


@given(quaternions(), quaternions(), vectors(100.0))
def test_a_product_turns_by_its_right_side_first(p: Quaternion, q: Quaternion, v: Vector) -> None:
    one_after_the_other = rotation.rotate(p, rotation.rotate(q, v))
    assert_allclose(rotation.rotate(rotation.multiply(p, q), v), one_after_the_other, atol=1e-10)


@given(quaternions(), quaternions())
def test_multiply_is_scipys(p: Quaternion, q: Quaternion) -> None:
    product: Floats = (scipys(p) * scipys(q)).as_quat()
    x, y, z, w = product
    assert_same_turn(rotation.multiply(p, q), (w, x, y, z))


@given(st.one_of(vectors(1e-3), vectors(3.0), vectors(1000.0)))
@example((0.0, 0.0, 0.0))
@example((1e-300, 0.0, 0.0))
@example((0.2 - 1e-9, 0.0, 0.0))  # either side of where the series ends
@example((0.2 + 1e-9, 0.0, 0.0))
@example((0.0, math.pi, 0.0))
@example((0.0, 0.0, 2 * math.pi))
def test_exponential_is_scipys(v: Vector) -> None:
    x, y, z, w = Rotation.from_rotvec(v).as_quat()
    q = rotation.exponential(v)
    assert math.hypot(*q) == pytest.approx(1.0, abs=NEAR)
    assert_same_turn(q, (w, x, y, z))


@given(vectors(2.0), st.floats(0.0, 1e-3))
def test_small_turns_are_exact_to_the_last_digits(axis: Vector, small: float) -> None:
    v = np.array(axis) * small
    assert_allclose(rotation.exponential((v[0], v[1], v[2]))[1:], v / 2, rtol=1e-6, atol=1e-300)


@given(numbers(math.pi - 1e-6), numbers(1.5), numbers(math.pi - 1e-6))
def test_yaw_pitch_roll_round_trip(yaw: float, pitch: float, roll: float) -> None:
    q = rotation.from_yaw_pitch_roll(yaw, pitch, roll)
    back = (rotation.yaw_of(q), rotation.pitch_of(q), rotation.roll_of(q))
    assert_allclose(back, (yaw, pitch, roll), atol=1e-9)


@given(numbers(10.0), numbers(10.0), numbers(10.0))
def test_yaw_pitch_roll_is_scipys(yaw: float, pitch: float, roll: float) -> None:
    x, y, z, w = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat()
    assert_same_turn(rotation.from_yaw_pitch_roll(yaw, pitch, roll), (w, x, y, z))


@pytest.mark.parametrize("pitch", [math.pi / 2, -math.pi / 2])
def test_straight_up_and_down_pitch_stays_a_number(pitch: float) -> None:
    q = rotation.from_yaw_pitch_roll(0.3, pitch, 0.0)
    assert rotation.pitch_of(q) == pytest.approx(pitch, abs=1e-7)


def test_signs_are_north_east_down() -> None:
    north = (1.0, 0.0, 0.0)
    assert_allclose(rotation.rotate(rotation.from_yaw(math.pi / 2), north), (0, 1, 0), atol=NEAR)
    toe_up = rotation.from_yaw_pitch_roll(0.0, math.pi / 2, 0.0)
    assert_allclose(rotation.rotate(toe_up, north), (0, 0, -1), atol=NEAR)
    right_side_down = rotation.from_yaw_pitch_roll(0.0, 0.0, math.pi / 2)
    assert_allclose(rotation.rotate(right_side_down, (0.0, 1.0, 0.0)), (0, 0, 1), atol=NEAR)


@given(numbers(math.pi), numbers(math.pi))
def test_turns_about_down_add(first: float, second: float) -> None:
    both = rotation.multiply(rotation.from_yaw(first), rotation.from_yaw(second))
    assert_same_turn(both, rotation.from_yaw(first + second))


def test_normalise_of_nothing_is_no_turn() -> None:
    assert rotation.normalise((0.0, 0.0, 0.0, 0.0)) == (1.0, 0.0, 0.0, 0.0)
