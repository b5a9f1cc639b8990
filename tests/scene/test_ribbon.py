"""A path as a ribbon: where it lies, how broad it is, that it is never twisted."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.scene import ribbon
from app.scene.glb import Part


def chain(points: np.ndarray) -> Part:
    made = np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)
    return ribbon._chain(made, np.zeros((1, 3), np.float32), 3.0)


def spiral(count: int = 60) -> np.ndarray:
    angle = np.linspace(0.0, 3 * math.pi, count)
    return np.stack([np.cos(angle), np.sin(angle), -0.1 * angle], axis=1)


def test_it_lies_about_its_path_level_and_as_broad_as_told() -> None:
    part = chain(spiral())
    left, right = part.vertices[::2], part.vertices[1::2]
    np.testing.assert_allclose(0.5 * (left + right), spiral(), atol=1e-6)
    np.testing.assert_allclose(left[:, 2], right[:, 2], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(right - left, axis=1), 3.0 * ribbon.WIDTH_M, rtol=1e-4)
    way = np.gradient(spiral(), axis=0)[:, :2]
    assert np.abs(((right - left)[:, :2] * way).sum(axis=1)).max() < 1e-3


def test_each_segment_is_two_triangles_and_its_edges() -> None:
    part = chain(spiral(61))
    area = trimesh.Trimesh(part.vertices, part.faces, process=False).area
    length = np.linalg.norm(np.diff(spiral(61), axis=0), axis=1).sum()
    assert area == pytest.approx(3.0 * ribbon.WIDTH_M * length, rel=0.02)
    assert part.faces.shape == (120, 3)
    assert part.lines is not None
    assert set(map(tuple, part.lines)) == {(k, k + 2) for k in range(120)}


@given(arrays(np.float32, (9, 3), elements=st.floats(-3, 3, width=16)))
def test_whatever_the_path_sides_are_level_units_that_never_turn_over(points: np.ndarray) -> None:
    across = ribbon.sides(points)
    np.testing.assert_allclose(np.linalg.norm(across, axis=1), 1.0, atol=1e-5)
    assert (across[:, 2] == 0.0).all()
    assert ((across[1:] * across[:-1]).sum(axis=1) > -1e-6).all()


def test_where_the_pen_was_up_nothing_is_drawn() -> None:
    one, two = spiral(8), spiral(8) + np.array([10.0, 0.0, 0.0])
    segments = np.concatenate([np.stack([p[:-1], p[1:]], axis=1) for p in (one, two)]).astype(np.float32)
    scene = trimesh.load_scene(io.BytesIO(ribbon.ribbon(segments, (0, 114, 178), 3.0)), file_type="glb")
    meshes = [mesh for mesh in scene.geometry.values() if isinstance(mesh, trimesh.Trimesh)]
    assert sum(len(mesh.faces) for mesh in meshes) == 2 * len(segments)
    assert max(np.ptp(mesh.triangles[..., 0], axis=1).max() for mesh in meshes) < 1.5


def test_the_script_has_its_numbers() -> None:
    assert "HALF_M" not in ribbon.script()
    assert "MOST_PIXELS" not in ribbon.script()
