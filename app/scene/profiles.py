"""Edge, scene: load and save a profile."""

from __future__ import annotations

from app.motion.commands import Command, LoadProfile, SaveProfile
from app.motion.status import Status
from app.scene.controls import Controls

CHOOSE = "choose…"


class Profiles:
    """A list to load from, a name to save under."""

    def __init__(self, controls: Controls) -> None:
        self._controls = controls
        self._name = ""
        self._list = controls.dropdown("Load", (CHOOSE,), self._load, "Its settings become the candidate.")
        self._text = controls.text("Save as", self._typed, "A name for the main track's settings.")
        controls.choice("", {"Save profile": self._save})

    def show(self, status: Status) -> None:
        """The profiles there are; the list goes back to its first line."""
        self._controls.offer(self._list, (CHOOSE, *status.profiles))
        self._list.show(CHOOSE)

    def _typed(self, name: str) -> None:
        self._name = name.strip()

    def _load(self, name: str) -> Command | None:
        return None if name == CHOOSE else LoadProfile(name)

    def _save(self) -> Command:
        return SaveProfile(self._name)
