"""Heart: what a source of samples says of itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import Floats, Role
from app.motion.samples import ClockLine

Truth = Callable[[str, Floats], tuple[Floats, Floats]]
"""A simulator's truth: (sensor, seconds since its first sample [n]) → position_n [n, 3] m from the
start, q_nb [n, 4]. Closed form, so any instant can be asked for."""


class Outline(NamedTuple):
    """A recording's trails as it tells them itself: shown while its samples are read."""

    name: str
    duration_s: float
    ways: tuple[tuple[Role, NDArray[np.float32]], ...]  # [k, 2, 3] in n


@dataclass(frozen=True)
class SourceInfo:
    """What a source says of itself before its first sample."""

    name: str
    format: str
    sensors: Mapping[str, Role] = field(default_factory=dict)
    rate_hz: float = 0.0  # nominal; 0 unknown
    assumed: tuple[str, ...] = ()
    dropped: Mapping[str, int] = field(default_factory=dict)
    duration_s: float | None = None  # None: live, no end known
    truth: Truth | None = None
    line: Mapping[str, int] = field(default_factory=dict)  # what became of a live link's bytes, in words
    clocks: Mapping[str, ClockLine] = field(default_factory=dict)  # a recording's, by sensor
    serials: Mapping[str, str] = field(default_factory=dict)  # serial numbers, by sensor, where known
    places: Mapping[str, str] = field(default_factory=dict)  # where each sensor is read, where places differ
    temperatures: Mapping[str, float] = field(default_factory=dict)  # °C now, by sensor, where told
    rod_m: float | None = None  # the sensor hangs on a pendulum of this length
    outline: Outline | None = None
    seed: int | None = None  # of a simulator's noise, and of the errors that the lab adds


class Link(StrEnum):
    """What the source is doing."""

    WAITING = "waiting"
    LIVE = "live"
    PAUSED = "paused"
    ENDED = "ended"
    LOST = "lost"
