"""Heart: MicroStrain/HBK MIP (GX3-35 to GQ7): ``75 65``, descriptor set, fields, Fletcher checksum.

Axes: x ahead, y right, z down, and a level unit reads −1 g on z: specific force, as given. The
quaternion takes body to north–east–down (v_body = q* v_ned q). Unverified: the 62 500 ticks a second
of the old time stamp 0x0E, known of the GX3 only.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from itertools import accumulate

from app.formats.mounting import AS_GIVEN, Axes
from app.formats.saturation import RANGES, Range
from app.formats.wire.making import Maker, Taker, in_g, scaled
from app.formats.wire.stream import UNKNOWN_YET, Frames, find_header
from app.formats.wire.ticks import ArrivalClock, DeviceClock
from app.formats.wire.warmth import believed
from app.motion.basics import G_MPS2, Quaternion, Vector
from app.motion.samples import Sample

FASTEST_HZ = 1000.0
SYNC = b"\x75\x65"
SENSOR_DATA = 0x80
ACCEL, GYRO, MAG, ORIENTATION, OLD_TICKS, GPS_TIME, OVER_RANGE = 0x04, 0x05, 0x06, 0x0A, 0x0E, 0x12, 0x18
SHARED_GPS_TIME, REFERENCE_TIME = 0xD3, 0xD5
TEMPERATURE = 0x14

_TRIPLE = struct.Struct(">3f")
_QUAD = struct.Struct(">4f")
_GPS = struct.Struct(">dHH")
_WEEK_S = 604_800
_UT_PER_GAUSS = 100.0
#: Time fields, best first: what to make of the counter, ns a tick and bits.
_CLOCKS = {REFERENCE_TIME: (1, 64), SHARED_GPS_TIME: (1, 64), GPS_TIME: (1, 64), OLD_TICKS: (16_000, 32)}

Fields = list[tuple[int, bytes]]


@dataclass(frozen=True)
class MipSetup:
    """What the start-up found and chose. ``full_scale`` is known only where the unit told it."""

    model: str = ""
    serial: str = ""
    firmware: str = ""
    rate_hz: float | None = None
    generation: int = 7  # 7: newer message format and reference time; 5: 3 to 5
    full_scale: Range = RANGES["mip"]
    notes: tuple[str, ...] = field(default=())


def fletcher(data: bytes) -> bytes:
    """The two check bytes over everything from the header to the end of the payload."""
    return bytes([sum(data) & 0xFF, sum(accumulate(data)) & 0xFF])


def packet(descriptor_set: int, *fields: tuple[int, bytes]) -> bytes:
    """A packet of fields, each its descriptor and data."""
    payload = b"".join(bytes([len(data) + 2, descriptor]) + data for descriptor, data in fields)
    head = SYNC + bytes([descriptor_set, len(payload)]) + payload
    return head + fletcher(head)


def fields_of(whole: bytes) -> Fields:
    """Descriptor and data of a packet's fields, up to one that does not fit."""
    found: Fields = []
    at, end = 4, len(whole) - 2
    while at + 2 <= end:
        length = whole[at]
        if length < 2 or at + length > end:
            break
        found.append((whole[at + 1], whole[at + 2 : at + length]))
        at += length
    return found


def frames() -> Frames:
    """The packets of a stream."""
    return Frames(find_header(SYNC), _size, holds, 4 + 255 + 2)


def _size(data: bytes, at: int) -> int:
    return 4 + data[at + 3] + 2 if len(data) >= at + 4 else UNKNOWN_YET


def holds(whole: bytes) -> bool:
    """Whether a whole packet's check bytes are right."""
    return fletcher(whole[:-2]) == whole[-2:]


class MipDecoder:
    """Samples out of the sensor data set 0x80, in whichever message format it comes."""

    def __init__(self, sensor: str, axes: Axes = AS_GIVEN, setup: MipSetup | None = None) -> None:
        self.setup = setup or MipSetup()
        self.notes = list(self.setup.notes)
        self._frames = frames()
        self.counters = self._frames.counters
        self._maker = Maker(sensor, axes, self.setup.full_scale)
        self._clock_kind = 0
        self._clock: DeviceClock | None = None
        self._arrival = ArrivalClock(self.setup.rate_hz)
        self._warmth = b""

    @property
    def temperature_c(self) -> float | None:
        """The newest, the mean of its thermometers, °C."""
        return believed(_TRIPLE.unpack(self._warmth)[2]) if len(self._warmth) == _TRIPLE.size else None

    def feed(self, data: bytes, host_ns: int) -> list[Sample]:
        """The samples that ``data``, arrived at ``host_ns``, completes; acknowledgements may lie between."""
        samples = []
        for whole in self._frames.feed(data):
            fields = dict(fields_of(whole)) if whole[2] == SENSOR_DATA else {}
            if TEMPERATURE in fields:
                self._warmth = fields[TEMPERATURE]
            if len(fields.get(ACCEL, b"")) != 12 or len(fields.get(GYRO, b"")) != 12:
                self.counters.unknown += 1
            elif (sample := self._read(fields, host_ns)) is None:
                self.counters.dropped += 1
            else:
                samples.append(sample)
        return samples

    def _read(self, fields: dict[int, bytes], host_ns: int) -> Sample | None:
        device_ns = self._stamp(fields, host_ns)
        if device_ns is None:
            return None
        force = scaled(_TRIPLE.unpack(fields[ACCEL]), G_MPS2)
        rate: Vector = _TRIPLE.unpack(fields[GYRO])
        mag, q, over = fields.get(MAG, b""), fields.get(ORIENTATION, b""), fields.get(OVER_RANGE, b"")
        field_ut = scaled(_TRIPLE.unpack(mag), _UT_PER_GAUSS) if len(mag) == 12 else None
        q_nd: Quaternion | None = _QUAD.unpack(q) if len(q) == 16 else None
        bits = _nine_bits(int.from_bytes(over)) if len(over) == 2 else 0
        return self._maker.make(device_ns, host_ns, force, rate, field_ut, bits, q_nd)

    def _stamp(self, fields: dict[int, bytes], host_ns: int) -> int | None:
        for kind, (tick_ns, bits) in _CLOCKS.items():
            data = fields.get(kind)
            ticks = None if data is None else _ticks(kind, data)
            if ticks is None:
                continue
            if self._clock_kind not in (0, kind):
                return None  # one clock a stream: two would not agree
            if self._clock is None:
                self._clock_kind, self._clock = kind, DeviceClock(tick_ns, bits)
            return self._clock.stamp(ticks, host_ns)
        if self._clock_kind == 0 and len(self.notes) == len(self.setup.notes):
            self.notes.append("its messages carry no time: samples are stamped by their arrival")
        return None if self._clock_kind else self._arrival.stamp(host_ns)


def _ticks(kind: int, data: bytes) -> int | None:
    """The counter of a time field; None if the field is not what it should be."""
    if kind in (GPS_TIME, SHARED_GPS_TIME):
        if len(data) != _GPS.size:
            return None
        tow_s, week, _ = _GPS.unpack(data)
        return week * _WEEK_S * 10**9 + round(tow_s * 1e9) if 0.0 <= tow_s < 2 * _WEEK_S else None
    return int.from_bytes(data) if len(data) == (8 if kind == REFERENCE_TIME else 4) else None


def _nine_bits(over_range: int) -> int:
    """Over-range bits (a nibble a sensor) as saturation bits (three a sensor)."""
    return over_range & 7 | (over_range >> 4 & 7) << 3 | (over_range >> 8 & 7) << 6


def _nibbles(bits: int) -> int:
    """The inverse of ``_nine_bits``."""
    return bits & 7 | (bits >> 3 & 7) << 4 | (bits >> 6 & 7) << 8


class MipEncoder:
    """A sample as one packet: scaled accel, gyro and mag, orientation where there is one, and time.

    Generation 7 stamps with the reference time, generation 5 with the GPS time since power-up.
    ``temperature_c`` is what its thermometers read.
    """

    def __init__(self, axes: Axes = AS_GIVEN, setup: MipSetup | None = None) -> None:
        self.setup = setup or MipSetup()
        self._taker = Taker(axes, self.setup.full_scale)
        self.temperature_c = 25.0

    def encode(self, sample: Sample) -> bytes:
        """The packet with everything the sample has."""
        time = REFERENCE_TIME if self.setup.generation == 7 else GPS_TIME
        wanted = [time, ACCEL, GYRO]
        wanted += [MAG] if sample.field_b is not None else []
        wanted += [ORIENTATION] if sample.device_q_nb is not None else []
        wanted += [OVER_RANGE] if sample.saturation else []
        return self.message(sample, wanted)

    def message(self, sample: Sample, wanted: list[int]) -> bytes:
        """The packet with the wanted fields, in that order; those unknown here are left out."""
        fields = [(kind, self._data(kind, sample)) for kind in wanted]
        return packet(SENSOR_DATA, *((kind, data) for kind, data in fields if data))

    def _data(self, kind: int, sample: Sample) -> bytes:
        taker, ns = self._taker, sample.device_ns
        if kind in (GPS_TIME, SHARED_GPS_TIME):
            week, tow_ns = divmod(ns, _WEEK_S * 10**9)
            return _GPS.pack(tow_ns / 1e9, week & 0xFFFF, 0)
        made = {
            ACCEL: lambda: _TRIPLE.pack(*in_g(taker.force(sample))),
            GYRO: lambda: _TRIPLE.pack(*taker.rate(sample)),
            MAG: lambda: _TRIPLE.pack(*scaled(taker.field(sample), 1 / _UT_PER_GAUSS)),
            ORIENTATION: lambda: _QUAD.pack(*taker.orientation(sample)),
            OLD_TICKS: lambda: (round(ns / 16_000) & 0xFFFFFFFF).to_bytes(4),
            REFERENCE_TIME: lambda: ns.to_bytes(8),
            TEMPERATURE: lambda: _TRIPLE.pack(*(self.temperature_c + off for off in (-0.25, 0.25, 0.0))),
            OVER_RANGE: lambda: _nibbles(taker.saturation(sample)).to_bytes(2),
        }.get(kind)
        return b"" if made is None else made()
