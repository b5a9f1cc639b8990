"""Heart: WitMotion (WT901, HWT90x, JY901, BWT): 11-byte frames ``55 TYPE …`` and a byte sum.

One sample is a burst of frames: acceleration, rate, then what else is switched on. It carries no count,
and time only if frame 0x50 is on, in whole milliseconds. Unverified: axes (taken as x ahead, z up: say
axes= otherwise), the scale of the field (chip-dependent, so it is given as counts, relative), the order
of the quaternion (w first, as the maker says) and its earth frame (taken as east–north–up).
"""

from __future__ import annotations

import math
import struct
from datetime import date

from app.formats.mounting import Axes
from app.formats.saturation import RANGES
from app.formats.wire.making import ENU, Z_UP, Maker, Taker, quantised, scaled
from app.formats.wire.pace import Pace
from app.formats.wire.stream import NO_PACKET, UNKNOWN_YET, Frames, find_header
from app.formats.wire.talk import Ask, Script
from app.formats.wire.ticks import ArrivalClock, DeviceClock
from app.formats.wire.warmth import believed, warming
from app.motion.basics import G_MPS2, Quaternion, Vector
from app.motion.samples import GAP_NS, Sample

FASTEST_HZ = 200.0
BAUDS = (115200, 9600, 921600, 460800, 38400)
RATES_HZ = {10: 0x06, 20: 0x07, 50: 0x08, 100: 0x09, 200: 0x0B}
TIME, ACCEL, GYRO, ANGLES, MAG, QUATERNION = 0x50, 0x51, 0x52, 0x53, 0x54, 0x59
UNLOCK, SAVE = b"\xff\xaa\x69\x88\xb5", b"\xff\xaa\x00\x00\x00"

_SIZE = 11
_WORDS = struct.Struct("<xx4hx")
_TIME = struct.Struct("<xx6BHx")
_FORCE = 16 * G_MPS2 / 32768
_RATE = math.radians(2000) / 32768
_UNIT = 1 / 32768
_DEGREE = 0.01
_DAY_MS = 86_400_000
_FIRST_DAY = date(2000, 1, 1).toordinal()


def framed(kind: int, data: bytes) -> bytes:
    """A frame of eight bytes of data."""
    head = bytes([0x55, kind]) + data
    return head + bytes([sum(head) & 0xFF])


def frames() -> Frames:
    """The frames of a stream."""
    return Frames(find_header(b"\x55"), _size, holds, _SIZE)


def _size(data: bytes, at: int) -> int:
    if len(data) < at + 2:
        return UNKNOWN_YET
    return _SIZE if 0x50 <= data[at + 1] <= 0x5A else NO_PACKET


def holds(frame: bytes) -> bool:
    """Whether the last byte is the sum of those before it."""
    return sum(frame[:-1]) & 0xFF == frame[-1]


class WitmotionDecoder:
    """Samples out of bursts of frames.

    A burst ends with the frame that ended the one before it, so that no sample waits for the next
    burst; frames that rubbish parted are never put together. Without frame 0x50 the samples are
    stamped by count, held to their arrival: give ``rate_hz`` if it is known.
    """

    def __init__(self, sensor: str, axes: Axes = Z_UP, rate_hz: float | None = None) -> None:
        self.notes = ["WitMotion: the magnetic field is in counts, relative: its scale depends on the chip"]
        self._frames = frames()
        self.counters = self._frames.counters
        self._maker = Maker(sensor, axes, RANGES["witmotion"], earth=ENU)
        self._clock = DeviceClock(1_000_000, 40)
        self._arrival = ArrivalClock(rate_hz)
        self._timed: bool | None = None
        self._dated = 0  # bursts in a row that tell their time
        self._untimed_ns = 0  # the last stamp by arrival
        self._ahead_ns = 0  # what keeps its calendar behind that
        self._burst: dict[int, bytes] = {}
        self._kinds: frozenset[int] | None = None  # of a whole burst
        self._newest = b""  # frame of the acceleration

    @property
    def temperature_c(self) -> float | None:
        """What stands beside the newest acceleration, °C."""
        return believed(_WORDS.unpack(self._newest)[3] * _DEGREE) if self._newest else None

    def feed(self, data: bytes, host_ns: int) -> list[Sample]:
        """The samples that ``data``, arrived at ``host_ns``, completes."""
        samples = []
        for i, frame in enumerate(self._frames.feed(data)):
            kind = frame[1]
            parted = i in self._frames.breaks
            if self._burst and (parted or kind <= max(self._burst)):
                samples += self._close(host_ns, whole=not parted)
            self._burst[kind] = frame
            if self._kinds is not None and self._kinds <= self._burst.keys():
                samples += self._close(host_ns, whole=True)
        return samples

    def _close(self, host_ns: int, whole: bool) -> list[Sample]:
        burst, self._burst = self._burst, {}
        if whole or self._kinds is None:
            self._kinds = frozenset(burst)
        if ACCEL not in burst and GYRO not in burst:
            self.counters.unknown += len(burst)
            return []
        sample = self._read(burst, host_ns) if ACCEL in burst and GYRO in burst else None
        self.counters.dropped += sample is None
        return [] if sample is None else [sample]

    def _read(self, burst: dict[int, bytes], host_ns: int) -> Sample | None:
        device_ns = self._stamp(burst.get(TIME), host_ns)
        if device_ns is None:
            return None
        self._newest = burst[ACCEL]
        force, rate = scaled(_words(burst[ACCEL]), _FORCE), scaled(_words(burst[GYRO]), _RATE)
        field = _words(burst[MAG]) if MAG in burst else None
        q: Quaternion | None = None
        if QUATERNION in burst:
            w, x, y, z = _WORDS.unpack(burst[QUATERNION])
            q = (w * _UNIT, x * _UNIT, y * _UNIT, z * _UNIT)
        return self._maker.make(device_ns, host_ns, force, rate, field, 0, q)

    def _stamp(self, frame: bytes | None, host_ns: int) -> int | None:
        """By its calendar where it sends that: from the first burst on, or from two in a row on.

        What it sent before it was set up comes without, and so does a stream joined behind its first frame.
        """
        self._dated = 0 if frame is None else self._dated + 1
        if self._timed is None:
            self._timed = frame is not None
        if not self._timed and self._dated < 2:
            self._untimed_ns = self._arrival.stamp(host_ns)
            return self._untimed_ns
        stamp_ns = None if frame is None else self._clock.stamp(_milliseconds(frame), host_ns)
        if stamp_ns is None:
            return None
        if not self._timed:  # never back, nor years ahead: a gap
            self._timed, self._ahead_ns = True, self._untimed_ns + GAP_NS + 1 - stamp_ns
        return stamp_ns + self._ahead_ns


def _words(frame: bytes) -> Vector:
    x, y, z, _ = _WORDS.unpack(frame)
    return (float(x), float(y), float(z))


def _milliseconds(frame: bytes) -> int:
    """Milliseconds of the device's calendar since it began, 2000; a date that is none counts as that day."""
    year, month, day, hour, minute, second, ms = _TIME.unpack(frame)
    try:
        days = date(2000 + year, month, day).toordinal() - _FIRST_DAY
    except ValueError:
        days = 0
    milliseconds: int = days * _DAY_MS + ((hour * 60 + minute) * 60 + second) * 1000 + ms
    return milliseconds


class WitmotionEncoder:
    """A sample as one burst: time (if ``timed``), acceleration, rate, field, quaternion.

    ``temperature_c`` is what its thermometer reads.
    """

    def __init__(self, axes: Axes = Z_UP, timed: bool = False) -> None:
        self._taker = Taker(axes, RANGES["witmotion"], earth=ENU)
        self._timed = timed
        self.temperature_c = 25.0

    def encode(self, sample: Sample) -> bytes:
        """The burst with everything the sample has."""
        kinds = [TIME] if self._timed else []
        kinds += [ACCEL, GYRO]
        kinds += [MAG] if sample.field_b is not None else []
        kinds += [QUATERNION] if sample.device_q_nb is not None else []
        return self.burst(sample, kinds)

    def burst(self, sample: Sample, kinds: list[int]) -> bytes:
        """The frames of these kinds; those unknown here are left out."""
        return b"".join(self._frame(kind, sample) for kind in kinds)

    def _frame(self, kind: int, sample: Sample) -> bytes:
        taker = self._taker
        match kind:
            case 0x50:
                return framed(kind, _calendar(sample.device_ns))
            case 0x51:
                return framed(kind, self._codes(taker.force(sample), _FORCE))
            case 0x52:
                return framed(kind, self._codes(taker.rate(sample), _RATE))
            case 0x54:
                return framed(kind, self._codes(taker.field(sample), 1.0))
            case 0x59:
                return framed(
                    kind, struct.pack("<4h", *(quantised(part, _UNIT) for part in taker.orientation(sample)))
                )
        return b""

    def _codes(self, v: Vector, lsb: float) -> bytes:
        codes = (quantised(value, lsb) for value in v)
        return struct.pack("<4h", *codes, quantised(self.temperature_c, _DEGREE))


def _calendar(device_ns: int) -> bytes:
    """The time as the device says it, from the first day of 2000."""
    seconds, ms = divmod(round(device_ns / 1_000_000), 1000)
    days, seconds = divmod(seconds, 86400)
    today = date.fromordinal(_FIRST_DAY + days)
    hours, minutes = seconds // 3600, seconds // 60 % 60
    return struct.pack("<6BH", today.year - 2000, today.month, today.day, hours, minutes, seconds % 60, ms)


# --- setting it up: nothing is ever answered -----------------------------------------------------


def start_up(rate_hz: float = 100.0) -> Script[float]:
    """Unlock, the nearest rate it has, time + acceleration + rate + field; the result is that rate.

    100 Hz of these four frames is 44 kbit/s: more than its usual 9600 baud carries.
    """
    rate = min(RATES_HZ, key=lambda offered: abs(math.log(offered / max(rate_hz, 0.01))))
    for send, what in (
        (UNLOCK, "unlocking it"),
        (bytes([0xFF, 0xAA, 0x03, RATES_HZ[rate], 0]), f"choosing {rate:g} Hz"),
        (bytes([0xFF, 0xAA, 0x02, 0x17, 0]), "choosing its frames"),
    ):
        yield Ask(send, what, timeout_s=0.1)
    return float(rate)


class WitmotionDevice:
    """A WitMotion sensor as its host sees it: ``receive`` its settings, ``measure`` a sample.

    It never answers; freshly made it sends ten times a second.
    """

    def __init__(self, axes: Axes = Z_UP) -> None:
        self.outputs = 0x1E  # bit n: frame 0x50 + n
        self.rate_code = 0x06
        self._unlocked = False
        self._pace = Pace()
        self._encoder = WitmotionEncoder(axes)
        self._pending = b""

    def receive(self, data: bytes) -> bytes:
        """Take settings; there is never a reply."""
        self._pending += data
        while (at := self._pending.find(b"\xff\xaa")) >= 0 and len(self._pending) >= at + 5:
            self._set(self._pending[at + 2], self._pending[at + 3 : at + 5])
            self._pending = self._pending[at + 5 :]
        self._pending = self._pending[-4:]
        return b""

    def measure(self, sample: Sample) -> bytes:
        """The burst of the frames that are switched on, whenever one is due."""
        if not self._pace.due(sample.device_ns, self.rate_hz):
            return b""
        self._encoder.temperature_c = warming(sample.device_ns)
        return self._encoder.burst(sample, [0x50 + n for n in range(11) if self.outputs >> n & 1])

    @property
    def rate_hz(self) -> float:
        """How often it sends: give it samples at this rate."""
        return next((float(rate) for rate, code in RATES_HZ.items() if code == self.rate_code), 10.0)

    def _set(self, register: int, value: bytes) -> None:
        if register == 0x69:
            self._unlocked = value == b"\x88\xb5"
        elif self._unlocked and register == 0x02:
            self.outputs = int.from_bytes(value, "little")
        elif self._unlocked and register == 0x03:
            self.rate_code = value[0]
