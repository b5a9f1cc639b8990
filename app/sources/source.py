"""Edge: what every source of samples offers, live or replayed, and the honest answers of a live one."""

from __future__ import annotations

from collections.abc import AsyncIterator, Mapping, Sequence
from typing import Protocol

from app.formats.wire.stream import Counters
from app.motion.basics import InputError
from app.motion.commands import Order, ReplayCommand, RestartHere
from app.motion.recording import Landing, Stretch
from app.motion.samples import Sample
from app.motion.source import Link, SourceInfo
from app.settings import Settings

#: What a source yields. Only a replay yields orders (those recorded) and ``RestartHere``, and stretches only
#: to whom asks for them.
Item = Sample | Order | RestartHere | Stretch | Landing


class Source(Protocol):
    """Iterate it once, on the loop that also calls everything else here. Nothing here ever waits.

    Bad commands raise ``InputError``. ``info`` may change while it runs: a device is identified, another
    sensor appears. A live source reads on while nobody iterates, so that no sample waits for a reader.
    """

    @property
    def info(self) -> SourceInfo:
        """What is known of it now."""

    @property
    def link(self) -> Link:
        """What it is doing."""

    @property
    def detail(self) -> str:
        """One line for the person on the link, or nothing: ``COM3 is gone: trying again in 2 s``."""

    @property
    def replay(self) -> bool:
        """Whether ``control`` does anything: False for a live source."""

    @property
    def speed(self) -> float:
        """Times the recorded pace."""

    @property
    def loop(self) -> bool:
        """Whether it begins anew at its end."""

    @property
    def position_s(self) -> float:
        """Where a replay is, in seconds from its first sample."""

    @property
    def settings(self) -> Settings | None:
        """What a recorded walk began with, if it is to be repeated with its changes."""

    @property
    def made_by(self) -> str | None:
        """The SPEC of the simulator behind it, for a recording of it."""

    @property
    def errors(self) -> Mapping[str, float] | None:
        """What is wrong with a simulated sensor, by name; None: it is no simulation."""

    @property
    def counters(self) -> Mapping[str, Counters]:
        """What became of the bytes, by sensor; nothing for a replay."""

    def control(self, command: ReplayCommand) -> None:
        """Pause, step, seek, speed, loop."""

    def __aiter__(self) -> AsyncIterator[Item]:
        """The samples, as they come."""

    def close(self) -> None:
        """Let go of ports and sockets; may be called before the first sample, and twice."""

    def unread(self) -> Sequence[Sample]:
        """What came and was not read, once it is closed; senders may have been told that it has come."""


class Live:
    """What is the same for all live sources: they cannot be paused, and know no truth."""

    replay = False
    speed = 1.0
    loop = False
    position_s = 0.0
    settings: Settings | None = None
    made_by: str | None = None
    errors: Mapping[str, float] | None = None

    @property
    def counters(self) -> Mapping[str, Counters]:
        """None are kept."""
        return {}

    def unread(self) -> Sequence[Sample]:
        """Nothing."""
        return ()

    def control(self, command: ReplayCommand) -> None:
        """Refused: what a sensor measures is over when it is over."""
        raise InputError(f"{type(command).__name__.lower()}: only a replay can, this is a live sensor")
