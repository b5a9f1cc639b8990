"""Edge, scene: the recording: begin, end, mark; its file, time, size, and room on the disk."""

from __future__ import annotations

from app.motion.commands import Command, Mark, Record
from app.motion.status import Status
from app.scene import words
from app.scene.controls import Controls

TOGGLE, MARKER = "Record / end", "Marker"


class Recording:
    """One line of state, a toggle, a marker with a text."""

    def __init__(self, controls: Controls) -> None:
        self._on = False
        self._text = ""
        self._line = controls.html()
        self.buttons = controls.choice("Recording", {TOGGLE: self._toggle, MARKER: lambda: Mark(self._text)})
        controls.text("Marker's text", self._typed, "What the next marker says.", longest=80)

    def show(self, status: Status) -> None:
        """As the recorder is."""
        self._on = status.recording is not None and status.recording.on
        self._line.show(line(status))

    def _toggle(self) -> Command:
        return Record(not self._on)

    def _typed(self, text: str) -> None:
        self._text = text


def line(status: Status) -> str:
    """The state of the recording as HTML; trouble is a red banner."""
    state = status.recording
    if state is None:
        return '<div class="ss-note">Not recording.</div>'
    size = words.megabytes(state.size_bytes)
    told = f"{words.plain(state.name)} · {size}"
    if state.on:
        free = f" · {words.number(state.free_bytes / 1e9, 1)} GB free" if state.free_bytes else ""
        told = f'<span class="ss-rec">● REC</span> {words.clock(state.seconds)} · {told}{free}'
    note = f'<div class="ss-note">{told if state.on else "Recorded: " + told}</div>'
    return note


def banner(status: Status) -> str:
    """What is wrong with the recording, loudly; nothing if all is well."""
    trouble = status.recording.trouble if status.recording else ""
    return f'<div class="ss-stale">RECORDING: {words.plain(trouble)}</div>' if trouble else ""
