from __future__ import annotations

import math
import time

import numpy as np
import pytest

from app.motion.basics import Role
from app.motion.snapshot import Footprint
from app.scene import footprints, meshes, private
from app.scene.footprints import GROUP, PRINTS, Footprints, finite, grouped, placed, same
from app.scene.page import Scene
from app.scene.shoe import sole


def steps(count: int, first: int = 0) -> tuple[Footprint, ...]:
    return tuple(Footprint(k, (1.2 * k, 0.1, 0.0), 0.02 * k) for k in range(first, first + count))


def test_a_print_lies_where_the_foot_stood() -> None:
    outline, _ = sole(False)
    print_n = placed(outline, Footprint(1, (3.0, -2.0, 0.0), 0.5 * math.pi))
    assert np.ptp(print_n[:, 1]) == pytest.approx(np.ptp(outline[:, 0]), rel=1e-5)  # the toe points east
    assert np.ptp(print_n[:, 2]) == 0.0
    assert not finite(Footprint(1, (math.nan, 0.0, 0.0), 0.0))


def test_a_stride_sends_only_its_own_group(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    sent: list[int] = []

    def noted(prints: tuple[Footprint, ...], role: Role) -> bytes:
        sent.append(len(prints))
        return made(prints, role)

    made = footprints.printed
    monkeypatch.setattr(footprints, "printed", noted)
    drawn = Footprints(scene._server.scene, "foot", Role.FOOT, (0.0, 0.0, 0.0), time.monotonic)
    for count in range(1, 3 * PRINTS):
        sent.clear()
        drawn.draw(steps(count)[-PRINTS:])
        assert len(sent) == 1
        assert sent[0] <= GROUP
    assert len(drawn._groups) <= PRINTS // GROUP + 1


def test_what_was_corrected_is_drawn_anew_and_the_old_goes(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(footprints, "BOTH_S", 0.0)
    drawn = Footprints(scene._server.scene, "foot", Role.FOOT, (0.0, 0.0, 0.0), time.monotonic)
    drawn.draw(steps(12))
    moved = tuple(foot._replace(heading_rad=1.0) for foot in steps(12))
    drawn.draw(moved)
    drawn.draw(moved)
    assert len(sent_now(scene)) == len(grouped(list(moved))) == 2
    for k in range(60):  # however often, viser keeps no more of it
        drawn.draw(tuple(foot._replace(heading_rad=0.01 * k) for foot in steps(12)))
    assert len(sent_now(scene)) <= 2 + meshes.LEAVING


def sent_now(scene: Scene) -> list[str]:
    """Those that a browser that joins now would be sent."""
    sent = private.broadcast_messages(scene._server)
    return [m.name for m in sent if type(m).__name__ == "GlbMessage" and "/soles_" in m.name]


def test_the_oldest_may_stay_a_little_longer() -> None:
    assert same(steps(8), steps(3, 5))
    assert not same(steps(8), ())
    assert not same(steps(3), steps(4))
