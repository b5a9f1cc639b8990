"""Moving the world is moving the camera: laws, with SciPy as second opinion."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.scene.mover_view import beacon, in_view

angles, metres = st.floats(-4.0, 4.0), st.floats(-130.0, 130.0)


def seen(north: float, east: float, heading: float, eye: float, point_n: list[float]) -> np.ndarray:
    """Where a point of the town appears to a camera at the origin: right, ahead, up."""
    (w, x, y, z), position = in_view(north, east, heading, eye)
    return np.asarray(Rotation.from_quat([x, y, z, w]).apply(point_n) + position)


@given(metres, metres, angles, st.floats(0.5, 2.5), st.floats(0.1, 90.0), st.floats(-40.0, 40.0))
def test_what_is_ahead_and_to_the_right_is_seen_there(
    north: float, east: float, heading: float, eye: float, ahead: float, right: float
) -> None:
    c, s = math.cos(heading), math.sin(heading)
    point = [north + ahead * c - right * s, east + ahead * s + right * c, 0.0]
    np.testing.assert_allclose(seen(north, east, heading, eye, point), [right, ahead, -eye], atol=1e-6)


@given(metres, metres, angles)
def test_the_pose_is_a_rotation_and_the_eye_is_at_the_origin(
    north: float, east: float, heading: float
) -> None:
    q, _ = in_view(north, east, heading, 1.65)
    assert math.hypot(*q) == pytest.approx(1.0)
    np.testing.assert_allclose(seen(north, east, heading, 1.65, [north, east, -1.65]), 0.0, atol=1e-9)


def test_a_beacon_stands_on_the_ground() -> None:
    assert beacon(1.5)[:4] == b"glTF"
