"""Heart: the words of the town mode: what a person may ask for, and all that the page shows of a visit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from app.motion.basics import Floats, MotionId, Role
from app.motion.commands import MoverCommand


@dataclass(frozen=True)
class Steer(MoverCommand):
    """Keys held down: some of ``f b l r`` (forward, back, left, right) and ``s`` (aside, with l or r)."""

    keys: str


@dataclass(frozen=True)
class Halt(MoverCommand):
    """The emergency stop: the camera comes to rest and stays so."""


@dataclass(frozen=True)
class GoOn(MoverCommand):
    """The end of an emergency stop."""


@dataclass(frozen=True)
class NextVisitor(MoverCommand):
    """Back to the start with fresh thresholds and no score."""


@dataclass(frozen=True)
class SetUp(MoverCommand):
    """Begin the guided set-up, or leave it."""

    on: bool


@dataclass(frozen=True)
class ChooseDecoder(MoverCommand):
    """``default`` or ``papers``."""

    name: str


@dataclass(frozen=True)
class Tune(MoverCommand):
    """A number of ``TUNABLE``."""

    name: str
    value: float


@dataclass(frozen=True)
class Switch(MoverCommand):
    """One of ``SWITCHES``, on or off."""

    name: str
    on: bool


@dataclass(frozen=True)
class SaveVisitor(MoverCommand):
    """Keep the visitor's thresholds under a name."""

    name: str


@dataclass(frozen=True)
class LoadVisitor(MoverCommand):
    """Thresholds kept before."""

    name: str


class Knob(NamedTuple):
    """A number a person may move: label, unit, safe range, default, one sentence."""

    label: str
    unit: str
    low: float
    high: float
    default: float
    sentence: str


#: Of the default decoder, of the camera and of the simulated feet, in the order shown.
TUNABLE: Mapping[str, Knob] = {
    "on_radps": Knob("A foot moves above", "rad/s", 0.2, 2.0, 0.5,
                     "Lower hears smaller steps, higher ignores shifting."),
    "sure_rad": Knob("An action turns at least", "rad", 0.03, 0.3, 0.07,
                     "A foot has to turn this far before it counts."),
    "forward_m": Knob("Way for each pair of steps", "m", 0.3, 3.0, 1.2,
                      "Speed is this, times the pace of the feet."),
    "turn_share": Knob("Turning for each twist", "×", 0.3, 4.0, 1.5,
                       "The view turns so many times the foot's own twist."),
    "most_mps": Knob("Fastest walk", "m/s", 0.3, 4.0, 3.0, "The camera never goes faster."),
    "start_mps2": Knob("Setting off", "m/s²", 0.5, 6.0, 2.0, "Lower is gentler on the stomach."),
    "pace_hz": Knob("Simulated pace", "Hz", 0.5, 2.0, 1.1, "Whole cycles a second of the simulated feet."),
    "size": Knob("Simulated size", "×", 0.3, 1.5, 1.0, "How lively the simulated feet step."),
}  # fmt: skip
#: Name → label, at first, one sentence.
SWITCHES: Mapping[str, tuple[str, bool, str]] = {
    "bob": ("Head bob", True, "The view rises and sinks a little with the steps."),
    "vignette": ("Vignette", False, "The edges darken while moving: easier on the stomach."),
    "map": ("Map", True, "The small map in the corner."),
    "swapped": ("Feet swapped", False, "The left sensor is on the right foot."),
    "stroll": ("Walk by itself", True, "Simulated feet look for the targets until somebody takes the keys."),
}


class FootLight(NamedTuple):
    """One foot as the decoder hears it now, and how lively (0 to 1)."""

    role: Role
    state: str  # still, moves, step, twist, back, taps, silent, missing, rubbish
    size: float
    rate_hz: float


class Machines(NamedTuple):
    """The decoder's machines over the last seconds: arrays of one length, per foot where a pair."""

    t_s: Floats
    rate_radps: tuple[Floats, Floats]
    swing: tuple[Floats, Floats]  # 0 or 1
    motion: tuple[Floats, Floats]  # 0 or 1
    yaw_rad: tuple[Floats, Floats]
    yaw: tuple[Floats, Floats]  # 0 or 1
    rate_threshold_radps: float
    yaw_threshold_rad: float


class Task(NamedTuple):
    """What the guided set-up asks for now."""

    title: str
    words: str
    part: float  # 0 to 1 of this step
    number: int
    of: int
    good: bool | None  # None while it goes on
    note: str


class Goal(NamedTuple):
    """The target to walk to."""

    north: float
    east: float
    radius_m: float
    distance_m: float


@dataclass(frozen=True)
class Visit:
    """All that the page needs at one instant. The scene is a function of it."""

    t_s: float
    north: float
    east: float
    heading_rad: float
    eye_m: float
    speed_mps: float  # of the camera
    turn_radps: float
    motion: MotionId
    certain: bool
    confidence: float
    cadence_hz: float
    reason: str
    feet: tuple[FootLight, FootLight]
    fault: str = ""  # a sensor's, in words; the camera is at rest
    message: str = ""
    halted: bool = False
    touching: bool = False
    goal: Goal | None = None
    score: int = 0
    targets: int = 0
    hunt_s: float = 0.0
    best_s: float | None = None
    reached: bool = False  # a target, a moment ago
    task: Task | None = None
    decoder: str = "default"
    feet_from: str = ""  # where the feet come from: a source's name, the keys
    simulated: bool = False
    latency_ms: float | None = None
    idle_s: float | None = None  # seconds until the next visitor, once nobody seems to be there
    tuning: Mapping[str, float] = field(default_factory=dict)
    switches: Mapping[str, bool] = field(default_factory=dict)
    visitors: tuple[str, ...] = ()
    machines: Machines | None = None
