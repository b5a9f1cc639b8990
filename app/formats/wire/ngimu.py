"""Heart: x-io NGIMU: OSC 1.0 bundles, a datagram each over UDP, SLIP frames over a serial line.

The bundle's time tag is the device's clock. Axes: x ahead, z up. Unverified: its quaternion's earth
frame (taken as north–west–up, as its maker's other sensors), its ranges, and that of its temperatures
the first is the processor's and the second the sensors'.
"""

from __future__ import annotations

import struct

from app.formats.mounting import Axes
from app.formats.saturation import RANGES
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
from app.formats.wire.pace import Pace
from app.formats.wire.stream import NO_PACKET, UNKNOWN_YET, Frames, find_first
from app.formats.wire.ticks import ArrivalClock, DeviceClock
from app.formats.wire.warmth import RATE_HZ, believed, warming
from app.motion.basics import G_MPS2, Quaternion
from app.motion.samples import GAP_NS, Sample

FASTEST_HZ = 400.0
SENSORS, QUATERNION, TEMPERATURE = b"/sensors", b"/quaternion", b"/temperature"

_BUNDLE = b"#bundle\0"
_LARGEST = 2048
_IMMEDIATELY = 1
_PROCESSOR_C = 4.0  # a modelled one is so much hotter than the sensors
_END, _ESCAPE = b"\xc0", b"\xdb"
_WIDTHS = {"f": 4, "i": 4, "r": 4, "c": 4, "m": 4, "d": 8, "h": 8, "t": 8, "T": 0, "F": 0, "N": 0, "I": 0}

Messages = dict[bytes, tuple[float, ...]]  # address → its numbers; empty where they are not all floats


def parse(packet: bytes) -> tuple[int, Messages] | None:
    """Time tag and messages of a packet, bundles inside it included; None if it is not wholly OSC."""
    tag = _IMMEDIATELY
    messages: Messages = {}
    waiting = [packet]
    while waiting:
        element = waiting.pop(0)
        if element.startswith(_BUNDLE) and len(element) >= 16:
            tag = int.from_bytes(element[8:16])
            inside = _elements(element)
            if inside is None:
                return None
            waiting = inside + waiting
        elif (message := _message(element)) is not None:
            messages[message[0]] = message[1]
        else:
            return None
    return tag, messages


def _elements(bundle: bytes) -> list[bytes] | None:
    found, at = [], 16
    while at < len(bundle):
        size = int.from_bytes(bundle[at : at + 4])
        if size < 8 or size % 4 or at + 4 + size > len(bundle):
            return None
        found.append(bundle[at + 4 : at + 4 + size])
        at += 4 + size
    return found


def _message(data: bytes) -> tuple[bytes, tuple[float, ...]] | None:
    address, at = _string(data, 0)
    tags, start = _string(data, at)
    if not address.startswith(b"/") or not address.isascii() or not tags.startswith(b","):
        return None
    kinds = tags[1:].decode("ascii", "replace")
    if kinds == "f" * len(kinds):
        if len(data) != start + 4 * len(kinds):
            return None
        return address, struct.unpack_from(f">{len(kinds)}f", data, start)
    for kind in kinds:
        if kind in "sb":
            start = _string(data, start)[1] if kind == "s" else _after_blob(data, start)
        elif kind in _WIDTHS:
            start += _WIDTHS[kind]
        else:
            return None
    return (address, ()) if start == len(data) else None


def _string(data: bytes, at: int) -> tuple[bytes, int]:
    """A string padded with zeros to a multiple of four, and where it ends; empty if it does not end."""
    end = data.find(0, at)
    return (data[at:end], at + (end - at + 4) // 4 * 4) if end >= 0 else (b"", len(data) + 1)


def _after_blob(data: bytes, at: int) -> int:
    return at + 4 + (int.from_bytes(data[at : at + 4]) + 3) // 4 * 4


def frames() -> Frames:
    """The packets of a serial stream: SLIP; a leading END belongs to its packet."""
    return Frames(find_first(_END + b"#/"), _size, lambda frame: parse(unframed(frame)) is not None, _LARGEST)


def _size(data: bytes, at: int) -> int:
    end = data.find(_END, at + 1, at + _LARGEST)
    if end < 0:
        return UNKNOWN_YET
    return NO_PACKET if end == at + 1 else end + 1 - at


def framed(packet: bytes) -> bytes:
    """A packet between two ENDs, stuffed."""
    stuffed = packet.replace(_ESCAPE, b"\xdb\xdd").replace(_END, b"\xdb\xdc")
    return _END + stuffed + _END


def unframed(frame: bytes) -> bytes:
    """The inverse of ``framed``."""
    return frame.strip(_END).replace(b"\xdb\xdc", _END).replace(b"\xdb\xdd", _ESCAPE)


class NgimuDecoder:
    """Samples out of ``/sensors``; a ``/quaternion`` goes with the first of them at or behind it.

    ``slip`` for a serial line; otherwise each feed is one datagram.
    """

    def __init__(self, sensor: str, axes: Axes = Z_UP, slip: bool = False) -> None:
        self.notes: list[str] = []
        self._frames = frames()
        self.counters = self._frames.counters
        self._slip = slip
        self._maker = Maker(sensor, axes, RANGES["ngimu"], NWU)
        self._clock = DeviceClock(1, 64)
        self._arrival = ArrivalClock()
        self._timed = False  # whether packets tell their time
        self._untimed_ns: int | None = None  # the last stamp by arrival
        self._ahead_ns = 0  # what keeps the packets' time ahead of it
        self._orientation: Quaternion | None = None
        self.temperature_c: float | None = None  # newest, of its sensors, °C

    def feed(self, data: bytes, host_ns: int) -> list[Sample]:
        """The samples that ``data``, arrived at ``host_ns``, completes."""
        samples = []
        for packet in self._packets(data):
            tag, messages = parse(packet) or (0, {})
            if len(q := messages.get(QUATERNION, ())) == 4:
                self._orientation = (q[0], q[1], q[2], q[3])
            if warmth := messages.get(TEMPERATURE):
                self.temperature_c = believed(warmth[:2][-1], self.temperature_c)
            if len(numbers := messages.get(SENSORS, ())) >= 9:
                sample = self._read(tag, numbers, host_ns)
                self.counters.dropped += sample is None
                samples += [] if sample is None else [sample]
            elif QUATERNION not in messages and TEMPERATURE not in messages:
                self.counters.unknown += 1
        return samples

    def _packets(self, data: bytes) -> list[bytes]:
        if self._slip:
            return [unframed(frame) for frame in self._frames.feed(data)]
        counters = self.counters
        counters.bytes_fed += len(data)
        if not data or parse(data) is None:
            counters.bytes_skipped += len(data)
            counters.bad_checksum += len(data) > 0
            return []
        counters.bytes_good += len(data)
        counters.packets += 1
        return [data]

    def _read(self, tag: int, numbers: tuple[float, ...], host_ns: int) -> Sample | None:
        gx, gy, gz, ax, ay, az, mx, my, mz = numbers[:9]
        q, self._orientation = self._orientation, None
        if not (measurable((gx, gy, gz)) and measurable((ax, ay, az))):
            return None
        device_ns = self._stamp(tag, host_ns)
        if device_ns is None:
            return None
        force, rate = scaled((ax, ay, az), G_MPS2), scaled((gx, gy, gz), RAD_PER_DEG)
        return self._maker.make(device_ns, host_ns, force, rate, (mx, my, mz), 0, q)

    def _stamp(self, tag: int, host_ns: int) -> int | None:
        """By arrival until a packet tells its time, by that from then on: one clock a stream."""
        if tag == _IMMEDIATELY:
            self._untimed_ns = None if self._timed else self._arrival.stamp(host_ns)
            return self._untimed_ns
        stamp_ns = self._clock.stamp(nanoseconds(tag), host_ns)
        if stamp_ns is None:
            return None
        if not self._timed and self._untimed_ns is not None:  # never back, nor a century ahead: a gap
            self._ahead_ns = self._untimed_ns + GAP_NS + 1 - stamp_ns
        self._timed = True
        return stamp_ns + self._ahead_ns


def nanoseconds(tag: int) -> int:
    """A time tag (seconds since 1900 in its upper half) in whole nanoseconds."""
    return (tag * 10**9 + (1 << 31)) >> 32


def time_tag(ns: int) -> int:
    """The inverse of ``nanoseconds``."""
    return ((ns << 32) + 5 * 10**8) // 10**9 & 0xFFFFFFFFFFFFFFFF


def message(address: bytes, numbers: tuple[float, ...]) -> bytes:
    """An OSC message of floats."""
    tags = b"," + b"f" * len(numbers)
    return _padded(address) + _padded(tags) + struct.pack(f">{len(numbers)}f", *numbers)


def bundle(tag: int, *messages: bytes) -> bytes:
    """An OSC bundle."""
    return _BUNDLE + tag.to_bytes(8) + b"".join(len(each).to_bytes(4) + each for each in messages)


def _padded(text: bytes) -> bytes:
    return text + bytes(4 - len(text) % 4)


class NgimuEncoder:
    """A sample as one bundle: temperature and quaternion, if there are, then sensors."""

    def __init__(self, axes: Axes = Z_UP, slip: bool = False) -> None:
        self._taker = Taker(axes, RANGES["ngimu"], NWU)
        self._slip = slip

    def encode(self, sample: Sample, celsius: float | None = None) -> bytes:
        """One datagram, or one SLIP frame; the barometer reads 1013.25 hPa."""
        taker = self._taker
        rate, force = scaled(taker.rate(sample), 1 / RAD_PER_DEG), in_g(taker.force(sample))
        messages = [message(SENSORS, (*measured(rate), *measured(force), *taker.field(sample), 1013.25))]
        if sample.device_q_nb is not None:
            messages.insert(0, message(QUATERNION, taker.orientation(sample)))
        if celsius is not None:
            messages.insert(0, message(TEMPERATURE, (celsius + _PROCESSOR_C, celsius)))
        packet = bundle(time_tag(sample.device_ns), *messages)
        return framed(packet) if self._slip else packet


class NgimuDevice:
    """An NGIMU as its host sees it; it takes commands (``/identify``) and never answers them."""

    rate_hz = FASTEST_HZ

    def __init__(self, axes: Axes = Z_UP, slip: bool = False) -> None:
        self._encoder = NgimuEncoder(axes, slip)
        self._warmth = Pace()

    def receive(self, _: bytes) -> bytes:
        """Commands have no answer."""
        return b""

    def measure(self, sample: Sample) -> bytes:
        """The bundle of a new measurement."""
        due = self._warmth.due(sample.device_ns, RATE_HZ)
        return self._encoder.encode(sample, warming(sample.device_ns) if due else None)
