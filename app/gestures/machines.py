"""Heart: a decoder's inner machines as words and numbers for the page (dissertation, Fig. 102 and 103)."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np

from app.gestures import state as s
from app.gestures.default import DefaultDecoder
from app.gestures.papers import PapersDecoder
from app.gestures.words import FEET
from app.motion.basics import Floats
from app.visit import Machines

_KINDS = {s.STEP: "step", s.TWIST: "twist", s.BACK: "back", s.TOE_UP: "taps"}
#: What is kept for the graphs, s, and how often.
SPAN_S, EVERY_S = 6.0, 1 / 30
_USUAL_RATE = 6.0  # rad/s: a lively step
_LINGERS_S = 1.5  # a foot takes part for so long after an action began


class FootNow(NamedTuple):
    """One foot's machines at this instant."""

    word: str
    size: float  # 0 to 1
    swing: bool
    motion: bool
    yaw: bool
    yaw_rad: float


def feet_now(decoder: DefaultDecoder | PapersDecoder) -> tuple[FootNow, FootNow]:
    """Left and right, of either decoder."""
    if isinstance(decoder, PapersDecoder):
        return _papers(decoder, 0), _papers(decoder, 1)
    return _default(decoder, 0), _default(decoder, 1)


def thresholds(decoder: DefaultDecoder | PapersDecoder) -> tuple[float, float]:
    """The rate above which a foot swings, rad/s, and the yaw beyond which it yaws, rad."""
    if isinstance(decoder, PapersDecoder):
        return decoder.settings.rate_threshold_radps, decoder.settings.yaw_threshold_rad
    return decoder.settings.on_radps, decoder.settings.sure_rad


def _papers(decoder: PapersDecoder, which: int) -> FootNow:
    machines = decoder.feet[FEET[which]]
    word = "still"
    if machines.motion:
        word = "twist" if machines.yaw else "step"
    elif machines.swing:
        word = "moves"
    return FootNow(
        word,
        1.0 if machines.swing else 0.5,
        machines.swing,
        machines.motion,
        machines.yaw,
        machines.filtered_rad,
    )


def _default(decoder: DefaultDecoder, which: int) -> FootNow:
    foot = decoder.foot(which)
    moving, acts = bool(foot["moving"]), bool(foot["moving"]) and bool(foot["sure"])
    kind = float(foot["now"] if acts and foot["now"] != s.UNKNOWN else foot["kind"])
    takes_part = acts or (foot["t_s"] - foot["on_s"] < _LINGERS_S and bool(foot["actions"]))
    word = _KINDS.get(kind, "moves") if takes_part else "moves" if moving else "still"
    size = min(1.0, float(foot["rate_peak"]) / _USUAL_RATE) if acts else 0.4
    yaw_rad = float(foot["yaw"]) if moving else 0.0
    return FootNow(word, size, moving, takes_part, acts and kind == s.TWIST, yaw_rad)


class History:
    """The last seconds, thirty rows a second."""

    def __init__(self) -> None:
        self._rows: deque[tuple[float, ...]] = deque(maxlen=round(SPAN_S / EVERY_S))
        self._next_s = 0.0

    def add(self, t_s: float, rates: tuple[float, float], feet: tuple[FootNow, FootNow]) -> bool:
        """A row, if one is due; ``rates`` are the largest since the last."""
        if t_s < self._next_s and t_s > self._next_s - 10.0:
            return False
        self._next_s = t_s + EVERY_S
        a, b = feet
        self._rows.append(
            (t_s, *rates, a.swing, b.swing, a.motion, b.motion, a.yaw_rad, b.yaw_rad, a.yaw, b.yaw)
        )
        return True

    def machines(self, limits: tuple[float, float]) -> Machines | None:
        """The columns; None before the second row."""
        if len(self._rows) < 2:
            return None
        table = np.array(self._rows, dtype=np.float64).T
        pairs: list[tuple[Floats, Floats]] = [(table[i], table[i + 1]) for i in range(1, 11, 2)]
        rate, swing, motion, yaw_rad, yaw = pairs
        return Machines(table[0], rate, swing, motion, yaw_rad, yaw, *limits)
