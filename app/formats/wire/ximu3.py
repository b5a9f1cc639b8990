"""Heart: x-io x-IMU3: one stream of messages that end with LF; ASCII, binary and JSON may be mixed.

Axes: x ahead, z up (so toe = x, right = −y, down = −z); its quaternion refers to north–west–up unless
its settings say otherwise. Its field is relative, and its messages have no checksum: what is not
plausible is dropped.
"""

from __future__ import annotations

import json
import math
import re
import struct

from app.formats.mounting import Axes
from app.formats.saturation import RANGES
from app.formats.wire.decimals import Decimals
from app.formats.wire.making import (
    NWU,
    RAD_PER_DEG,
    Z_UP,
    Maker,
    Taker,
    in_g,
    measurable,
    measured,
    scaled,
)
from app.formats.wire.stream import NO_PACKET, UNKNOWN_YET, Frames, find_first
from app.formats.wire.ticks import DeviceClock
from app.formats.wire.warmth import believed
from app.motion.basics import G_MPS2, Quaternion
from app.motion.samples import Sample

FASTEST_HZ = 400.0
TICK_NS = 1000
END = b"\n"

#: Numbers in a message of each kind; kinds with text have none.
_ARGUMENTS = {"I": (6,), "M": (3,), "H": (3,), "Q": (4,), "R": (9,), "A": (3,), "L": (3, 7), "E": (3, 7)}
_ARGUMENTS |= {"T": (1,), "B": (3,), "W": (2,), "Y": (1,), "O": (1,)}
_TEXTS = "SNFUC"
_LONGEST = 1024
_ASCII = re.compile(rb"([A-Z]),([0-9]{1,20}),([^\n\x80-\xff]*?)\r?\n", re.DOTALL)
_MULTIPLEXED = ord("^")
_BINARY = {0x80 + ord(kind) for kind in (*_ARGUMENTS, *_TEXTS)}
_TIME = struct.Struct("<Q")
_IMPLAUSIBLE = 2.0  # times the range

Message = tuple[str, int, tuple[float, ...]]  # kind, timestamp in µs, numbers (none for text)


def frames() -> Frames:
    """The messages of a stream."""
    firsts = bytes([*_BINARY, *range(ord("A"), ord("Z") + 1), ord("{"), _MULTIPLEXED])
    return Frames(find_first(firsts), _size, holds, _LONGEST)


def _size(data: bytes, at: int) -> int:
    end = data.find(END, at, at + _LONGEST)
    if end < 0:
        return UNKNOWN_YET if len(data) - at < _LONGEST else NO_PACKET
    return end + 1 - at


def holds(message: bytes) -> bool:
    """Whether a message is one by its form."""
    if message[0] == ord("{"):
        return _is_json(message)
    if message[0] == _MULTIPLEXED:
        return len(message) > 3 and message[2] != _MULTIPLEXED and holds(message[2:])
    return parse(message) is not None


def _is_json(message: bytes) -> bool:
    try:
        return isinstance(json.loads(message), dict)
    except (ValueError, RecursionError):
        return False


def parse(message: bytes) -> Message | None:
    """A data message, ASCII or binary, with its LF; None if it is none."""
    return _parse_binary(message) if message[0] >= 0x80 else _parse_ascii(message)


def _parse_ascii(message: bytes) -> Message | None:
    match = _ASCII.fullmatch(message)
    if match is None:
        return None
    kind, micros, rest = match[1].decode(), int(match[2]), match[3]
    if kind in _TEXTS:
        return kind, micros, ()
    if b"_" in rest:  # Python would read 1_0 as 10
        return None
    try:
        numbers = tuple(map(float, rest.split(b",")))
    except ValueError:
        return None
    return (kind, micros, numbers) if len(numbers) in _ARGUMENTS.get(kind, ()) else None


def _cells(message: bytes) -> list[str]:
    """The numbers of a message in ASCII as they are printed."""
    return message.rstrip().decode("ascii", "replace").split(",")[2:]


def _parse_binary(message: bytes) -> Message | None:
    kind, body = chr(message[0] - 0x80), message[1:-1]
    if 0xDB in body:
        if body.count(0xDB) != body.count(b"\xdb\xdc") + body.count(b"\xdb\xdd"):
            return None
        body = body.replace(b"\xdb\xdc", END).replace(b"\xdb\xdd", b"\xdb")
    count, odd = divmod(len(body) - 8, 4)
    if kind in _TEXTS:
        return (kind, *_TIME.unpack_from(body), ()) if len(body) >= 8 else None
    if odd or count not in _ARGUMENTS.get(kind, ()):
        return None
    return (kind, *_TIME.unpack_from(body), struct.unpack_from(f"<{count}f", body, 8))


class Ximu3Decoder:
    """Samples out of inertial messages.

    The magnetometer and the quaternion come in messages of their own, more slowly: each goes with
    the first inertial message behind it, and with no other. ``earth`` is the frame of ``ahrsAxesConvention``.
    """

    def __init__(self, sensor: str, axes: Axes = Z_UP, earth: Quaternion = NWU) -> None:
        self.notes = ["x-IMU3: the magnetic field is relative (1 where it was calibrated)"]
        self._frames = frames()
        self.counters = self._frames.counters
        self._maker = Maker(sensor, axes, RANGES["ximu3"], earth)
        self._clock = DeviceClock(TICK_NS, 64)
        self._decimals = Decimals()  # of inertial messages in ASCII
        self._field: tuple[float, ...] = ()
        self._orientation: tuple[float, ...] = ()
        self.temperature_c: float | None = None  # newest, °C

    def feed(self, data: bytes, host_ns: int) -> list[Sample]:
        """The samples that ``data``, arrived at ``host_ns``, completes; a datagram is such data too."""
        samples = []
        for message in self._frames.feed(data):
            kind, micros, numbers = (message[0] >= 0x41 and parse(message)) or ("", 0, ())
            if kind == "I" and message[0] < 0x80 and not self._decimals.hold(_cells(message)):
                self._frames.spoil(message)
            elif kind == "I":
                sample = self._read(micros, numbers, host_ns)
                self.counters.dropped += sample is None
                samples += [] if sample is None else [sample]
            elif kind == "M":
                self._field = numbers
            elif kind == "Q":
                self._orientation = numbers
            elif kind == "T":
                self.temperature_c = believed(numbers[0], self.temperature_c)
            else:
                self.counters.unknown += 1
        return samples

    def _read(self, micros: int, numbers: tuple[float, ...], host_ns: int) -> Sample | None:
        field, orientation = self._field, self._orientation
        self._field = self._orientation = ()
        gx, gy, gz, ax, ay, az = numbers
        force, rate = scaled((ax, ay, az), G_MPS2), scaled((gx, gy, gz), RAD_PER_DEG)
        most = RANGES["ximu3"]
        if not (_plausible(force, most.force) and _plausible(rate, most.rate)):
            return None
        if not (measurable((gx, gy, gz)) and measurable((ax, ay, az))):
            return None
        device_ns = self._clock.stamp(micros, host_ns)
        if device_ns is None:
            return None
        m = (field[0], field[1], field[2]) if field else None
        q = (orientation[0], orientation[1], orientation[2], orientation[3]) if orientation else None
        return self._maker.make(device_ns, host_ns, force, rate, m, 0, q)


def _plausible(v: tuple[float, float, float], full_scale: float) -> bool:
    limit = _IMPLAUSIBLE * full_scale
    return -limit <= min(v) and max(v) <= limit and not math.isnan(sum(v))


class Ximu3Encoder:
    """A sample as its messages: field and quaternion, if there are, then the inertial one."""

    def __init__(self, axes: Axes = Z_UP, binary: bool = True, earth: Quaternion = NWU) -> None:
        self._taker = Taker(axes, RANGES["ximu3"], earth)
        self._message = binary_message if binary else ascii_message

    def encode(self, sample: Sample) -> bytes:
        """All messages of the sample."""
        field = self.field(sample) if sample.field_b is not None else b""
        orientation = self.orientation(sample) if sample.device_q_nb is not None else b""
        return field + orientation + self.inertial(sample)

    def inertial(self, sample: Sample) -> bytes:
        """Gyroscope in deg/s, accelerometer in g."""
        rate = scaled(self._taker.rate(sample), 1 / RAD_PER_DEG)
        force = in_g(self._taker.force(sample))
        return self._message("I", _micros(sample), (*measured(rate), *measured(force)))

    def field(self, sample: Sample) -> bytes:
        """Magnetometer, relative."""
        return self._message("M", _micros(sample), self._taker.field(sample))

    def orientation(self, sample: Sample) -> bytes:
        """Quaternion."""
        return self._message("Q", _micros(sample), self._taker.orientation(sample))

    def temperature(self, sample: Sample, celsius: float) -> bytes:
        """What its thermometer reads, °C."""
        return self._message("T", _micros(sample), (celsius,))


def _micros(sample: Sample) -> int:
    return round(sample.device_ns / TICK_NS)


def binary_message(kind: str, micros: int, numbers: tuple[float, ...]) -> bytes:
    """A binary message: stuffed, so that LF stands at its end only."""
    body = _TIME.pack(micros) + struct.pack(f"<{len(numbers)}f", *numbers)
    return bytes([0x80 + ord(kind)]) + body.replace(b"\xdb", b"\xdb\xdd").replace(END, b"\xdb\xdc") + END


def ascii_message(kind: str, micros: int, numbers: tuple[float, ...]) -> bytes:
    """An ASCII message: four decimals."""
    return f"{kind},{micros},{','.join(f'{number:.4f}' for number in numbers)}\r\n".encode()
