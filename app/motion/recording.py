"""Heart: a recording as it is read: whole, or many samples at once, and how it came to be."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from app.motion.basics import Ints
from app.motion.commands import Order
from app.motion.estimate import Saved, Way
from app.motion.samples import ClockLine, Rows, Sample, Samples
from app.settings import Settings


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
        """Seconds from the first sample of any sensor to the last of any."""
        ends = (self.offset_ns(s) + int(s.matrix[-1, 0]) for s in self.sensors if len(s))
        return max(ends, default=0) * 1e-9

    @property
    def dropped(self) -> dict[str, int]:
        """Rows that were not taken, by reason in words, over all sensors."""
        reasons = {reason: 0 for samples in self.sensors for reason in samples.dropped}
        return {reason: sum(s.dropped.get(reason, 0) for s in self.sensors) for reason in reasons}

    def offset_ns(self, samples: Samples) -> int:
        """How long after the recording's first sample this sensor's came, on the clock that all share."""
        return self._began_ns(samples) - min(map(self._began_ns, self.sensors))

    def _began_ns(self, samples: Samples) -> int:
        line = self.clocks.get(samples.sensor)
        return samples.device_ns if line is None else line.host(samples.device_ns)


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
    temperatures: tuple[tuple[int, str, float], ...] = ()  # samples before it, sensor, °C


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
