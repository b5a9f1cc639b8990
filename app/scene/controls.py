"""Edge, scene: every input on the page: what a browser may write into it, and what that asks for.

Truth goes from the session to the page: a control's value is set from the snapshot and never read
back. Callbacks are ``async def`` so that viser runs them on its loop in the order they came: its
thread pool could swap two moves of one slider.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any

import viser

from app.motion.commands import Command, Order
from app.motion.door import GuiRule
from app.scene import private

Submit = Callable[[Order], None]
Ask = Callable[[], Command | None]
#: While a person moves a control and for this long after, their own browser is not corrected.
HOLD_S = 0.5


class Input:
    """One control and the value the session says it has."""

    def __init__(self, handle: Any) -> None:
        self.handle = handle
        self.id = private.control_id(handle)
        self._ours = handle.update_timestamp

    def appear(self, visible: bool) -> None:
        """Be on the page, or not."""
        if self.handle.visible != visible:
            self.handle.visible = visible

    def show(self, value: Any) -> None:
        """Make every browser show this; a control just touched is left until the hand is off it."""
        handle = self.handle
        if handle.value == value or (isinstance(value, float) and not math.isfinite(value)):
            return
        touched = handle.update_timestamp != self._ours
        if touched and abs(time.time() - handle.update_timestamp) < HOLD_S:
            return
        handle.value = value
        self._ours = handle.update_timestamp


class Html:
    """A piece of HTML that is sent only when it changed."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._handle = gui.add_html("")
        self._text = ""

    def show(self, text: str) -> None:
        """Make it read so."""
        if text != self._text:
            self._handle.content = self._text = text


class Controls:
    """Makes inputs and keeps their rules."""

    def __init__(self, gui: viser.GuiApi, submit: Submit) -> None:
        self.gui = gui
        self._submit = submit
        self._rules: Mapping[str, GuiRule] = MappingProxyType({})

    def rules(self) -> Mapping[str, GuiRule]:
        """uuid → what a browser may write; a new mapping at each change, so any thread may read it."""
        return self._rules

    def html(self) -> Html:
        """A piece of the panel that is no input."""
        return Html(self.gui)

    def button(self, label: str, ask: Callable[[], Command | None], **look: Any) -> Input:
        """A push button; ``ask`` gives the command, or does a thing of the page's own."""
        handle = self.gui.add_button(label, **look)
        return self._wire(handle, GuiRule("button"), lambda _: ask(), handle.on_click)

    def choice(self, label: str, asks: Mapping[str, Ask], hint: str | None = None) -> Input:
        """A row of small buttons."""
        handle = self.gui.add_button_group(label, tuple(asks), hint=hint)
        rule = GuiRule("choice", choices=tuple(asks))
        return self._wire(handle, rule, lambda value: asks.get(value, _nothing)(), handle.on_click)

    def slider(self, label: str, rule: GuiRule, ask: Callable[[float], Command | None], **look: Any) -> Input:
        """A slider; numbers that are not finite or outside the rule are not heard."""
        handle = self.gui.add_slider(label, **look)
        heard = partial(_if_in_range, ask, rule)
        return self._wire(handle, rule, heard, handle.on_update)

    def checkbox(
        self, label: str, ask: Callable[[bool], Command | None], initial: bool, hint: str | None = None
    ) -> Input:
        """A switch."""
        handle = self.gui.add_checkbox(label, initial, hint=hint)
        return self._wire(handle, GuiRule("bool"), lambda value: ask(bool(value)), handle.on_update)

    def text(
        self, label: str, ask: Callable[[str], Command | None], hint: str | None = None, longest: int = 60
    ) -> Input:
        """A line to type in."""
        handle = self.gui.add_text(label, "", hint=hint)
        rule = GuiRule("text", max_length=longest)
        return self._wire(handle, rule, lambda value: ask(str(value)[:longest]), handle.on_update)

    def dropdown(
        self, label: str, options: Sequence[str], ask: Callable[[str], Command | None], hint: str | None
    ) -> Input:
        """A list to choose from; ``offer`` changes what it holds."""
        handle = self.gui.add_dropdown(label, tuple(options), hint=hint)
        rule = GuiRule("choice", choices=tuple(options))
        return self._wire(handle, rule, lambda value: ask(str(value)), handle.on_update)

    def offer(self, dropdown: Input, options: Sequence[str]) -> None:
        """Give a dropdown other options. What cannot be sent as text would end every browser's page."""
        options = [option for option in options if option.isprintable()]
        if tuple(dropdown.handle.options) != tuple(options):
            self._set_rule(dropdown.id, GuiRule("choice", choices=tuple(options)))
            dropdown.handle.options = tuple(options)

    def widen(self, slider: Input, low: float, high: float) -> None:
        """Let a slider reach a value that a profile brought from outside its safe range."""
        if low < slider.handle.min or high > slider.handle.max:
            slider.handle.min = min(low, slider.handle.min)
            slider.handle.max = max(high, slider.handle.max)

    def _set_rule(self, uuid: str, rule: GuiRule) -> None:
        self._rules = MappingProxyType({**self._rules, uuid: rule})

    def _wire(
        self, handle: Any, rule: GuiRule, ask: Callable[[Any], Command | None], register: Callable[[Any], Any]
    ) -> Input:
        async def touched(event: Any) -> None:
            if event.client_id is None:  # we set it ourselves
                return
            command = ask(event.target.value)
            if command is not None:
                self._submit(Order(command, f"browser {event.client_id}", time.monotonic_ns()))

        register(touched)
        result = Input(handle)
        self._set_rule(result.id, rule)
        return result


def in_range(value: float, rule: GuiRule) -> bool:
    """Finite and within the rule: the door sees to it first, this is the second lock."""
    return math.isfinite(value) and rule.low <= value <= rule.high


def _nothing() -> None:
    """What an option that is not on the list asks for."""


def _if_in_range(ask: Callable[[float], Command | None], rule: GuiRule, value: float) -> Command | None:
    return ask(value) if in_range(value, rule) else None
