"""Edge, scene: meshes that come and go by their keys: what one replaces stays until it is there."""

from __future__ import annotations

from collections.abc import Callable, Hashable

import viser

#: A mesh takes a moment to appear in a browser; so long what it replaces stays.
BOTH_S = 0.3
#: Seconds from some moment on: of the page, or of a film of it.
Clock = Callable[[], float]
#: Of those that go, so many stay at most: many corrections at once.
LEAVING = 24


class Meshes:
    """Under ``prefix``. Names are used again: viser keeps a word for each that ever was."""

    def __init__(self, scene: viser.SceneApi, prefix: str, both_s: float, now: Clock) -> None:
        self._scene, self._prefix, self._made = scene, prefix, 0
        self._both_s, self._now = both_s, now
        self._shown: dict[Hashable, viser.GlbHandle] = {}
        self._leaving: list[tuple[float, viser.GlbHandle]] = []
        self._free: list[str] = []

    def __len__(self) -> int:
        return len(self._shown)

    def put(self, key: Hashable, file: bytes) -> None:
        """Show this, binary glTF; in place of what had the key."""
        self.drop(key)
        if not self._free:
            self._made += 1
            self._free.append(f"{self._prefix}_{self._made}")
        name = self._free.pop(0)
        self._shown[key] = self._scene.add_glb(name, file, cast_shadow=False, receive_shadow=False)

    def drop(self, key: Hashable) -> None:
        """Take it away, in a moment."""
        node = self._shown.pop(key, None)
        if node is not None:
            self._leaving.append((self._now() + self._both_s, node))
        while len(self._leaving) > LEAVING:
            self._let_go()

    def tidy(self) -> None:
        """Let go what should be gone by now; to be called with every picture."""
        while self._leaving and self._leaving[0][0] < self._now():
            self._let_go()

    def _let_go(self) -> None:
        node = self._leaving.pop(0)[1]
        self._free.append(node.name)
        node.remove()
