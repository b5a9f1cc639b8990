"""Heart: MicroStrain 3DM-GX1 and its ancestor 3DM-G: replies of one command byte, words, a word sum.

Unverified, so settled when the device is started (``gx1_talk``) and told by a ``Gx1Setup``: the sign
of the accelerometer, the direction of the quaternion, the length of a tick after its speed-up.
Axes: x ahead, y right, z down, so the mounting is as given.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

from app.formats.mounting import AS_GIVEN, Axes
from app.formats.saturation import RANGES
from app.formats.wire.making import Maker, Taker, quantised, scaled
from app.formats.wire.stream import NO_PACKET, Frames, find_first
from app.formats.wire.ticks import DeviceClock, TickLength
from app.formats.wire.warmth import believed
from app.motion.basics import G_MPS2, Quaternion, Vector
from app.motion.samples import Sample
from app.rotation import conjugate, from_yaw_pitch_roll, pitch_of, roll_of, yaw_of

FACTORY_TICK_NS = 6_553_600
FASTEST_HZ = 333.0
#: Whole replies in bytes. Old EEPROM commands (0x08, 0x09) have neither header nor checksum.
LENGTHS = {0x01: 23, 0x02: 23, 0x03: 23, 0x04: 13, 0x05: 13, 0x06: 5, 0x07: 7, 0x0A: 23, 0x0B: 23, 0x0C: 31}
LENGTHS |= {0x0D: 11, 0x0E: 11, 0x0F: 5, 0x10: 7, 0x11: 5, 0x12: 31, 0x24: 5, 0x25: 11, 0x27: 5, 0x28: 7}
LENGTHS |= {0x29: 7, 0x31: 23, 0x40: 5, 0x41: 23, 0x42: 11, 0xF0: 5, 0xF1: 5}
#: Messages with accelerometer and rate. 0x02 is not one: its acceleration is the filter's own vertical.
VECTORS, QUATERNION, QUATERNION_2, EULER = 0x03, 0x0C, 0x12, 0x31
#: Asked for now and then while it streams.
TEMPERATURE = 0x07

_UNIT = 1 / 8192  # quaternion and matrix elements
_ANGLE = math.tau / 65536
_HALF_TURN = 32768
_VOLTS = 5 / 65536  # of the thermometer's code: 10 mV a degree, 0.5 V at 0 °C
_ANCESTORS_DEGREES = 0.12207
_KNOWN_TICKS_NS = (FACTORY_TICK_NS, 1_000_000, 3_000_000, 10_000_000)
_WORDS = {length: struct.Struct(f">{length // 2}H") for length in set(LENGTHS.values())}
_VECTORS = struct.Struct(">x9hH")
_QUATERNION = struct.Struct(">x13hH")


@dataclass(frozen=True)
class Gx1Setup:
    """What a unit's start-up found. The gains are its calibration; these are only the manual's.

    ``tick_ns`` None: measured against the host's clock in the first five seconds of the stream.
    """

    accel_gain: int = 7000
    gyro_gain: int = 8500
    mag_gain: int = 2000
    tick_ns: int | None = None
    reports_gravity: bool = False  # its accelerometer points down at rest
    earth_to_body: bool = True  # its quaternion is v_body = q ⊗ v_earth ⊗ q*, as the manual says
    command: int = QUATERNION  # what it streams
    serial: str = ""
    firmware: str = ""
    notes: tuple[str, ...] = ()

    @property
    def is_3dm_g(self) -> bool:
        """The ancestor's scales; told by its gyro gain of 64."""
        return self.gyro_gain < 1000

    def scales(self) -> Vector:
        """m/s², rad/s and µT a code. The ancestor's field is relative: 1 is the field around it."""
        force_sign = -1.0 if self.reports_gravity else 1.0
        if self.is_3dm_g:
            gain = max(self.gyro_gain, 1)
            return (force_sign * _UNIT * G_MPS2, 1.0 / (gain * 8192 * 0.0065536), _UNIT)
        codes = 32_768_000
        force = force_sign * self.accel_gain / codes * G_MPS2
        return (force, self.gyro_gain / codes, self.mag_gain / codes * 100.0)


def celsius(code: int, is_3dm_g: bool) -> float:
    """What its thermometer's code says, °C."""
    return code * _ANCESTORS_DEGREES if is_3dm_g else (code * _VOLTS - 0.5) * 100.0


def _thermometer(degrees: float, is_3dm_g: bool) -> int:
    """The inverse of ``celsius``."""
    return round(degrees / _ANCESTORS_DEGREES if is_3dm_g else (degrees / 100.0 + 0.5) / _VOLTS) & 0xFFFF


def frames() -> Frames:
    """The packets of a stream: known headers, their lengths, the word sum."""
    return Frames(find_first(bytes(LENGTHS)), _size, holds, max(LENGTHS.values()))


def _size(data: bytes, at: int) -> int:
    return LENGTHS.get(data[at], NO_PACKET)


def holds(message: bytes) -> bool:
    """Whether the word sum of a whole message is right."""
    words: tuple[int, ...] = _WORDS[len(message)].unpack_from(message, 1)
    return (message[0] + sum(words) - words[-1]) & 0xFFFF == words[-1]


class Gx1Decoder:
    """Samples out of a GX1's stream; polled replies are understood too."""

    def __init__(self, sensor: str, axes: Axes = AS_GIVEN, setup: Gx1Setup | None = None) -> None:
        self.setup = setup or Gx1Setup()
        self.notes = list(self.setup.notes)
        self._frames = frames()
        self.counters = self._frames.counters
        self._maker = Maker(sensor, axes, RANGES["gx1"])
        self._force, self._rate, self._field = self.setup.scales()
        self._ticks = TickLength(_KNOWN_TICKS_NS, 16)
        from_yaw_pitch_roll(0.0, 0.0, 0.0)  # compiled on its first call: no sample waits for it
        conjugate((1.0, 0.0, 0.0, 0.0))
        self._clock = None if self.setup.tick_ns is None else DeviceClock(self.setup.tick_ns, 16)
        self.temperature_c: float | None = None  # newest, °C
        self._held: list[tuple[bytes, int]] = []  # messages and arrivals until the tick's length is known

    def feed(self, data: bytes, host_ns: int) -> list[Sample]:
        """The samples that ``data``, arrived at ``host_ns``, completes."""
        samples: list[Sample] = []
        for message in self._frames.feed(data):
            if message[0] == TEMPERATURE:
                told = celsius(int.from_bytes(message[1:3]), self.setup.is_3dm_g)
                self.temperature_c = believed(told, self.temperature_c)
            elif message[0] not in (VECTORS, QUATERNION, QUATERNION_2, EULER):
                self.counters.unknown += 1
            elif self._clock is None:
                samples += self._hold(message, host_ns)
            else:
                samples += self._read(self._clock, message, host_ns)
        return samples

    def _hold(self, message: bytes, host_ns: int) -> list[Sample]:
        """Keep a message until the tick is measured: stamps wrong by a factor would be worse than late."""
        self._held.append((message, host_ns))
        tick_ns = self._ticks.add(int.from_bytes(message[-4:-2]), host_ns)
        if tick_ns is None:
            return []
        how = "measured and known" if self._ticks.snapped else "assumed: it fits no known length"
        self.notes.append(f"GX1 tick of {tick_ns / 1e6:g} ms {how}")
        self._clock = clock = DeviceClock(tick_ns, 16)
        held, self._held = self._held, []
        return [sample for kept, at_ns in held for sample in self._read(clock, kept, at_ns)]

    def _read(self, clock: DeviceClock, message: bytes, host_ns: int) -> list[Sample]:
        field: Vector | None = None
        q_ed: Quaternion
        if len(message) == 31:
            q0, q1, q2, q3, m1, m2, m3, a1, a2, a3, w1, w2, w3, ticks = _QUATERNION.unpack_from(message)
            q_ed = (q0 * _UNIT, q1 * _UNIT, q2 * _UNIT, q3 * _UNIT)
            q_ed = conjugate(q_ed) if self.setup.earth_to_body else q_ed
            orientation: Quaternion | None = q_ed
        else:
            m1, m2, m3, a1, a2, a3, w1, w2, w3, ticks = _VECTORS.unpack_from(message)
            euler = message[0] == EULER
            orientation = from_yaw_pitch_roll(m3 * _ANGLE, m2 * _ANGLE, m1 * _ANGLE) if euler else None
        if message[0] != EULER:
            field = scaled((m1, m2, m3), self._field)
        device_ns = clock.stamp(ticks, host_ns)
        force, rate = scaled((a1, a2, a3), self._force), scaled((w1, w2, w3), self._rate)
        sample = None
        if device_ns is not None:
            sample = self._maker.make(device_ns, host_ns, force, rate, field, 0, orientation)
        self.counters.dropped += sample is None
        return [] if sample is None else [sample]


class Gx1Encoder:
    """A sample as the GX1 sends it: clipped by its sensors, in its codes, stamped in its ticks."""

    def __init__(self, axes: Axes = AS_GIVEN, setup: Gx1Setup | None = None) -> None:
        self.setup = setup or Gx1Setup()
        self._taker = Taker(axes, RANGES["gx1"])
        self._scales = self.setup.scales()
        self._tick_ns = self.setup.tick_ns or FACTORY_TICK_NS

    def encode(self, sample: Sample) -> bytes:
        """The message that the setup streams."""
        return self.message(self.setup.command, sample)

    def ticks(self, sample: Sample) -> int:
        """The device's counter at the sample's time."""
        return round(sample.device_ns / self._tick_ns) & 0xFFFF

    def message(self, command: int, sample: Sample) -> bytes:
        """The reply to ``command``, one of ``VECTORS``, ``QUATERNION``, ``QUATERNION_2``, ``EULER``."""
        triple = self._field(sample) if command != EULER else self.euler(sample)
        words = [*triple, *self._force(sample), *self._rate(sample)]
        if command in (QUATERNION, QUATERNION_2):
            words = [*self.quaternion(sample), *words]
        return framed(command, *words, self.ticks(sample))

    def temperature(self, degrees: float) -> int:
        """The thermometer's code."""
        return _thermometer(degrees, self.setup.is_3dm_g)

    def quaternion(self, sample: Sample) -> list[int]:
        """Four codes, in the direction of the setup."""
        q_ed = self._taker.orientation(sample)
        return [quantised(part, _UNIT) for part in (conjugate(q_ed) if self.setup.earth_to_body else q_ed)]

    def euler(self, sample: Sample) -> list[int]:
        """Roll, pitch and yaw in codes; a whole half turn wraps."""
        q_ed = self._taker.orientation(sample)
        angles = (roll_of(q_ed), pitch_of(q_ed), yaw_of(q_ed))
        return [(round(angle / _ANGLE) + _HALF_TURN) % 65536 - _HALF_TURN for angle in angles]

    def _force(self, sample: Sample) -> list[int]:
        return [quantised(value, self._scales[0]) for value in self._taker.force(sample)]

    def _rate(self, sample: Sample) -> list[int]:
        return [quantised(value, self._scales[1]) for value in self._taker.rate(sample)]

    def _field(self, sample: Sample) -> list[int]:
        return [quantised(value, self._scales[2]) for value in self._taker.field(sample)]


def framed(command: int, *words: int) -> bytes:
    """A reply: the command, its words (signed or not), the word sum."""
    values = [word & 0xFFFF for word in words]
    return struct.pack(f">B{len(values) + 1}H", command, *values, (command + sum(values)) & 0xFFFF)
