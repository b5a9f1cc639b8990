"""Edge, scene: the panel on the right and the graphs at the foot of the page."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import viser

from app.motion.commands import ResetHeading, RestartHere
from app.motion.snapshot import Snapshot
from app.motion.status import Status
from app.scene import figures, phones, swinging
from app.scene.annexe import Town
from app.scene.beat import beat
from app.scene.before import BeforeTab
from app.scene.controls import Ask, Controls, Html, Input
from app.scene.graphs import Graphs
from app.scene.hindsight import CandidateBox, GainSearch
from app.scene.lab import LabTab
from app.scene.library import Library
from app.scene.profiles import Profiles
from app.scene.recording import MARKER, TOGGLE, Recording, banner
from app.scene.reference import told
from app.scene.replaying import Replaying
from app.scene.soundness import Soundness, tables
from app.scene.tuning import Tuning

WIDTH_PX = 400
GRAPHS_WIDTH_PX, GRAPHS_HEIGHT_PX = 800, 222

KEYS = (
    ("Space", "record, or end the recording"), ("M", "marker"),
    ("B", "swap A and B"), ("C", "apply the candidate"), ("R", "reset heading"), ("F", "full screen"),
    ("Esc", "stop (pause the replay)"),
)  # fmt: skip
NOTES = (
    "Grid: 1 m, bold 5 m. Frame n: x north, y east, z down; quaternions wxyz.",
    "Distance is the sum of horizontal stride lengths; to start, the horizontal way back.",
    "Cadence = 2 × 60 s ÷ stride duration. Speed = stride length ÷ stride duration.",
    "Ring at a shoe: the foot is inside it 95 times of 100; orange: drifting or lost.",
    "Height is the sensor's, above the start. Dashed: the newest stride, not yet corrected.",
)


View = dict[str, bool]


class Panel:
    """Everything beside the scene. ``on_view`` hears of the page's own switches (follow, dark, axes)."""

    def __init__(self, controls: Controls, on_view: Callable[[str, bool], None], view: View) -> None:
        gui = controls.gui
        self._controls, self._on_view = controls, on_view
        gui.main_panel.dock_right()
        gui.main_panel.set_width(WIDTH_PX)
        self._header, self._message, self._feet = controls.html(), controls.html(), controls.html()
        self._phones = [controls.html()]  # until there is a foot; then under Source
        self._soundness = Soundness(controls)
        self._replaying = Replaying(controls)
        tabs = gui.add_tab_group()
        with tabs.add_tab("Tune"):
            self._tuning = Tuning(controls)
            self._box = CandidateBox(controls)
            self._tuning.add_more()
        with tabs.add_tab("Gains"):
            self._search = GainSearch(controls)
        with tabs.add_tab("Source"):
            self._source, self._log = self._source_tab(gui)
        with tabs.add_tab("Library"):
            self._library = Library(controls)
        with tabs.add_tab("Before"):
            self._before = BeforeTab(controls)
        with tabs.add_tab("Lab"):
            self._lab = LabTab(controls)
        with tabs.add_tab("View"):
            self._switches = self._view_tab(gui, view)
        self._graphs = _graph_panel(gui)

    def _source_tab(self, gui: viser.GuiApi) -> tuple[Html, Html]:
        with gui.add_folder("Recording"):
            self._recording = Recording(self._controls)
        source = self._controls.html()
        self._phones.append(self._controls.html())
        with gui.add_folder("Profiles"):
            self._profiles = Profiles(self._controls)
        with gui.add_folder("Changes"):
            log = self._controls.html()
        return source, log

    def _view_tab(self, gui: viser.GuiApi, view: View) -> dict[str, Input]:
        again: dict[str, Ask] = {"Reset heading": ResetHeading, "Restart from here": RestartHere}
        self._walk = self._controls.choice("Walk", again)
        self._town = Town(self._controls)
        labels = {"follow": "Follow the walker", "dark": "Dark mode", "axes": "Sensor axes"}
        labels["own"] = "Sensor's own orientation"
        hints = {
            "follow": "The world glides so that the walker stays in view; your orbit and zoom stay yours.",
            "dark": "For every browser on this page.",
            "axes": "x (red) to the toe, y (green) to the right, z (blue) down.",
            "own": "A grey shoe: the walk by the orientation that the sensor computed itself.",
        }
        switches = {
            name: self._controls.checkbox(label, self._switch(name), view[name], hints[name])
            for name, label in labels.items()
        }
        keys = "".join(f"<tr><th><kbd>{key}</kbd></th><td>{what}</td></tr>" for key, what in KEYS)
        notes = "".join(f"<li>{note}</li>" for note in NOTES)
        gui.add_html(f'<table class="ss-table ss-keys">{keys}</table><ul class="ss-notes">{notes}</ul>')
        return switches

    def _switch(self, name: str) -> Callable[[bool], None]:
        return lambda on: self._on_view(name, on)

    def keys(self) -> dict[str, tuple[str, str]]:
        """Which control a key presses, and with what value."""
        return {
            " ": (self._recording.buttons.id, TOGGLE), "m": (self._recording.buttons.id, MARKER),
            "b": (self._box.slots.id, "Swap"), "c": (self._box.buttons.id, "Apply"),
            "r": (self._walk.id, "Reset heading"), "escape": (self._replaying.buttons.id, "Pause"),
        }  # fmt: skip

    def resets(self) -> list[str]:
        """The small reset buttons, for the style sheet."""
        return [button.id for button in (*self._tuning.resets, *self._lab.resets)]

    def tuned(self) -> dict[str, Input]:
        """The control of each setting."""
        return self._tuning.inputs

    def show_text(self, snapshot: Snapshot, status: Status, view: View) -> None:
        """Words, figures and controls: at most ten times a second."""
        self._header.show(figures.header(status) + beat(time.time()))
        self._message.show(banner(status) + figures.message(snapshot, status))
        self._feet.show(
            swinging.cards(snapshot, view["own"], status.source.temperatures) + told(status.reference)
        )
        self._phones[0].show("" if snapshot.main.feet else phones.code(status))
        self._phones[1].show(phones.code(status))
        self._soundness.show(snapshot, status)
        self._source.show(figures.source(snapshot, status) + tables(snapshot))
        self._log.show(figures.log(snapshot, _rate(snapshot, status)))
        self._replaying.show(status)
        self._recording.show(status)
        self._library.show(status)
        self._box.show(snapshot)
        self._search.show(snapshot, status)
        self._tuning.show(snapshot)
        self._profiles.show(status)
        self._before.show(status)
        self._lab.show(status)
        self._town.show(status)
        for name, control in self._switches.items():
            control.show(view[name])

    def show_graphs(self, snapshot: Snapshot) -> None:
        """The last seconds."""
        self._graphs.draw(snapshot)


def _rate(snapshot: Snapshot, status: Status) -> float:
    """Samples of all sensors a second: what turns a sample's number into a time."""
    return sum(h.rate_hz for h in snapshot.health.values()) or status.source.rate_hz


def _graph_panel(gui: viser.GuiApi) -> Graphs:
    panel = gui.add_panel()
    tab: Any = panel.add_tab("Last 10 s")
    panel.float(x=12, y=-12, width=GRAPHS_WIDTH_PX, height=GRAPHS_HEIGHT_PX)
    return Graphs(gui, tab)
