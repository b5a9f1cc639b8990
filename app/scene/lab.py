"""Edge, scene: the lab: lessons, the errors of a simulated sensor as sliders, and a pendulum to swing."""

from __future__ import annotations

from functools import partial
from html import escape
from typing import Any

from app.motion.commands import SetErrors, Swing, TakeLesson
from app.motion.door import HAND_IN, GuiRule
from app.motion.status import Status
from app.scene.controls import Controls, Input
from app.scene.tuning import title
from app.simulate.lab import LESSONS, LIMITS, PERFECT

ELSEWHERE = (
    '<div class="ss-note">A lab for a simulated sensor: its errors as sliders, the truth beside the estimate.'
    " Let the pendulum go, or start with <code>--source sim:walk</code>.</div>"
)
INTRODUCTION = (
    '<div class="ss-note">What is wrong with the sensor, from now on. The green line is the truth, and the'
    " last graph how far the estimate is from it.</div>"
)
#: A link, so that the browser saves what the door gives; the style sheet makes it a button.
SAVE = (
    f'<div class="ss-note"><a class="ss-save" href="{HAND_IN}" download>Save as one HTML file</a>'
    "The walk so far beside the truth, the error, the lesson, all settings: opens anywhere, no network.</div>"
)
FARTHEST_DEG, USUAL_DEG = 80.0, 30.0


class LabTab:
    """Lessons set errors and settings together; each says what to notice."""

    def __init__(self, controls: Controls) -> None:
        self._controls = controls
        self.resets: list[Input] = []  # the small buttons, for the style sheet
        self._told, self._angle_deg, self._errors = controls.html(), USUAL_DEG, dict[str, Input]()
        self._sensor = controls.gui.add_folder("Sensor")
        with self._sensor:
            controls.choice("", {x.name: partial(TakeLesson, x.name) for x in LESSONS})
            self._notice = controls.html()
            for name in LIMITS:
                self._add(name)
            controls.choice("", {"Perfect sensor": lambda: SetErrors(_perfect())})
            controls.gui.add_html(SAVE)
        with controls.gui.add_folder("Pendulum"):
            look = {"min": -FARTHEST_DEG, "max": FARTHEST_DEG, "step": 1.0, "initial_value": USUAL_DEG}
            rule = GuiRule("number", low=-FARTHEST_DEG, high=FARTHEST_DEG)
            self._angle = controls.slider(
                "Let go at, °", rule, self._aim, hint="Held still for a second, then let go.", **look
            )
            controls.choice("", {"Swing": lambda: Swing(self._angle_deg)})
            controls.gui.add_html(
                '<div class="ss-note">A sensor at the end of a rod: blue is the estimate, green the truth. At'
                " gain 0 it is the gyro alone; a gain takes the swing's own acceleration for gravity.</div>"
            )

    def show(self, status: Status) -> None:
        """The errors as they are; nothing to set where there is no simulation."""
        errors = status.errors
        self._told.show(ELSEWHERE if errors is None else INTRODUCTION)
        self._notice.show(notice(status.lesson))
        self._sensor.visible = errors is not None
        for name, value in (errors or {}).items():
            self._errors[name].show(value)
        self._angle.show(self._angle_deg)

    def _aim(self, angle_deg: float) -> None:
        self._angle_deg = angle_deg

    def _add(self, name: str) -> None:
        limit, usual = LIMITS[name], getattr(PERFECT, name)
        rule = GuiRule("number", low=limit.low, high=limit.high)
        look: dict[str, Any] = {
            "min": limit.safe[0], "max": limit.safe[1], "step": limit.step, "initial_value": usual,
            "hint": limit.sentence,
        }  # fmt: skip
        self._errors[name] = self._controls.slider(
            title(limit), rule, lambda value: SetErrors(((name, value),)), **look
        )
        self.resets.append(self._controls.button("↺", lambda: SetErrors(((name, usual),))))


def notice(lesson: str) -> str:
    """The sentences of a lesson."""
    said = next((x.notice for x in LESSONS if x.name == lesson), "")
    return f'<div class="ss-note"><b>{escape(lesson)}.</b> {escape(said)}</div>' if said else ""


def _perfect() -> tuple[tuple[str, float], ...]:
    return tuple((name, getattr(PERFECT, name)) for name in LIMITS)
