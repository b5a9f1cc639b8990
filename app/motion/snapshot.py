"""Heart: what the page is told of a walk: the session at one instant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import Floats, GaitPhase, Quaternion, Role, Vector
from app.motion.estimate import Compass, Toe, Trust
from app.motion.health import Health
from app.settings import Settings


class TrailPiece(NamedTuple):
    """Settled line segments, float32 [k, 2, 3] in *n*. Same ``key``: same content, for good."""

    key: str
    segments: NDArray[np.float32]


class Trail(NamedTuple):
    """A decimated path: settled pieces, the open piece that grows, and the provisional newest stride."""

    pieces: tuple[TrailPiece, ...]
    growing: NDArray[np.float32]  # [k, 2, 3]
    provisional: NDArray[np.float32]  # [k, 2, 3]: not yet corrected by a zero-velocity update


class Footprint(NamedTuple):
    """Where a stride ended."""

    number: int
    position_n: Vector
    heading_rad: float


class Graph(NamedTuple):
    """The last seconds of one foot, decimated for a plot: arrays of one length."""

    t_s: Floats
    statistic: Floats  # |ω| or 0.1·√T, rad/s
    threshold: Floats  # what it is held against
    swing: Floats  # 0 or 1
    speed_mps: Floats
    height_m: Floats


class FootView(NamedTuple):
    """One foot of one track, now."""

    sensor: str
    role: Role
    t_s: float
    position_n: Vector
    q_nb: Quaternion
    phase: GaitPhase
    levelled: bool  # False until the still start has been found
    strides: int
    distance_m: float
    speed_mps: float  # of the last stride; 0 when standing
    cadence_spm: float  # steps a minute = 2 × 60 / stride duration; 0 when standing
    height_m: float
    to_start_m: float
    trail: Trail
    footprints: tuple[Footprint, ...]  # the newest few
    error_m: float | None  # distance to the simulator's truth
    trust: Trust | None = None  # None: the estimator does not know
    compass: Compass | None = None  # None: no magnetic field, or too few footprints
    toe: Toe | None = None  # None: the sensor looks along it, or too few strides told


class TrackView(NamedTuple):
    """One named track, now."""

    name: str
    settings: Settings
    feet: tuple[FootView, ...]
    smoothed_s: float | None = None  # estimated in hindsight up to this time; None: as it was live
    linked: bool = False  # two feet have one heading


class OwnView(NamedTuple):
    """The walk by the orientation that a sensor computed itself, now."""

    position_n: Vector
    q_nb: Quaternion  # turned so that its heading is ours where the walk begins
    trail: Trail
    distance_m: float
    to_start_m: float
    tilt_rad: float  # between its down and ours
    heading_rad: float  # its heading less ours


class PendulumView(NamedTuple):
    """A sensor that hangs on a rod, beside the truth, both at its newest sample; angles from the vertical."""

    rod_m: float
    q_nb: Quaternion = (1.0, 0.0, 0.0, 0.0)
    true_q_nb: Quaternion = (1.0, 0.0, 0.0, 0.0)
    angle_rad: float = 0.0
    true_rad: float = 0.0
    worst_rad: float = 0.0  # the largest error of the last seconds
    period_s: float | None = None  # by the estimate; None: not two swings yet
    true_period_s: float | None = None


class Change(NamedTuple):
    """One applied change, for the log on the page."""

    number: int  # it took effect after this many samples
    host_ns: int
    who: str
    what: str


@dataclass(frozen=True)
class Snapshot:
    """All that the page needs of the session at one instant. The scene is a function of it."""

    number: int  # samples and commands taken
    t_s: float
    main: TrackView
    candidate: TrackView | None
    truth: Mapping[str, Trail]  # the simulator's truth, by sensor
    candidate_settings: Settings  # what the sliders show
    pending: bool  # the candidate is being re-estimated
    apply_at_once: bool
    undo_depth: int
    slots: Mapping[str, Settings]  # A, B
    slot_now: str | None
    changes: tuple[Change, ...]
    graphs: Mapping[str, Graph]
    health: Mapping[str, Health]
    hindsight_from_s: float  # re-estimation reaches back to here
    stored_bytes: int
    budget_bytes: int
    epoch: int  # rises when the walk starts again: everything drawn before is void
    #: The last ten seconds beside a simulator's truth, by sensor: seconds, metres from it, and the pitch
    #: estimated and true, rad: [k, 4].
    errors: Mapping[str, Floats] = field(default_factory=dict)
    own: Mapping[str, OwnView] = field(default_factory=dict)  # of sensors that tell their orientation
    remembered: Mapping[str, str] = field(default_factory=dict)  # whose gyro bias was known: found when
    pendulum: PendulumView | None = None  # the sensor hangs on a rod: this is no walk
