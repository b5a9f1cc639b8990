"""Heart: what the page is told of all that is around a walk: source, files, calibration, pre-flight."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import Role
from app.motion.estimate import Sweep
from app.motion.source import Link, SourceInfo


class GuideView(NamedTuple):
    """A calibration under way: what to do now, and how far it is."""

    sensor: str
    step: int  # done so far
    steps: int
    words: str
    picture: str  # ``x+``: x down; ``x-``: x up; ``x*``: a round about x
    held: float  # 0…1, how long it lies as it should
    note: str
    coverage: float  # 0…1 of all directions of the field
    directions: frozenset[int]  # which of 6 × 12 parts of them, band by band from the field's −z
    done: bool


class CalibrationView(NamedTuple):
    """Which sensors are corrected, and a calibration under way or just ended."""

    sensors: tuple[str, ...]  # that can be calibrated
    applied: Mapping[str, str]  # sensor → when its calibration was made
    undone: tuple[str, ...]  # sensors with one that is not applied
    guide: GuideView | None = None
    found: tuple[str, ...] = ()  # the result in lines, once it is done
    damaged: str = ""  # one line: a file that cannot be used


class LineState(StrEnum):
    """Of one line of the pre-flight."""

    WAIT = "waiting"
    NOW = "now"
    GOOD = "good"
    BAD = "bad"


class Line(NamedTuple):
    """One line of the pre-flight: what was found, or what to do."""

    name: str
    state: LineState
    told: str


class PreflightView(NamedTuple):
    """The look before a walk."""

    lines: tuple[Line, ...]
    words: str  # what to do now
    done: bool
    good: bool  # done, and every line good
    seconds: float
    names: tuple[tuple[str, Role], ...]  # which sensor is which foot


class ShelfFile(NamedTuple):
    """A file of the library."""

    name: str
    size_bytes: int
    changed: str  # local time, for a person


class RecorderState(NamedTuple):
    """The recording under way, or the last one."""

    name: str  # of the file
    on: bool
    seconds: float
    size_bytes: int
    free_bytes: int  # on its disk
    trouble: str = ""  # one line for a red banner


class Reference(NamedTuple):
    """A way from elsewhere (a GPS track) to show beside the walk."""

    name: str
    segments: NDArray[np.float32]  # [k, 2, 2] metres, magnetic north and east of its start
    length_m: float
    declination_rad: float = 0.0  # that its true north was turned by


@dataclass(frozen=True)
class Status:
    """What the shell knows and the session cannot: clocks, files, the source's state."""

    source: SourceInfo
    link: Link
    stale_s: float = 0.0  # seconds without a sample while LIVE; 0 when fresh
    message: str = ""  # one line for the person (an error, or what is being prepared)
    detail: str = ""  # one line on the link: what is tried, what was found
    replay: bool = False  # pause, step, seek and speed are possible
    speed: float = 1.0
    loop: bool = False
    position_s: float = 0.0
    sweep: Sweep | None = None
    sweep_progress: float | None = None  # 0…1 while it runs
    profiles: tuple[str, ...] = ()
    recording: RecorderState | None = None
    calibration: CalibrationView | None = None
    preflight: PreflightView | None = None
    shelf: tuple[ShelfFile, ...] = ()
    errors: Mapping[str, float] | None = None  # of a simulated sensor, by name; None: it is no simulation
    lesson: str = ""  # the one taken last
    reference: Reference | None = None
    town: str = ""  # where the town mode is, while it is open
