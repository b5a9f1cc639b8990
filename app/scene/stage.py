"""Edge, scene: what moves on the floor: a walk's shoes, or a pendulum."""

from __future__ import annotations

import viser

from app.motion.basics import Vector
from app.motion.snapshot import PendulumView, Snapshot
from app.scene.meshes import Clock
from app.scene.pendulum import Pendulum, no_feet
from app.scene.walkers import Walkers


class Stage:
    """Shows what the snapshot is of, and takes away what it is not."""

    def __init__(self, scene: viser.SceneApi, now: Clock) -> None:
        self.walkers = Walkers(scene, now)
        self._scene = scene
        self._pendulum: Pendulum | None = None

    def draw(self, snapshot: Snapshot) -> list[Vector]:
        """Show it; returns what to look at."""
        self._hang(snapshot.pendulum)
        if self._pendulum is None:
            return self.walkers.draw(snapshot)
        self.walkers.draw(no_feet(snapshot))
        return [self._pendulum.draw(snapshot)]

    def draw_ways(self, snapshot: Snapshot) -> None:
        """Where the feet went; after ``draw``."""
        self.walkers.draw_ways(snapshot if self._pendulum is None else no_feet(snapshot))

    def _hang(self, view: PendulumView | None) -> None:
        if self._pendulum is not None and (view is None or view.rod_m != self._pendulum.rod_m):
            self._pendulum.remove()
            self._pendulum = None
        if self._pendulum is None and view is not None:
            self._pendulum = Pendulum(self._scene, view.rod_m)
