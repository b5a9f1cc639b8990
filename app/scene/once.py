"""Edge, scene: what is drawn once for each thing that is opened, and stays until another takes its place."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

import viser

_T = TypeVar("_T")


class Once(Generic[_T]):
    """The nodes of one thing, or of none."""

    def __init__(self, make: Callable[[_T], list[viser.SceneNodeHandle]]) -> None:
        self._make = make
        self._shown: _T | None = None
        self._nodes: list[viser.SceneNodeHandle] = []

    def draw(self, thing: _T | None) -> None:
        """Make the page show this thing, or none."""
        if thing is not self._shown:
            self._shown = thing
            for node in self._nodes:
                node.remove()
            self._nodes = [] if thing is None else self._make(thing)
