"""Edge, scene: replay controls: play, pause, step, seek, speed, loop."""

from __future__ import annotations

from app.motion.commands import Loop, Pause, Seek, Speed, Step
from app.motion.door import GuiRule
from app.motion.status import Status
from app.scene import figures
from app.scene.controls import Controls

FASTEST = 8.0
SLOWEST = 0.1


def factor(value: float) -> float:
    """What a speed slider's value asks for: 0 is as fast as possible, else 0.1 to 8."""
    return 0.0 if value < 0.05 else min(max(round(value, 2), SLOWEST), FASTEST)


class Replaying:
    """Shown while the source can be paused."""

    def __init__(self, controls: Controls) -> None:
        self._controls = controls
        self._folder = controls.gui.add_folder("Replay", visible=False)
        with self._folder:
            self._position = controls.html()
            self.buttons = controls.choice(
                "", {"Play": lambda: Pause(False), "Pause": lambda: Pause(True), "Step": lambda: Step()}
            )
            self._seek = controls.slider(
                "Position, s", GuiRule("number", 0.0, 1e7), lambda t: Seek(t), min=0.0, max=1.0, step=0.1,
                initial_value=0.0, hint="Where in the recording; the walk is estimated up to there.",
            )  # fmt: skip
            self._speed = controls.slider(
                "Speed, ×", GuiRule("number", 0.0, FASTEST), lambda v: Speed(factor(v)), min=0.0, max=FASTEST,
                step=0.1, initial_value=1.0, hint="Times the recorded pace; 0 is as fast as possible.",
            )  # fmt: skip
            self._loop = controls.checkbox("Loop", Loop, False, "Start again at the end.")

    def show(self, status: Status) -> None:
        """As the source is."""
        self._folder.visible = status.replay
        if not status.replay:
            return
        self._position.show(figures.position(status))
        length = status.source.duration_s
        known = length is not None and length > 0
        self._seek.handle.visible = known
        if length is not None and known:
            self._seek.handle.max = max(round(length, 1), 0.1)
            self._seek.show(round(min(max(status.position_s, 0.0), length), 1))
        self._speed.show(factor(status.speed))
        self._loop.show(status.loop)
