"""Heart: messages of many senders made into one stream of samples per sensor: none twice, gaps counted.

A sample is known by its session and number. A sender that starts anew begins a new session: its clock and
its numbers go on behind the old ones, over a gap that nothing is integrated across. An older session of
the same sensor is then over: what still comes of it is refused.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field

from app.formats.mounting import AS_GIVEN
from app.formats.options import Options
from app.formats.saturation import RANGES, Range
from app.formats.wire.making import Maker
from app.formats.wire.message import Malformed, Message, decode
from app.formats.wire.reply import Ack
from app.formats.wire.stream import Counters
from app.motion.samples import GAP_NS, Sample

MOST_SENSORS = 64
_KEPT_SESSIONS = 16
_MANY = 200  # repeated in a row: the sender hardly means it
#: A stamp that runs ahead of the host's clock by more is believed when the next one follows it.
LEAP_NS = 60_000_000_000
#: A sender's clock that fell back is believed after so many stamps that follow each other.
_FELL_BACK = 8


@dataclass
class _Stream:
    """One sensor: which session it is in, and what has been taken of it."""

    session: int
    next: int  # the number that comes next
    clock_ns: int = 0  # to add to the sender's stamps
    count: int = 0  # to add to its numbers
    sender_ns: int = -1  # its newest stamp
    last: Sample | None = None
    repeated: int = 0  # in a row
    odd_ns: int = -1  # the last stamp that did not fit
    odd: int = 0  # of those that follow each other, how many
    over: deque[int] = field(default_factory=lambda: deque(maxlen=_KEPT_SESSIONS))  # sessions before


class Intake:
    """Takes messages in any order and says what is new in them.

    ``options``: ``foot`` names a sensor that calls itself otherwise, and picks one foot of two; ``axes``
    is the sensor's mounting (without it, messages are in the shoe's axes already); ``rate_hz`` replaces
    the sender's stamps; ``device`` tells its ranges.
    """

    def __init__(self, options: Options | None = None) -> None:
        self.counters = Counters()
        self.notes: list[str] = []
        self.temperatures: Mapping[str, float] = {}  # °C, of sensors that tell it
        self._options = options or Options()
        self._streams: dict[str, _Stream] = {}
        self._makers: dict[str, Maker] = {}

    def take(self, data: bytes | str, host_ns: int) -> tuple[list[Sample], Ack | Malformed]:
        """The new samples in a message that arrived at ``host_ns``, and what to answer its sender."""
        size = len(data)
        self.counters.bytes_fed += size
        message = decode(data, host_ns)
        if isinstance(message, Malformed):
            self.counters.bytes_skipped += size
            self.counters.bad_checksum += 1
            return [], message
        self.counters.bytes_good += size
        self.counters.packets += 1
        return self.take_message(message, host_ns)

    def take_message(self, message: Message, host_ns: int) -> tuple[list[Sample], Ack | Malformed]:
        """The same for a message that has been read already."""
        sent_as = message.samples[0].sensor
        name = self._name(sent_as)
        if name is None:
            self.counters.unknown += 1
            return [], Malformed(f"{sent_as}: this receiver was told to take only {self._options.foot}")
        stream = self._stream(name, message, host_ns)
        if isinstance(stream, Malformed):
            self.counters.unknown += 1
            return [], stream
        if message.temperature_c is not None:  # another thread may be reading
            self.temperatures = {**self.temperatures, name: message.temperature_c}
        taken = self._new(stream, name, message.samples)
        return taken, Ack(message.session, sent_as, stream.next)

    def _name(self, name: str) -> str | None:
        foot = self._options.foot
        if foot is None or name == foot:
            return name
        return None if name in ("left", "right") and foot in ("left", "right") else foot

    def _stream(self, name: str, message: Message, host_ns: int) -> _Stream | Malformed:
        first = message.samples[0]
        stream = self._streams.get(name)
        if stream is None:
            if len(self._streams) >= MOST_SENSORS:
                return Malformed(f"{name}: {MOST_SENSORS} sensors are known already")
            stream = self._streams[name] = _Stream(message.session, first.seq)
        elif message.session in stream.over:
            return Malformed(f"{name}: another sender, or a later start of this one, has taken over")
        elif message.session != stream.session:
            self._begin_anew(stream, message.session, first, host_ns)
        return stream

    def _begin_anew(self, stream: _Stream, session: int, first: Sample, host_ns: int) -> None:
        stream.over.append(stream.session)
        stream.session, stream.next, stream.sender_ns, stream.odd = session, first.seq, -1, 0
        if stream.last is not None:
            passed_ns = max(host_ns - stream.last.host_ns, GAP_NS + 1)
            stream.clock_ns = stream.last.device_ns + passed_ns - self._stamp(first)
            stream.count = stream.last.seq + 1 - first.seq

    def _new(self, stream: _Stream, name: str, samples: list[Sample]) -> list[Sample]:
        known = min(max(stream.next - samples[0].seq, 0), len(samples))
        self._count_repeated(stream, name, known, len(samples))
        if known < len(samples):
            self.counters.lost += samples[known].seq - stream.next
            stream.next = samples[-1].seq + 1
        made = []
        for sample in samples[known:]:
            ready = self._ready(stream, name, sample) if _fits(stream, sample) else None
            if ready is None:
                self.counters.dropped += 1
                continue
            stream.sender_ns, stream.last = sample.device_ns, ready
            made.append(ready)
        return made

    def _count_repeated(self, stream: _Stream, name: str, known: int, count: int) -> None:
        self.counters.repeated += known
        stream.repeated = stream.repeated + known if known == count else 0
        if stream.repeated >= _MANY:
            self._note(
                f"{name}: the same numbers again and again: a sender chooses a new session when it starts"
            )

    def _ready(self, stream: _Stream, name: str, sample: Sample) -> Sample | None:
        """The sample under the name, number and time that it has here, in the shoe's axes."""
        stamp_ns = self._stamp(sample) + stream.clock_ns
        seq = sample.seq + stream.count
        if self._options.axes is None and self._options.device is None:
            if stamp_ns == sample.device_ns and seq == sample.seq and name == sample.sensor:
                return sample
            return sample._replace(sensor=name, seq=seq, device_ns=stamp_ns)
        turned = self._maker(name).make(
            stamp_ns,
            sample.host_ns,
            sample.specific_force_b,
            sample.angular_rate_b,
            sample.field_b,
            sample.saturation,
            sample.device_q_nb,
        )
        return None if turned is None else turned._replace(seq=seq)

    def _stamp(self, sample: Sample) -> int:
        rate_hz = self._options.rate_hz
        return sample.device_ns if rate_hz is None else round(sample.seq * 1e9 / rate_hz)

    def _maker(self, name: str) -> Maker:
        if name not in self._makers:
            known = RANGES[self._options.device] if self._options.device else Range()
            self._makers[name] = Maker(name, self._options.axes or AS_GIVEN, known)
        return self._makers[name]

    def _note(self, sentence: str) -> None:
        if sentence not in self.notes:
            self.notes.append(sentence)


def _fits(stream: _Stream, sample: Sample) -> bool:
    """Whether its stamp goes on from the newest. A lone wild one is refused and changes nothing.

    A clock that was really set ahead leaves a gap; one that was really set back goes on behind a gap.
    """
    step_ns, last = sample.device_ns - stream.sender_ns, stream.last
    host_ns = max(sample.host_ns - last.host_ns, 0) if last else 0
    if last is None or stream.sender_ns < 0 or 0 < step_ns <= host_ns + LEAP_NS:
        stream.odd = 0
        return sample.device_ns > stream.sender_ns
    follows = stream.odd > 0 and 0 < sample.device_ns - stream.odd_ns <= GAP_NS
    stream.odd, stream.odd_ns = (stream.odd + 1 if follows else 1), sample.device_ns
    if stream.odd < (2 if step_ns > 0 else _FELL_BACK):
        return False
    if step_ns <= 0:
        stream.clock_ns = last.device_ns + max(host_ns, GAP_NS + 1) - sample.device_ns
    stream.odd = 0
    return True
