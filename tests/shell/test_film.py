"""A film shows the walk at the recording's own times."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from app.motion.snapshot import Snapshot
from app.shell import film
from tests.estimator.walks import PAPERS
from tests.formats.test_kept import two_clocks


class Reel:
    """Only what it was given."""

    def __init__(self) -> None:
        self.shown: list[Snapshot] = []

    def take(self, snapshot: Snapshot, _: float) -> None:
        self.shown.append(snapshot)

    def page(self) -> str:
        return ""


def test_sensors_with_clocks_of_their_own_are_filmed_side_by_side(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reel = Reel()

    @contextmanager
    def opened(*_: object) -> Iterator[Reel]:
        yield reel

    monkeypatch.setattr(film, "film", opened)
    walk = tmp_path / "walk.mcap"
    walk.write_bytes(two_clocks(10**15))
    film.share(f"replay:{walk}", PAPERS, tmp_path / "walk.html")
    feet = [len(shot.main.feet) for shot in reel.shown if shot.main.feet]
    assert (feet[0], feet[-1]) == (1, 2)
    assert reel.shown[-1].t_s == pytest.approx(5.99)
    recent = [health.recent for shot in reel.shown[70:] for health in shot.health.values()]
    assert all(told.silent_s < 0.1 for told in recent if told)
