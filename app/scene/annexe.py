"""Edge, scene: the button that opens the town mode beside the walk, and the way to it."""

from __future__ import annotations

from app.motion.commands import OpenTown
from app.motion.status import Status
from app.scene.controls import Controls
from app.scene.words import plain

HINT = "A town to walk through by marching in place: simulated feet, steered by the arrow keys."


class Town:
    """A button while the town is closed; a link while it is open."""

    def __init__(self, controls: Controls) -> None:
        self._button = controls.button("Walk through a town", OpenTown, hint=HINT)
        self._link = controls.html()

    def show(self, status: Status) -> None:
        """The button, or where the town is."""
        self._button.appear(not status.town)
        self._link.show(link(status.town))


def link(address: str) -> str:
    """The way to the town, in a tab of its own; nothing while it is closed."""
    if not address:
        return ""
    return (
        f'<p class="ss-notes"><a href="{plain(address)}" target="_blank" rel="noreferrer">Open the town</a>:'
        " arrow keys walk. Where this page asked for a token, it asks for the same.</p>"
    )
