"""Heart: what a person asks for: frozen commands, numbered with the samples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from app.motion.basics import Vector
from app.settings import Settings


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
