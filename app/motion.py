"""Heart: the words two rooms share: sample, row, phase, command, snapshot.

Frames: *b* is the shoe (x toe, y right, z down), *n* is north–east–down. A quaternion ``q_nb`` is
a unit Hamilton quaternion, wxyz, and takes body vectors into *n*. Everything is SI and radians; the
magnetic field is in µT. Degrees live in ``scene/`` only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.settings import Settings

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

#: Where the door gives what is seen as one file to keep.
HAND_IN = "/hand-in"
#: Two stamps further apart than this are two segments: nothing is integrated across.
GAP_NS = 250_000_000


class Role(StrEnum):
    """Where a sensor sits. ``FOOT`` is one foot of which nobody said left or right."""

    LEFT = "left"
    RIGHT = "right"
    FOOT = "foot"
    OTHER = "other"


def role_of(sensor: str) -> Role:
    """The role a sensor's bare name stands for: ``left`` is the left foot, an unknown name a foot."""
    return Role(sensor) if sensor in set(Role) else Role.FOOT


class GaitPhase(IntEnum):
    """The two states of the gait-phase machine (2012 paper, Fig. 5)."""

    STANCE = 0
    SWING = 1


class MotionId(IntEnum):
    """What the feet ask for (dissertation, Table 14); 8 on are the project's own. Sent over UDP as it is."""

    NONE = 0
    FORWARD = 1
    FORWARD_RIGHT = 2
    FORWARD_LEFT = 3
    SIDE_RIGHT = 4
    SIDE_LEFT = 5
    TURN_CW = 6
    TURN_CCW = 7
    BACKWARD = 8


# --- samples -------------------------------------------------------------------------------------


class Sample(NamedTuple):
    """One reading of one sensor, in the shoe's axes. ``seq`` counts per sensor.

    ``specific_force_b`` is what an accelerometer reads: (0, 0, −g) m/s² at rest, pointing up.
    ``saturation`` has bit i set when channel i (force xyz, rate xyz, field xyz) is at its range.
    ``device_q_nb`` is the orientation the sensor computed itself, if it does.
    """

    sensor: str
    seq: int
    device_ns: int
    host_ns: int
    specific_force_b: Vector  # m/s²
    angular_rate_b: Vector  # rad/s
    field_b: Vector | None = None  # µT; relative (about 1) where the device has no unit
    saturation: int = 0
    device_q_nb: Quaternion | None = None


class Column(IntEnum):
    """Columns of a sample matrix, float64 [n, 10]: the form the compiled steps read.

    ``ELAPSED_NS`` is whole nanoseconds since the sensor's first sample: exact up to 104 days.
    A missing magnetometer is NaN.
    """

    ELAPSED_NS = 0
    FX = 1
    FY = 2
    FZ = 3
    WX = 4
    WY = 5
    WZ = 6
    MX = 7
    MY = 8
    MZ = 9


SAMPLE_WIDTH = len(Column)


@dataclass(frozen=True)
class Samples:
    """All samples of one sensor in columns: what an importer makes and a batch reads.

    Stamps increase strictly and every force and rate is finite: ``formats.clean`` dropped the
    rest and says how many. ``matrix`` is [n, 10] by ``Column``; ``device_ns`` is the first stamp.
    """

    sensor: str
    role: Role
    device_ns: int
    matrix: Floats
    saturation: NDArray[np.uint16]
    dropped: Mapping[str, int] = field(default_factory=dict)  # reason in words → rows
    device_q_nb: Floats | None = None  # [n, 4] what the sensor itself computed, NaN where it did not

    def __len__(self) -> int:
        return len(self.matrix)

    @property
    def duration_s(self) -> float:
        """Seconds from the first stamp to the last; 0 with fewer than two."""
        return float(self.matrix[-1, 0] - self.matrix[0, 0]) * 1e-9 if len(self) > 1 else 0.0

    @property
    def rate_hz(self) -> float:
        """Median sample rate; 0 with fewer than two samples."""
        return 1e9 / float(np.median(np.diff(self.matrix[:, 0]))) if len(self) > 1 else 0.0


class ClockLine(NamedTuple):
    """Where a sensor's clock showed ``device_ns`` the host's showed ``host_ns``, and how they part."""

    device_ns: int
    host_ns: int
    slope: float = 0.0  # host seconds gained on each second of the sensor's

    def host(self, device_ns: int) -> int:
        """A stamp on the host's clock, as if no sample had been delayed more than the least delayed."""
        passed = device_ns - self.device_ns
        return self.host_ns + passed + round(passed * self.slope)

    @property
    def drift_ppm(self) -> float:
        """How much too fast the sensor's clock runs; negative: too slow."""
        return (1.0 / (1.0 + self.slope) - 1.0) * 1e6


class Rows(NamedTuple):
    """Rows ``first`` to ``last`` (exclusive) of a sensor's samples."""

    samples: Samples
    first: int
    last: int


class GyroBias(NamedTuple):
    """A sensor's gyro bias as found once: what it reads at rest, in its axes, and σ of each, rad/s."""

    rate_b: Vector
    doubt_radps: Vector


@dataclass(frozen=True, eq=False)
class Stretch:
    """Many samples of a recording at once, as a seek passes over them.

    ``rows`` are in the order in which the sensors come first; ``each`` makes the samples one by one.
    A sensor's row whose number is a multiple of ``BLOCK`` ends a stretch.
    """

    rows: tuple[Rows, ...]
    host_ns: int
    each: Callable[[], list[Sample]]

    def __len__(self) -> int:
        return sum(rows.last - rows.first for rows in self.rows)


class Saved(NamedTuple):
    """One foot's estimate between two swings: all that it takes to go on from there."""

    settings: Settings
    row: int  # samples before it
    state: bytes  # of the estimator's own record
    newest: tuple[float, ...]  # the last row
    strides: int
    distance_m: float
    contact: tuple[float, Vector, float] | None  # the last footprint: seconds, where, heading in rad


class Way(NamedTuple):
    """A foot's trail over rows ``first`` to ``last`` (exclusive), decimated for drawing."""

    first: int
    last: int
    segments: NDArray[np.float32]  # [k, 2, 3] in n


@dataclass(frozen=True, eq=False)
class Landing:
    """A leap over many samples of a recording: each foot goes on from a state saved near its end.

    ``steps`` gives the same samples in stretches, for whom the states are of no use.
    """

    stretch: Stretch
    saved: Mapping[str, Saved]
    ways: Mapping[str, Way]  # to those states, from the start
    steps: Callable[[], Iterator[Stretch]]

    def __len__(self) -> int:
        return len(self.stretch)


@dataclass(frozen=True)
class Journal:
    """How a recording of ours came to be: the order in which samples and orders were taken.

    ``arrivals`` [n] is which sensor (its place in ``Recording.sensors``) gave each sample, ``elapsed_ns``
    [n] when, from the first. An order stands with the number of samples before it, and so do the messages
    that hold an estimate (``formats/states``), each with its sensor.
    """

    settings: Settings  # the main track's, when it began
    candidate: Settings  # the sliders'
    apply_at_once: bool
    arrivals: Ints
    elapsed_ns: Ints
    orders: tuple[tuple[int, Order], ...] = ()
    markers: tuple[tuple[float, str], ...] = ()  # seconds from the first sample, text
    states: tuple[tuple[int, str, bytes], ...] = ()
    ways: tuple[tuple[int, str, bytes], ...] = ()


@dataclass(frozen=True)
class Recording:
    """A whole recording as the importers give it.

    ``assumed`` are sentences for the user: rate, units and mounting that the file does not say
    ("256 Hz assumed: the file has no times"). ``spec`` is the source that made it, if it says so
    (a simulator's recording), so that its truth can be computed again.
    """

    name: str
    format: str
    sensors: tuple[Samples, ...]
    assumed: tuple[str, ...] = ()
    spec: str | None = None
    dropped_rows: int = 0
    journal: Journal | None = None  # a recording of ours
    clocks: Mapping[str, ClockLine] = field(default_factory=dict)  # by sensor; none: one clock stamped all
    rod_m: float | None = None  # the sensor hangs on a pendulum of this length
    serials: Mapping[str, str] = field(default_factory=dict)  # serial numbers, by sensor, where known

    @property
    def duration_s(self) -> float:
        """Seconds from the first stamp of any sensor to the last of any."""
        if not self.sensors:
            return 0.0
        start = min(s.device_ns for s in self.sensors)
        end = max(s.device_ns + int(s.matrix[-1, 0]) for s in self.sensors if len(s))
        return (end - start) * 1e-9


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
    rod_m: float | None = None  # the sensor hangs on a pendulum of this length
    outline: Outline | None = None
    seed: int | None = None  # of a simulator's noise, and of the errors that the lab adds


class InputError(ValueError):
    """The user's input is wrong. The message is one line: the thing, what came, what was expected."""


# --- rows ----------------------------------------------------------------------------------------


class RowColumn(IntEnum):
    """Columns of a track's rows, float64 [n, 13]: one row per sample."""

    NORTH = 0
    EAST = 1
    DOWN = 2
    VN = 3
    VE = 4
    VD = 5
    QW = 6
    QX = 7
    QY = 8
    QZ = 9
    PHASE = 10
    STATISTIC = 11
    THRESHOLD = 12  # what the statistic is held against, in its unit


ROW_WIDTH = len(RowColumn)
POSITION = slice(0, 3)
VELOCITY = slice(3, 6)
ATTITUDE = slice(6, 10)


class Stride(NamedTuple):
    """From one initial contact to the next of the same foot (so: a stance, then a swing).

    The first stride of a segment has no contact before it: it starts where its swing starts and
    its ``stance_s`` is 0. ``length_m`` is horizontal, start to end. ``turn_rad`` is positive to
    the left (opposite to NED yaw). ``lift_m`` is the highest point of the sensor above the line
    from start to end; it is not toe clearance. ``end_n`` is the footprint.
    """

    number: int
    start_s: float
    end_s: float
    length_m: float
    duration_s: float
    swing_s: float
    stance_s: float
    lift_m: float
    turn_rad: float
    end_n: Vector
    heading_rad: float  # NED yaw of the toe at the footprint


# --- commands: what a person asks for, frozen, numbered with the samples --------------------------


@dataclass(frozen=True)
class SetCandidate:
    """Move sliders: these settings become the candidate track's."""

    changes: tuple[tuple[str, float | bool | str], ...]


@dataclass(frozen=True)
class ReplaceCandidate:
    """A whole record (a profile, the reset button, the best gains) becomes the candidate's."""

    settings: Settings
    reason: str


@dataclass(frozen=True)
class ApplyCandidate:
    """The candidate becomes the main track, past and present."""


@dataclass(frozen=True)
class DropCandidate:
    """The candidate goes, the sliders go back to the main track's settings."""


@dataclass(frozen=True)
class Undo:
    """Back to the settings before the last apply (another Undo goes further)."""


@dataclass(frozen=True)
class SetApplyAtOnce:
    """Whether a moved slider applies by itself."""

    on: bool


@dataclass(frozen=True)
class KeepAs:
    """Remember the main track's settings as slot ``A`` or ``B``."""

    slot: str


@dataclass(frozen=True)
class SwapAB:
    """Apply the other one of A and B."""


@dataclass(frozen=True)
class ResetHeading:
    """Turn the whole walk so that the toe now points north (or to the reference)."""


@dataclass(frozen=True)
class RestartHere:
    """Forget the walk so far and start again at the next sample."""


@dataclass(frozen=True)
class LookBack:
    """The walk stands still or is over: if its settings ask for hindsight, smooth it as far as it goes."""


@dataclass(frozen=True)
class KnowBias:
    """Before a sensor's first sample: its gyro bias as remembered, for the walk to begin with."""

    sensor: str
    rate_b: Vector  # rad/s
    doubt_radps: Vector
    source: str  # when it was found, in words


SessionCommand = (
    SetCandidate | ReplaceCandidate | ApplyCandidate | DropCandidate | Undo
    | SetApplyAtOnce | KeepAs | SwapAB | ResetHeading | RestartHere | LookBack | KnowBias
)  # fmt: skip


@dataclass(frozen=True)
class FindGains:
    """Sweep k_s × k_d over the walk so far and offer the best as the candidate."""


@dataclass(frozen=True)
class LoadProfile:
    """Make a saved profile the candidate."""

    name: str


@dataclass(frozen=True)
class SaveProfile:
    """Save the main track's settings under a name."""

    name: str


@dataclass(frozen=True)
class Pause:
    """Hold or go on with a replay."""

    on: bool


@dataclass(frozen=True)
class Step:
    """While paused: a few samples on."""

    samples: int = 1


@dataclass(frozen=True)
class Speed:
    """Replay at this multiple of the recorded pace, 0.1 to 8; 0 is as fast as possible."""

    factor: float


@dataclass(frozen=True)
class Seek:
    """Go to this second of a recording."""

    t_s: float


@dataclass(frozen=True)
class Loop:
    """Start again at the end of a recording."""

    on: bool


@dataclass(frozen=True)
class SetErrors:
    """Give a simulated sensor these errors (``simulate.lab``), from now on."""

    changes: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class TakeLesson:
    """The errors and settings of a lesson, by its name."""

    name: str


@dataclass(frozen=True)
class Swing:
    """Let the pendulum go from this angle."""

    angle_deg: float


@dataclass(frozen=True)
class OpenTown:
    """Open the town mode beside the walk, with simulated feet."""


@dataclass(frozen=True)
class Record:
    """Begin or end a recording."""

    on: bool


@dataclass(frozen=True)
class Mark:
    """Mark this moment in the recording."""

    text: str = ""


@dataclass(frozen=True)
class Share:
    """Make a page that plays a recording of the library offline, under the main track's settings."""

    name: str


@dataclass(frozen=True)
class Play:
    """Leave this source and play a recording of the library, by its file's name."""

    name: str


@dataclass(frozen=True)
class Rename:
    """Give a recording of the library another name."""

    name: str
    to: str


@dataclass(frozen=True)
class SetDeclination:
    """How far magnetic north lies east of true north, for the GPS track beside the walk."""

    degrees: float


@dataclass(frozen=True)
class Calibrate:
    """The guided calibration: ``start``, ``back``, ``save``, ``undo``, ``redo`` or ``cancel``."""

    do: str
    sensor: str = ""


@dataclass(frozen=True)
class CheckFirst:
    """The look before a walk: ``start``, ``skip``, ``swap`` or ``close``."""

    do: str


@dataclass(frozen=True)
class MoverCommand:
    """What a person asks of the town mode; ``visit.py`` has the kinds."""


ReplayCommand = Pause | Step | Speed | Seek | Loop | SetErrors
Command = (
    SessionCommand
    | FindGains
    | LoadProfile
    | SaveProfile
    | ReplayCommand
    | Record
    | Mark
    | Play
    | Share
    | Rename
    | SetDeclination
    | Calibrate
    | CheckFirst
    | MoverCommand
    | TakeLesson
    | Swing
    | OpenTown
)


class Order(NamedTuple):
    """A command with who gave it and when: what the door and the scene hand over."""

    command: Command
    who: str
    host_ns: int


# --- what the page is told ------------------------------------------------------------------------


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


class Light(StrEnum):
    """How sound a sensor's stream is; the value is the word that stands beside the colour."""

    GREEN = "good"
    AMBER = "check"
    RED = "bad"


class Recent(NamedTuple):
    """One sensor over the last ten seconds. None: not known, or there is nothing to tell it from."""

    rate_hz: float
    samples: int
    lost: int  # missing between stamps
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


class Trust(NamedTuple):
    """How sure an estimator is of where a foot is: the ellipse that holds it 95 times of 100, and a word."""

    major_m: float  # half axes of the ellipse on the floor
    minor_m: float
    angle_rad: float  # of the major axis, clockwise from north
    word: str  # "good" | "drifting" | "lost"
    why: str  # empty where it is good


class Compass(NamedTuple):
    """Whether the magnetic field was the same at the last footprints, and if not, what of it changed."""

    steady: bool
    why: str  # empty where it is steady


class FootView(NamedTuple):
    """One foot of one track, now."""

    sensor: str
    role: Role
    t_s: float
    position_n: Vector
    velocity_n: Vector
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


class CalibrationView(NamedTuple):
    """Which sensors are corrected, and a calibration under way or just ended."""

    sensors: tuple[str, ...]  # that can be calibrated
    applied: Mapping[str, str]  # sensor → when its calibration was made
    undone: tuple[str, ...]  # sensors with one that is not applied
    guide: GuideView | None = None
    found: tuple[str, ...] = ()  # the result in lines, once it is done
    damaged: str = ""  # one line: a file that cannot be used


class OwnView(NamedTuple):
    """The walk by the orientation that a sensor computed itself, now."""

    position_n: Vector
    q_nb: Quaternion  # turned so that its heading is ours where the walk begins
    trail: Trail
    distance_m: float
    to_start_m: float
    tilt_rad: float  # between its down and ours
    heading_rad: float  # its heading less ours


class TrackView(NamedTuple):
    """One named track, now."""

    name: str
    settings: Settings
    feet: tuple[FootView, ...]
    smoothed_s: float | None = None  # estimated in hindsight up to this time; None: as it was live
    linked: bool = False  # two feet have one heading


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


class Sweep(NamedTuple):
    """What "find gains" found: closure in metres over a grid of gains."""

    gains_stance: Floats  # [a]
    gains_swing: Floats  # [b]
    closure_m: Floats  # [a, b]
    best: tuple[float, float]


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
    pendulum: PendulumView | None = None  # the sensor hangs on a rod: this is no walk


class Link(StrEnum):
    """What the source is doing."""

    WAITING = "waiting"
    LIVE = "live"
    PAUSED = "paused"
    ENDED = "ended"
    LOST = "lost"


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
