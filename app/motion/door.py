"""Heart: the words about the public port: what it serves, what a browser may say, what is measured."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

#: Where the door gives what is seen as one file to keep.
HAND_IN = "/hand-in"


@dataclass(frozen=True)
class GuiRule:
    """What a browser may write into one control: the door enforces it."""

    kind: str  # "number" | "bool" | "text" | "choice" | "button"
    low: float = -math.inf
    high: float = math.inf
    choices: tuple[str, ...] = ()
    max_length: int = 80


class Measure(NamedTuple):
    """One number for who runs the program: ``/metrics`` tells it. Names and units are Prometheus's."""

    name: str  # "stridescope_samples_total"
    what: str  # a sentence
    value: float
    labels: tuple[tuple[str, str], ...] = ()
