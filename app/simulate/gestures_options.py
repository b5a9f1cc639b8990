"""Heart: what `sim:gestures` can be asked for: a script, its regularity and size, the sensors' errors."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

from app.motion.basics import InputError, MotionId

#: What feet do that asks for nothing.
IDLE = ("none", "shift", "tap")
GESTURES = tuple(motion.name.lower() for motion in MotionId if motion)
DEMO = "none:3,forward:6,none:2,turn_cw:4,none:2,forward_left:6,none:2,side_right:5,none:2,backward:5,none:3"
_MOST_SECONDS = 36_000.0


class Bar(NamedTuple):
    """One entry of a script: what is done (a gesture or an idle pastime) and for about how long."""

    what: str
    seconds: float


def _number(default: float, low: float, high: float, sentence: str) -> Any:
    return field(default=default, metadata={"low": low, "high": high, "sentence": sentence})


@dataclass(frozen=True)
class GestureOptions:
    """Two feet and their sensors. A number out of range raises ``InputError``.

    ``cadence_hz`` counts whole cycles: both feet once each, or the one foot of a one-foot gesture
    once; every bout has its own, within 8 % of it. ``script`` is ``WHAT:SECONDS,…`` or
    ``random:BOUTS`` (all gestures in random order, with rests of random length between most).
    """

    script: str = DEMO
    cadence_hz: float = _number(1.0, 0.3, 3.0, "whole cycles a second")
    amplitude: float = _number(1.0, 0.05, 3.0, "size of every gesture; 1 is a lively step")
    vary: float = _number(
        1.0, 0.0, 1.0, "how much everything differs from gesture to gesture; 0 is a machine"
    )
    asymmetry: float = _number(0.15, 0.0, 0.6, "how much the right foot may differ from the left")
    hesitation: float = _number(0.04, 0.0, 1.0, "share of actions that come late")
    transient: float = _number(1.0, 0.0, 5.0, "heel contact and overshoot")
    noise: float = _number(1.0, 0.0, 1000.0, "random errors, in multiples of Table II")
    drift_radps: float = _number(0.01, 0.0, 1.0, "size of the gyros' slowly wandering bias")
    mounting_deg: float = _number(6.0, 0.0, 60.0, "how crookedly the sensors sit")
    rate_hz: float = _number(100.0, 20.0, 2000.0, "samples a second")
    seed: int = field(
        default=0, metadata={"low": 0, "high": 2**63 - 1, "sentence": "seed of all that is random"}
    )

    def __post_init__(self) -> None:
        for f in fields(self):
            if f.metadata:
                _check(f.name, getattr(self, f.name), f.metadata)
        bars_of(self.script)


def bars_of(script: str) -> tuple[Bar, ...]:
    """A script's entries, or one ``random`` with its bouts; ``InputError`` says what is wrong."""
    bars = tuple(_bar(part) for part in script.split(","))
    if len(bars) > 1 and any(bar.what == "random" for bar in bars):
        raise InputError("sim:gestures: script: expected random:BOUTS alone, without other entries")
    if sum(bar.seconds for bar in bars) > _MOST_SECONDS:
        raise InputError(f"sim:gestures: script: expected at most {_MOST_SECONDS:g} s in all")
    return bars


def _bar(part: str) -> Bar:
    what, _, text = part.strip().partition(":")
    known = ("random", *IDLE, *GESTURES)
    if what not in known:
        raise InputError(f"sim:gestures: script: {what!r}: expected one of {', '.join(known)}")
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0.1 <= seconds <= _MOST_SECONDS:
        raise InputError(f"sim:gestures: script: {part.strip()!r}: expected {what}:SECONDS, from 0.1")
    return Bar(what, seconds)


def parse(texts: Mapping[str, str]) -> GestureOptions:
    """The options of a SPEC's query; raises ``InputError`` that says what is known."""
    known = {f.name for f in fields(GestureOptions)}
    short = {name.rpartition("_")[0]: name for name in known if "_" in name}
    values: dict[str, Any] = {}
    for said, text in texts.items():
        key = short.get(said, said)
        if key not in known:
            raise InputError(
                f"sim:gestures: unknown option {said!r}: expected one of {', '.join(sorted(known))}"
            )
        if key in values:
            raise InputError(f"sim:gestures: {key} is given twice")
        values[key] = text if key == "script" else _read(key, text)
    return GestureOptions(**values)


def spec_of(options: GestureOptions) -> str:
    """The SPEC that makes these gestures again, without what is as usual."""
    changed = [
        f"{f.name}={_text(getattr(options, f.name))}"
        for f in fields(options)
        if getattr(options, f.name) != f.default
    ]
    return "sim:gestures" + ("?" + "&".join(changed) if changed else "")


def _text(value: object) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _read(key: str, text: str) -> float:
    try:
        return int(text) if key == "seed" else float(text)
    except ValueError:
        raise InputError(f"sim:gestures: {key}={text!r}: expected a number") from None


def _check(key: str, value: float, metadata: Mapping[str, Any]) -> None:
    low, high = metadata["low"], metadata["high"]
    if not low <= value <= high:
        sentence = metadata["sentence"]
        raise InputError(f"sim:gestures: {key}={_text(value)}: expected {low:g} to {high:g} ({sentence})")
