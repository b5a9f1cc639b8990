from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from app.motion.basics import Role
from app.scene import private, shoe
from app.scene.colours import FOOT
from app.scene.page import Scene

ROOT = Path(__file__).parents[2]


def test_the_sole_stands_on_the_floor() -> None:
    lowest = max(float(vertices[:, 2].max()) for vertices, _ in shoe.parts(False).values())
    assert lowest == pytest.approx(shoe.SENSOR_HEIGHT_M, abs=1e-6)


def test_it_is_as_large_as_a_shoe_and_light_to_draw() -> None:
    vertices = np.concatenate([v for v, _ in shoe.parts(False).values()])
    length, width, height = np.ptp(vertices, axis=0)
    assert 0.28 < length < 0.32
    assert 0.08 < width < 0.12
    assert 0.10 < height < 0.16
    assert sum(len(faces) for _, faces in shoe.parts(False).values()) < 3000


def test_the_toe_is_ahead_and_the_sensor_in_the_origin() -> None:
    upper, sensor = shoe.parts(False)["toe_cap"][0], shoe.parts(False)["sensor"][0]
    assert upper[:, 0].min() > 0.05
    assert np.allclose((sensor.max(axis=0) + sensor.min(axis=0)) / 2, 0.0, atol=1e-4)


def test_the_big_toe_is_on_the_inside() -> None:
    """Seen from above, a right shoe's tip lies left of its middle; the left one is its mirror image."""
    right, left = shoe.parts(False)["outsole"][0], shoe.parts(True)["outsole"][0]
    tip = right[right[:, 0] > right[:, 0].max() - 0.01]
    assert tip[:, 1].mean() < -0.002
    assert np.allclose(left, right * [1, -1, 1])


def test_mirrored_faces_still_face_outward() -> None:
    (v, f), (w, g) = shoe.parts(False)["sensor"], shoe.parts(True)["sensor"]
    volumes = [trimesh.Trimesh(a, b, process=False).volume for a, b in ((v, f), (w, g))]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-5)


@pytest.mark.parametrize("mirrored", [False, True])
def test_the_print_is_the_sole(mirrored: bool) -> None:
    vertices, faces = shoe.sole(mirrored)
    assert faces.max() == len(vertices) - 1
    outsole = shoe.parts(mirrored)["outsole"][0]
    assert np.ptp(vertices[:, 0]) == pytest.approx(np.ptp(outsole[:, 0]), abs=0.01)
    assert np.ptp(vertices[:, 1]) == pytest.approx(np.ptp(outsole[:, 1]), abs=0.002)


def test_the_script_makes_the_asset(tmp_path: Path) -> None:
    made_path = tmp_path / "shoe.npz"
    subprocess.run([sys.executable, str(ROOT / "tools/make_shoe.py"), str(made_path)], check=True)
    with np.load(made_path) as made, np.load(shoe.ASSET) as kept:
        assert set(made) == set(kept)
        assert all(np.allclose(made[name], kept[name], atol=1e-6) for name in made)


def test_small_steps_far_away_are_sent(scene: Scene) -> None:
    """viser's own setter calls half a millimetre at 200 m no move at all."""
    drawn = shoe.Shoe(scene._server.scene, "/ned/far", Role.FOOT)
    q = (1.0, 0.0, 0.0, 0.0)
    sent = []
    for i in range(20):
        drawn.pose(q, (200.0 + 0.0005 * i, 0.0, 0.0))
        positions = [
            m for m in private.broadcast_messages(scene._server) if type(m).__name__ == "SetPositionMessage"
        ]
        sent.append(next(m.position[0] for m in positions if m.name == "/ned/far"))
    assert np.allclose(np.diff(sent), 0.0005, atol=1e-9)


def test_paint_follows_the_foot() -> None:
    assert shoe.paint(FOOT[Role.LEFT])["upper"] == FOOT[Role.LEFT] != shoe.paint(FOOT[Role.RIGHT])["upper"]
