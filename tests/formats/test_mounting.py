import itertools

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.formats.mounting import Axes, describe, parse_axes, rotation, snap, turn
from app.motion.basics import InputError

SIGNED = [sign + letter for letter in "xyz" for sign in ("", "-")]
RIGHT_HANDED = [
    ",".join(axes)
    for axes in itertools.product(SIGNED, repeat=3)
    if len({a[-1] for a in axes}) == 3
    and np.linalg.det([[(a[-1] == b) * (-1 if "-" in a else 1) for b in "xyz"] for a in axes]) > 0
]
FORCE = hnp.arrays(float, 3, elements=st.floats(-10, 10)).filter(lambda f: np.linalg.norm(f) > 0.1)


def write_axes(axes: Axes) -> str:
    """The inverse of ``parse_axes``."""
    return ",".join(("-" if sign < 0 else "") + "xyz"[index] for index, sign in axes)


def test_there_are_24_mountings() -> None:
    assert len(RIGHT_HANDED) == 24


@pytest.mark.parametrize("text", RIGHT_HANDED)
def test_axes_round_trip_and_rotate(text: str) -> None:
    axes = parse_axes(text)
    assert write_axes(axes) == text
    matrix = rotation(axes)
    np.testing.assert_array_equal(matrix @ matrix.T, np.eye(3))
    assert np.linalg.det(matrix) == pytest.approx(1.0)
    vectors = np.random.default_rng(0).normal(size=(5, 3))
    np.testing.assert_array_equal(turn(vectors, axes), vectors @ matrix.T)


@pytest.mark.parametrize(
    "text", ["", "x", "x,y", "x,y,z,x", "a,b,c", "x,x,z", "x,y,-z", "--x,y,z", "x,,z", "1,2,3"]
)
def test_bad_axes_are_one_line(text: str) -> None:
    with pytest.raises(InputError, match="^axes=.*") as error:
        parse_axes(text)
    assert "\n" not in str(error.value)


@given(FORCE)
def test_snapping_puts_gravity_down_by_a_proper_rotation(force: np.ndarray) -> None:
    axes = snap(force)
    assert write_axes(axes) in RIGHT_HANDED
    assert turn(force[None], axes)[0, 2] == -np.abs(force).max()


@given(FORCE)
def test_snapping_twice_changes_nothing_more(force: np.ndarray) -> None:
    sizes = np.sort(np.abs(force))
    assume(sizes[1] < sizes[2])
    assert snap(turn(force[None], snap(force))[0])[2] == (2, 1)


@pytest.mark.parametrize(
    ("force", "axes"),
    [
        ((0, 0, -9.8), "x,y,z"),
        ((0, 0, 9.8), "x,-y,-z"),
        ((0, 9.8, 0), "x,z,-y"),
        ((0, -9.8, 0), "x,-z,y"),
        ((9.8, 0, 0), "z,y,-x"),
        ((-9.8, 0, 0), "-z,y,x"),
    ],
)
def test_upright_sensors(force: tuple[float, ...], axes: str) -> None:
    assert write_axes(snap(np.array(force, float))) == axes


@pytest.mark.parametrize("tilt_deg", [-70, -50, -40, 0, 40, 50, 60])
def test_the_toe_stays_on_the_side_x_leans_to(tilt_deg: float) -> None:
    """A sensor z-up whose x dips by ever more: the toe is always ahead, never behind."""
    tilt = np.radians(tilt_deg)
    up = np.array([-np.sin(tilt), 0.0, np.cos(tilt)])
    forward = np.array([np.cos(tilt), 0.0, np.sin(tilt)])
    assert (rotation(snap(9.8 * up)) @ forward)[0] > 0.6


def test_described_in_words() -> None:
    assert describe(parse_axes("x,-y,-z")) == "toe = x, right = −y, down = −z"
