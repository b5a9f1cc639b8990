"""Edge, scene: the sliders of a track's settings, generated from ``settings.LIMITS``."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from app.limits import Limit, Value
from app.motion.commands import ReplaceCandidate, SetCandidate
from app.motion.door import GuiRule
from app.motion.snapshot import Snapshot
from app.scene.controls import Controls, Input
from app.settings import BUILT_IN, LIMITS, is_read

FIRST = (
    "estimator", "gain_stance", "gain_swing", "threshold_radps", "min_duration_s", "gait_factor",
    "sensor_height_m", "magnetometer", "gravity_from_rest", "gravity_mps2",
)  # fmt: skip
DEFAULTS = BUILT_IN["default"]


def title(limit: Limit) -> str:
    """``Stance gain k_s, 1/s``; angles in degrees."""
    unit = "°" if limit.unit == "rad" else limit.unit
    name = f"{limit.label} {limit.symbol}".strip()
    return f"{name}, {unit}" if unit else name


def scale(limit: Limit) -> float:
    """From the setting's unit to the page's: degrees only here."""
    return math.degrees(1.0) if limit.unit == "rad" else 1.0


def shown(value: float, limit: Limit) -> float:
    """The value as the slider has it, free of the noise of the conversion."""
    return round(value * scale(limit), 9)


class Tuning:
    """One control per setting, each with its reset; the less used ones folded away."""

    def __init__(self, controls: Controls) -> None:
        self._controls = controls
        self._inputs: dict[str, Input] = {}
        self._resets: dict[str, Input] = {}
        for name in FIRST:
            self._add(name)

    def add_more(self) -> None:
        """The rest, folded, and the button that resets all: they stand below the candidate."""
        controls = self._controls
        with controls.gui.add_folder("More settings", expand_by_default=False):
            for name in LIMITS:
                if name not in FIRST:
                    self._add(name)
        controls.choice("", {"Reset all sliders": lambda: ReplaceCandidate(DEFAULTS, "all sliders reset")})

    @property
    def inputs(self) -> dict[str, Input]:
        """The control of each setting."""
        return dict(self._inputs)

    @property
    def resets(self) -> list[Input]:
        """The reset buttons."""
        return list(self._resets.values())

    def show(self, snapshot: Snapshot) -> None:
        """Every control as the session's candidate settings say; those without effect stay away."""
        settings = snapshot.candidate_settings
        for name, control in self._inputs.items():
            for part in (control, self._resets[name]):
                part.appear(is_read(name, settings))
            value = getattr(settings, name)
            if isinstance(value, float):
                value = shown(value, LIMITS[name])
                self._controls.widen(control, value, value)
            control.show(value)

    def _add(self, name: str) -> None:
        default, limit = getattr(DEFAULTS, name), LIMITS[name]
        if isinstance(default, bool):
            self._inputs[name] = self._controls.checkbox(title(limit), _setter(name), default, limit.sentence)
        elif isinstance(default, str):
            self._inputs[name] = self._controls.dropdown(
                title(limit), limit.choices, _setter(name), limit.sentence
            )
        else:
            self._inputs[name] = self._slider(name, default, limit)
        self._resets[name] = self._controls.button("↺", _resetter(name, default))

    def _slider(self, name: str, default: float, limit: Limit) -> Input:
        k = scale(limit)
        rule = GuiRule("number", low=limit.low * k - 1e-9, high=limit.high * k + 1e-9)
        look: dict[str, Any] = {
            "min": shown(limit.safe[0], limit), "max": shown(limit.safe[1], limit),
            "step": round(limit.step * k, 6), "initial_value": shown(default, limit), "hint": limit.sentence,
        }  # fmt: skip
        return self._controls.slider(title(limit), rule, _number_setter(name, limit), **look)


def _setter(name: str) -> Callable[[Any], SetCandidate]:
    return lambda value: SetCandidate(((name, value),))


def _number_setter(name: str, limit: Limit) -> Callable[[float], SetCandidate]:
    def ask(value: float) -> SetCandidate:
        inside = min(max(float(value) / scale(limit), limit.low), limit.high)
        return SetCandidate(((name, inside),))

    return ask


def _resetter(name: str, default: Value) -> Callable[[], SetCandidate]:
    return lambda: SetCandidate(((name, default),))
