"""Heart: how sound a sensor's stream is, in words and numbers."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from typing import NamedTuple


class Light(StrEnum):
    """How sound a sensor's stream is; the value is the word that stands beside the colour."""

    GREEN = "good"
    AMBER = "check"
    RED = "bad"


class Recent(NamedTuple):
    """One sensor over the last ten seconds. None: not known, or there is nothing to tell it from."""

    rate_hz: float
    samples: int
    lost: int  # missing between stamps, but not where nothing came for long (`cut_s`)
    duplicated: int
    rejected: int  # not finite, or out of order
    saturated: int
    jitter_ms: float | None  # standard deviation of the arrival's delay
    late_ms: float | None  # the longest delay, over the least
    stance_mps2: float | None  # how far |specific force| scatters while the foot stands
    gravity_mps2: float | None  # |specific force| while the foot stands
    disturbance: float | None  # how far the field's strength strays from that of the start, 0.1 = 10 %
    drift_ppm: float | None  # the sensor's clock against the host's, positive: too fast
    silent_s: float  # behind the sensor that came last
    damaged: float = 0.0  # part of what its line brings that makes no packet
    cut_s: float = 0.0  # nothing came for so long at a stretch: no loss of single samples


class Health(NamedTuple):
    """Counters of one sensor since the start, its last ten seconds, and what they come to."""

    rate_hz: float
    taken: int
    dropped: Mapping[str, int]  # reason in words → samples
    saturated: int
    segments: int
    recent: Recent | None = None
    light: Light = Light.GREEN
    reason: str = ""  # what is wrong and what to do, in words; empty where all is well
