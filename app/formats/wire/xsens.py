"""Heart: Xsens MTi: Xbus messages ``FA FF MID LEN … CS`` and the MTData2 they carry.

Axes: x ahead, z up, so toe = x, right = −y, down = −z. Its quaternion refers to east–north–up unless
the data identifier says otherwise. Its field is relative. Unverified: sample time fine counts 0.1 ms
(one source), the clip bits of the status word (taken from a sister product).
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from app.formats.mounting import Axes
from app.formats.saturation import RANGES, Range
from app.formats.wire.counting import Count
from app.formats.wire.making import ENU, NED, NWU, Z_UP, Maker, Taker
from app.formats.wire.stream import NO_PACKET, UNKNOWN_YET, Frames, find_header
from app.formats.wire.ticks import ArrivalClock, DeviceClock
from app.formats.wire.warmth import believed
from app.motion.basics import Quaternion, Vector
from app.motion.samples import Sample
from app.rotation import conjugate, multiply

FASTEST_HZ = 400.0
SYNC = b"\xfa\xff"
MTDATA2 = 0x36
PACKET_COUNTER, TIME_FINE, QUATERNION = 0x1020, 0x1060, 0x2010
ACCELERATION, RATE_OF_TURN, MAGNETIC_FIELD, STATUS_WORD = 0x4020, 0x8020, 0xC020, 0xE020
TEMPERATURE = 0x0810
TICK_NS = 100_000

_LONGEST = 2048  # of data: the protocol allows more, no MTi sends it
_CLIP_SHIFT = 8
_FLOAT32, _FIXED_12_20, _FIXED_16_32, _FLOAT64 = range(4)
_FORMATS = {_FLOAT32: (4, "f"), _FIXED_12_20: (4, "i"), _FLOAT64: (8, "d")}
_EARTHS: dict[int, Quaternion] = {0x0: ENU, 0x4: NED, 0x8: NWU}
_STRUCTS = {
    (form, count): struct.Struct(f">{count}{letter}")
    for form, (_, letter) in _FORMATS.items()
    for count in (1, 3, 4)
}


@dataclass(frozen=True)
class XsensSetup:
    """What the start-up found and chose."""

    product: str = ""
    serial: str = ""
    firmware: str = ""
    rate_hz: float | None = None
    full_scale: Range = RANGES["xsens"]
    notes: tuple[str, ...] = ()


def message(mid: int, data: bytes = b"") -> bytes:
    """An Xbus message to or from the master."""
    length = bytes([len(data)]) if len(data) < 255 else b"\xff" + len(data).to_bytes(2)
    body = b"\xff" + bytes([mid]) + length + data
    return b"\xfa" + body + bytes([-sum(body) & 0xFF])


def data_of(whole: bytes) -> bytes:
    """What a message carries."""
    return whole[6:-1] if whole[3] == 0xFF else whole[4:-1]


def frames() -> Frames:
    """The messages of a stream."""
    return Frames(find_header(SYNC), _size, holds, 7 + _LONGEST)


def _size(data: bytes, at: int) -> int:
    if len(data) < at + 4:
        return UNKNOWN_YET
    if data[at + 3] != 0xFF:
        return 5 + data[at + 3]
    if len(data) < at + 6:
        return UNKNOWN_YET
    length = int.from_bytes(data[at + 4 : at + 6])
    return 7 + length if 255 <= length <= _LONGEST else NO_PACKET


def holds(whole: bytes) -> bool:
    """Whether everything after the first byte sums to 0, and measurements fill their message.

    The sum is of eight bits only: it alone would let one damaged message in 256 pass.
    """
    return sum(whole) & 0xFF == 0xFA and (whole[2] != MTDATA2 or _fills(data_of(whole)))


def _fills(data: bytes) -> bool:
    at = 0
    while at + 3 <= len(data):
        at += 3 + data[at + 2]
    return at == len(data)


class XsensDecoder:
    """Samples out of MTData2, whatever number format and frame were configured."""

    def __init__(self, sensor: str, axes: Axes = Z_UP, setup: XsensSetup | None = None) -> None:
        self.setup = setup or XsensSetup()
        self.notes = [*self.setup.notes, "Xsens: the magnetic field is relative (1 where it was calibrated)"]
        self._frames = frames()
        self.counters = self._frames.counters
        self._maker = Maker(sensor, axes, self.setup.full_scale)
        self._clock: DeviceClock | None = None
        self._arrival = ArrivalClock(self.setup.rate_hz)
        self._count = Count(16)
        self._warmth = (0, b"")

    @property
    def temperature_c(self) -> float | None:
        """The newest, °C."""
        numbers = _numbers(*self._warmth, 1)
        return believed(numbers[0]) if numbers else None

    def feed(self, data: bytes, host_ns: int) -> list[Sample]:
        """The samples that ``data``, arrived at ``host_ns``, completes."""
        samples = []
        for whole in self._frames.feed(data):
            items = _items(data_of(whole)) if whole[2] == MTDATA2 else {}
            if TEMPERATURE in items:
                self._warmth = items[TEMPERATURE]
            if ACCELERATION not in items or RATE_OF_TURN not in items:
                self.counters.unknown += 1
            elif (sample := self._read(items, host_ns)) is None:
                self.counters.dropped += 1
            else:
                samples.append(sample)
        return samples

    def _read(self, items: dict[int, tuple[int, bytes]], host_ns: int) -> Sample | None:
        self._count_lost(items)
        force, rate = _triple(items, ACCELERATION), _triple(items, RATE_OF_TURN)
        device_ns = self._stamp(items, host_ns)
        if force is None or rate is None or device_ns is None:
            return None
        _, status = items.get(STATUS_WORD, (0, b""))
        clipped = int.from_bytes(status) >> _CLIP_SHIFT & 0x1FF
        q = _orientation(items)
        return self._maker.make(device_ns, host_ns, force, rate, _triple(items, MAGNETIC_FIELD), clipped, q)

    def _stamp(self, items: dict[int, tuple[int, bytes]], host_ns: int) -> int | None:
        _, ticks = items.get(TIME_FINE, (0, b""))
        if len(ticks) == 4:
            self._clock = self._clock or DeviceClock(TICK_NS, 32)
            return self._clock.stamp(int.from_bytes(ticks), host_ns)
        return None if self._clock else self._arrival.stamp(host_ns)  # one clock a stream

    def _count_lost(self, items: dict[int, tuple[int, bytes]]) -> None:
        _, data = items.get(PACKET_COUNTER, (0, b""))
        if len(data) == 2:
            self.counters.lost += self._count.missing(int.from_bytes(data))


def _items(data: bytes) -> dict[int, tuple[int, bytes]]:
    """MTData2's items by identifier without its low nibble, which goes with the bytes."""
    found: dict[int, tuple[int, bytes]] = {}
    at = 0
    while at + 3 <= len(data):
        end = at + 3 + data[at + 2]
        if end > len(data):
            break
        found[data[at] << 8 | data[at + 1] & 0xF0] = (data[at + 1] & 0x0F, data[at + 3 : end])
        at = end
    return found


def _numbers(nibble: int, data: bytes, count: int) -> tuple[float, ...] | None:
    form = nibble & 3
    if form == _FIXED_16_32:
        return (
            tuple(_fixed_16_32(data[6 * i : 6 * i + 6]) for i in range(count))
            if len(data) == 6 * count
            else None
        )
    if len(data) != _FORMATS[form][0] * count:
        return None
    numbers: tuple[float, ...] = _STRUCTS[form, count].unpack(data)
    return tuple(number / (1 << 20) for number in numbers) if form == _FIXED_12_20 else numbers


def _fixed_16_32(data: bytes) -> float:
    """Six bytes, the 32 bits of the fraction first, then the 16 of the whole."""
    return int.from_bytes(data[4:] + data[:4], signed=True) / (1 << 32)


def _triple(items: dict[int, tuple[int, bytes]], kind: int) -> Vector | None:
    numbers = _numbers(*items[kind], 3) if kind in items else None
    return None if numbers is None else (numbers[0], numbers[1], numbers[2])


def _orientation(items: dict[int, tuple[int, bytes]]) -> Quaternion | None:
    """The quaternion into north–east–down."""
    if QUATERNION not in items:
        return None
    nibble, data = items[QUATERNION]
    q, earth = _numbers(nibble, data, 4), _EARTHS.get(nibble & 0xC)
    return None if q is None or earth is None else multiply(earth, (q[0], q[1], q[2], q[3]))


class XsensEncoder:
    """A sample as one MTData2 in float32: counter, fine time, and what the sample has.

    ``temperature_c`` is what its thermometer reads.
    """

    def __init__(self, axes: Axes = Z_UP, setup: XsensSetup | None = None) -> None:
        self._taker = Taker(axes, (setup or XsensSetup()).full_scale)
        self.temperature_c = 25.0

    def encode(self, sample: Sample) -> bytes:
        """The message with everything the sample has."""
        wanted = [PACKET_COUNTER, TIME_FINE, ACCELERATION, RATE_OF_TURN]
        wanted += [MAGNETIC_FIELD] if sample.field_b is not None else []
        wanted += [QUATERNION] if sample.device_q_nb is not None else []
        wanted += [STATUS_WORD] if sample.saturation else []
        return self.mtdata2(sample, wanted, sample.seq)

    def mtdata2(self, sample: Sample, wanted: list[int], count: int) -> bytes:
        """The message with the wanted items; those unknown here are left out."""
        items = ((kind, self._data(kind, sample, count)) for kind in wanted)
        made = [kind.to_bytes(2) + bytes([len(data)]) + data for kind, data in items if data]
        return message(MTDATA2, b"".join(made))

    def _data(self, kind: int, sample: Sample, count: int) -> bytes:
        taker = self._taker
        match kind:
            case 0x0810:
                return struct.pack(">f", self.temperature_c)
            case 0x1020:
                return (count & 0xFFFF).to_bytes(2)
            case 0x1060:
                return (round(sample.device_ns / TICK_NS) & 0xFFFFFFFF).to_bytes(4)
            case 0x4020:
                return struct.pack(">3f", *taker.force(sample))
            case 0x8020:
                return struct.pack(">3f", *taker.rate(sample))
            case 0xC020:
                return struct.pack(">3f", *taker.field(sample))
            case 0x2010:
                return struct.pack(">4f", *multiply(conjugate(ENU), taker.orientation(sample)))
            case 0xE020:
                return (taker.saturation(sample) << _CLIP_SHIFT).to_bytes(4)
        return b""
