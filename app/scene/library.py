"""Edge, scene: the library: recordings to play, rename and download, and a place to upload one."""

from __future__ import annotations

import math
from urllib.parse import quote

from app.motion.commands import Command, Play, Rename, SetDeclination, Share
from app.motion.door import GuiRule
from app.motion.status import ShelfFile, Status
from app.scene import words
from app.scene.controls import Controls

CHOOSE = "choose…"
#: What ``library.js`` listens to; its words are ours, the answer is put in as text.
UPLOAD = (
    '<div class="ss-upload"><label>Upload a recording <input type="file" data-ss-upload></label>'
    '<progress max="1" value="0" hidden></progress><div class="ss-note" data-ss-told>'
    "Any file that Stridescope opens, up to 1 GB: its own, plain, x-io, MicroStrain or gaitmap CSV, PyShoe."
    "</div></div>"
)


class Library:
    """What is chosen here is chosen for every operator's page."""

    def __init__(self, controls: Controls) -> None:
        self._controls = controls
        self._chosen, self._name = CHOOSE, ""
        self._list = controls.dropdown(
            "From the library", (CHOOSE,), self._choose, "The folder of recordings."
        )
        controls.choice("", {"Open": self._play, "Share": self._share, "Rename": self._rename})
        controls.text("New name", self._typed, "What Rename gives the chosen recording.", longest=80)
        self._declination = controls.slider(
            "Declination, °",
            GuiRule("number", -180.0, 180.0),
            SetDeclination,
            min=-180.0,
            max=180.0,
            step=0.1,
            initial_value=0.0,
            visible=False,
            hint="Of the GPS track: how far magnetic north lies east of true north. It turns the track.",
        )
        controls.gui.add_html(UPLOAD)
        self._table = controls.html()

    def show(self, status: Status) -> None:
        """What is in the folder now."""
        names = [file.name for file in status.shelf if playable(file.name)]
        if self._chosen not in names:
            self._chosen = CHOOSE
        self._controls.offer(self._list, (CHOOSE, *names))
        self._list.show(self._chosen)
        self._table.show(table(status.shelf))
        self._declination.appear(status.reference is not None)
        if status.reference is not None:
            self._declination.show(round(math.degrees(status.reference.declination_rad), 3))

    def _choose(self, name: str) -> None:
        self._chosen = name

    def _typed(self, name: str) -> None:
        self._name = name.strip()

    def _play(self) -> Command | None:
        return None if self._chosen == CHOOSE else Play(self._chosen)

    def _share(self) -> Command | None:
        return None if self._chosen == CHOOSE else Share(self._chosen)

    def _rename(self) -> Command | None:
        return None if self._chosen == CHOOSE or not self._name else Rename(self._chosen, self._name)


def playable(name: str) -> bool:
    """Whether it is a recording and not a page made of one."""
    return not name.lower().endswith(".html")


def table(files: tuple[ShelfFile, ...]) -> str:
    """Every file with its size and date; its name is a link that downloads it."""
    if not files:
        return '<div class="ss-note">No recordings yet: press Space to make one, or upload one.</div>'
    rows = "".join(
        f'<tr><td><a href="/files/{quote(file.name, safe="")}" download>{words.plain(file.name)}</a></td>'
        f"<td>{words.megabytes(file.size_bytes)}</td><td>{words.plain(file.changed)}</td></tr>"
        for file in files
    )
    return f'<table class="ss-table ss-files">{rows}</table>'
