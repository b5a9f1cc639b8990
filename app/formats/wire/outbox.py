"""Heart: samples on their way to a receiver: kept until it says that it has them, within a stated memory."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

from app.formats.wire.message import encode_binary
from app.formats.wire.reply import Ack
from app.motion.samples import Sample

#: Samples in one message: what waits after a cut goes in few messages, a live one goes at once.
MOST_IN_ONE = 100
OVERHEAD = 200  # bytes that a kept message costs beside its own


@dataclass
class Parcel:
    """A message with what it holds: numbers ``first`` to ``end`` (exclusive) of one sensor."""

    session: int
    sensor: str
    first: int
    end: int
    data: bytes
    done: bool = False


class Outbox:
    """Samples in, messages out in the same order. ``rewind`` sends again what was not acknowledged.

    Beyond ``limit_bytes`` the oldest go, and are counted in ``given_up``.
    """

    def __init__(self, session: int, limit_bytes: int) -> None:
        self.given_up = 0  # samples
        self.delivered = 0
        self._session, self._limit_bytes = session, limit_bytes
        self._open: dict[str, list[Sample]] = {}
        self._warmth: dict[str, float] = {}  # to go with the next message
        self._kept: deque[Parcel] = deque()
        self._unsent: deque[Parcel] = deque()
        self._bytes = self._count = 0

    @property
    def waiting(self) -> int:
        """Samples not yet acknowledged."""
        return self._count

    @property
    def full(self) -> bool:
        """Whether a source that can wait should: beyond this the oldest samples will go."""
        return self._bytes > self._limit_bytes // 2

    def begin_anew(self, session: int) -> None:
        """The source starts again: numbers and clocks from here on have nothing to do with those before."""
        self._close_all()
        self._session = session

    def add(self, sample: Sample) -> None:
        """Keep a sample for sending."""
        samples = self._open.setdefault(sample.sensor, [])
        if samples and (sample.seq != samples[-1].seq + 1 or sample.device_ns <= samples[-1].device_ns):
            self._close_all()
            samples = self._open.setdefault(sample.sensor, [])
        samples.append(sample)
        self._count += 1
        if len(samples) >= MOST_IN_ONE:
            self._close_all()

    def warm(self, temperatures: Mapping[str, float]) -> None:
        """What the sensors' thermometers read, °C: goes with each one's next message."""
        self._warmth.update(temperatures)

    def next(self) -> Parcel | None:
        """The next message to send, if there is one."""
        if not self._unsent:
            self._close_all()
        while self._unsent:
            parcel = self._unsent.popleft()
            if not parcel.done:
                return parcel
        return None

    def rewind(self) -> None:
        """After a cut: what was sent and not acknowledged goes again, before all else."""
        self._unsent = deque(parcel for parcel in self._kept if not parcel.done)

    def acknowledge(self, ack: Ack) -> None:
        """The receiver has all before ``ack.next``."""
        for parcel in self._kept:
            if (parcel.session, parcel.sensor) == (ack.session, ack.sensor):
                if parcel.end > ack.next:
                    break
                self._finish(parcel, delivered=True)
        self._tidy()

    def refuse(self, parcel: Parcel) -> None:
        """The receiver does not want this one: it is not sent again."""
        self._finish(parcel, delivered=False)
        self._tidy()

    def _close_all(self) -> None:
        """All open samples into messages: of every sensor, so that the order among them is kept nearly."""
        for samples in self._open.values():
            first, last = samples[0], samples[-1]
            celsius = self._warmth.pop(first.sensor, None)
            data = encode_binary(self._session, samples, doubles=True, temperature_c=celsius)
            parcel = Parcel(self._session, first.sensor, first.seq, last.seq + 1, data)
            self._kept.append(parcel)
            self._unsent.append(parcel)
            self._bytes += len(data) + OVERHEAD
        self._open = {}
        while self._bytes > self._limit_bytes and self._kept:
            self._finish(self._kept[0], delivered=False)
            self._tidy()

    def _finish(self, parcel: Parcel, delivered: bool) -> None:
        if parcel.done:
            return
        parcel.done = True
        count = parcel.end - parcel.first
        self._count -= count
        self.delivered += count if delivered else 0
        self.given_up += 0 if delivered else count

    def _tidy(self) -> None:
        while self._kept and self._kept[0].done:
            self._bytes -= len(self._kept.popleft().data) + OVERHEAD
        while self._unsent and self._unsent[0].done:
            self._unsent.popleft()
