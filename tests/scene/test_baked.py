from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from app.scene.baked import BY_LAMP, BY_SKY, SHADE, apart, linear, lit, normals, ribbons


def box() -> tuple[np.ndarray, np.ndarray]:
    made = trimesh.creation.box((0.2, 0.3, 0.4))
    return made.vertices.astype(np.float32), made.faces.astype(np.uint32)


def test_linear_light_is_the_standards() -> None:
    assert np.allclose(linear((0, 0, 0)), 0.0)
    assert np.allclose(linear((255, 255, 255)), 1.0)
    assert np.allclose(linear((10, 128, 188)), [0.003035, 0.215861, 0.502886], atol=1e-6)  # sRGB tables


def test_normals_of_a_ball_point_out_of_it() -> None:
    ball = trimesh.creation.icosphere(subdivisions=2)
    mine = normals(ball.vertices.astype(np.float32), ball.faces.astype(np.uint32))
    assert np.allclose(mine, ball.vertices / np.linalg.norm(ball.vertices, axis=1)[:, None], atol=0.03)


def test_up_is_brighter_than_down_and_nothing_is_black_or_overexposed() -> None:
    vertices, faces = apart(*box())
    colours = lit(vertices, faces, (255, 255, 255))
    out = normals(vertices, faces)
    up, down = colours[out[:, 2] < -0.9], colours[out[:, 2] > 0.9]
    assert up.min() > 1.5 * down.max()
    assert colours.min() >= SHADE - 1e-6
    assert colours.max() <= SHADE + BY_SKY + BY_LAMP + 1e-6


def test_edges_of_a_box_taken_apart_are_sharp() -> None:
    vertices, faces = apart(*box())
    assert np.allclose(trimesh.Trimesh(vertices, faces, process=False).volume, 0.024, rtol=1e-5)
    assert np.allclose(np.abs(normals(vertices, faces)).max(axis=1), 1.0)


coordinates = st.floats(-20, 20, width=32)


@given(st.lists(st.tuples(coordinates, coordinates, coordinates, coordinates), min_size=1, max_size=8))
def test_a_ribbon_is_its_segment_with_a_width(ends: list[tuple[float, float, float, float]]) -> None:
    segments = np.array([[[a, b, 0.1], [c, d, 0.1]] for a, b, c, d in ends], np.float32)
    vertices, faces = ribbons(segments, 0.02)
    assert len(vertices) == 4 * len(segments)
    assert len(faces) == 2 * len(segments)
    assert np.array_equal(vertices[:, 2], np.repeat(segments[:, 0, 2], 4))
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    corner = vertices[faces].astype(np.float64)
    area = 0.5 * np.linalg.norm(
        np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1
    ).reshape(-1, 2).sum(axis=1)
    whole = length > 1e-3  # a point has no direction, hence no area
    assert np.allclose(area[whole], 0.02 * (length[whole] + 0.02), rtol=2e-3)


@pytest.mark.parametrize("wide_m", [0.01, 0.05])
def test_each_end_may_have_its_width(wide_m: float) -> None:
    vertices, _ = ribbons(
        np.array([[[0, 0, 0], [4, 0, 0]]], np.float32), np.array([[0.01, wide_m]], np.float32)
    )
    first, last = vertices[:2], vertices[2:]
    assert np.ptp(first[:, 1]) == pytest.approx(0.01)
    assert np.ptp(last[:, 1]) == pytest.approx(wide_m)
