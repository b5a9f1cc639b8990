"""Heart: how a 3DM-GX1 is started, and how it answers: its start-up and a model of the device."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from app.formats.mounting import AS_GIVEN, Axes
from app.formats.wire.gx1 import (
    EULER,
    LENGTHS,
    QUATERNION,
    QUATERNION_2,
    VECTORS,
    Gx1Encoder,
    Gx1Setup,
    framed,
    holds,
)
from app.formats.wire.pace import Pace
from app.formats.wire.talk import Ask, FindAnswer, RefusedError, Script
from app.formats.wire.warmth import warming
from app.motion.basics import G_MPS2, Quaternion, Vector
from app.motion.samples import Sample
from app.rotation import conjugate, rotate

AUTO_BAUDS = (38400, 115200, 19200)
#: EEPROM: baud code, stabilisation, gains, auto-start, and the four words that make the clock.
FACTORY = {44: 64, 122: 1, 130: 10000, 132: 0, 230: 8500, 232: 2000, 238: 16, 240: 16, 242: 256, 246: 1}
#: The same, sped up to 333 Hz at 115200 baud, as four drivers do.
FASTEST = FACTORY | {44: 21, 238: 4, 240: 10, 242: 250, 246: 3}

STOP = b"\x10\x00\x00"
_CLEAR = 0.5  # of g or of a matrix element: enough to tell a sign
_STREAMS = (0x01, 0x02, 0x03, 0x04, 0x05, 0x07, 0x0A, 0x0B, 0x0C, 0x0D, 0x0E, 0x12, 0x31)


# --- starting a unit -----------------------------------------------------------------------------


def start_up(command: int = QUATERNION) -> Script[Gx1Setup]:
    """Stop, ask who it is, read its calibration, settle signs (hold it still), stream ``command``."""
    yield Ask(STOP, "stopping its stream", timeout_s=1.0, quiet_s=0.05)
    if (yield Ask(STOP, "waiting for a GX1", reply(0x10, b"\x00\x00"), 1.0)) is None:
        raise RefusedError("no 3DM-GX1 answers: check port, baud rate (38400, 115200 or 19200) and power")
    notes: list[str] = []
    firmware = _word((yield Ask(b"\xf0", "reading the firmware version", reply(0xF0))))
    serial = _word((yield Ask(b"\xf1", "reading the serial number", reply(0xF1))))
    words: dict[int, int] = {}
    for address in (130, 230, 232, 238, 240, 242, 246):
        answer = yield Ask(bytes([0x28, 0, address]), f"reading EEPROM {address}", reply(0x28))
        if answer is not None:
            words[address] = _word(answer) or 0
    matrix = yield Ask(b"\x0b", "settling its signs: hold it still", reply(0x0B))
    vectors = yield Ask(b"\x03", "settling its signs: hold it still", reply(0x03))
    quaternion = yield Ask(b"\x05", "settling its signs: hold it still", reply(0x05))
    gyro_gain, accel_gain, mag_gain = _gains(words, notes)
    reports_gravity = _reports_gravity(matrix, vectors, accel_gain, notes)
    earth_to_body = _earth_to_body(matrix, quaternion, notes)
    if (yield Ask(bytes([0x10, 0, command]), "starting its stream", reply(0x10), 1.0)) is None:
        raise RefusedError("the 3DM-GX1 answers but does not start to stream: switch it off and on")
    return Gx1Setup(
        accel_gain,
        gyro_gain,
        mag_gain,
        _tick_ns(words),
        reports_gravity,
        earth_to_body,
        command,
        "" if serial is None else str(serial),
        "" if firmware is None else version(firmware),
        tuple(notes),
    )


def version(number: int) -> str:
    """3102 is 3.1.02."""
    return f"{number // 1000}.{number % 1000 // 100}.{number % 100:02d}"


def reply(command: int, begins: bytes = b"") -> FindAnswer:
    """Finds a whole, sound reply, whatever stream it stands in."""

    def find(data: bytes) -> tuple[int, int] | None:
        head = bytes([command]) + begins
        at = data.find(head)
        while 0 <= at <= len(data) - LENGTHS[command]:
            if holds(data[at : at + LENGTHS[command]]):
                return at, at + LENGTHS[command]
            at = data.find(head, at + 1)
        return None

    return find


def _word(answer: bytes | None) -> int | None:
    return None if answer is None else int.from_bytes(answer[1:3])


def _gains(words: Mapping[int, int], notes: list[str]) -> tuple[int, int, int]:
    usual = {130: 8500, 230: 7000, 232: 2000}
    for address, name in ((130, "gyro"), (230, "accelerometer"), (232, "magnetometer")):
        if not words.get(address):
            notes.append(f"{name} gain {usual[address]} assumed: EEPROM {address} could not be read")
    gyro, accel, mag = (words.get(address) or value for address, value in usual.items())
    notes.append(f"gains: accelerometer {accel}, gyro {gyro}, magnetometer {mag}")
    return gyro, accel, mag


def _tick_ns(words: Mapping[int, int]) -> int | None:
    """The tick that the EEPROM says, where it is certain what it says."""
    if words.get(246) != 1 or not all(words.get(address) for address in (238, 240, 242)):
        return None
    return words[238] * words[240] * words[242] * 100


def _triple(message: bytes, first: int) -> Vector:
    x, y, z = (
        int.from_bytes(message[1 + 2 * i : 3 + 2 * i], signed=True) / 8192 for i in range(first, first + 3)
    )
    return (x, y, z)


def _reports_gravity(matrix: bytes | None, vectors: bytes | None, gain: int, notes: list[str]) -> bool:
    """Whether the accelerometer points down: along the third column of M, which takes earth to body."""
    if matrix is not None and vectors is not None:
        per_g = 8192 * gain / 32_768_000 if gain else 0.0
        upward_g = -per_g * sum(a * b for a, b in zip(_triple(matrix, 6), _triple(vectors, 3), strict=True))
        if abs(upward_g) > _CLEAR:
            notes.append(
                f"accelerometer reads {'specific force' if upward_g > 0 else 'gravity'}, seen at rest"
            )
            return upward_g < 0
    notes.append("accelerometer taken to read specific force: its sign could not be seen")
    return False


def _earth_to_body(matrix: bytes | None, quaternion: bytes | None, notes: list[str]) -> bool:
    """Whether the quaternion turns as M does; where it turns too little to tell, the manual is believed."""
    if matrix is not None and quaternion is not None:
        q = _quaternion(quaternion)
        turned = [component for axis in range(3) for component in rotate(q, _unit(axis))]  # by columns, as M
        back = [
            component for axis in range(3) for component in rotate((q[0], -q[1], -q[2], -q[3]), _unit(axis))
        ]
        m = [*_triple(matrix, 0), *_triple(matrix, 3), *_triple(matrix, 6)]
        preference = math.dist(back, m) - math.dist(turned, m)
        if abs(preference) > _CLEAR:
            return preference > 0
    notes.append("quaternion taken to turn earth to body, as its manual says: not seen")
    return True


def _quaternion(message: bytes) -> Quaternion:
    w, x, y = _triple(message, 0)
    return (w, x, y, _triple(message, 1)[2])


def _columns(q: Quaternion) -> list[float]:
    """The matrix of q, column by column, the order in which M is sent."""
    return [component for axis in range(3) for component in rotate(q, _unit(axis))]


def _unit(axis: int) -> Vector:
    return (float(axis == 0), float(axis == 1), float(axis == 2))


# --- being a unit --------------------------------------------------------------------------------

_ARGUMENTS = {0x08: 1, 0x09: 5, 0x0F: 3, 0x10: 2, 0x11: 3, 0x28: 2, 0x29: 6, 0x40: 2, 0x42: 5}
_REST = Sample("", 0, 0, 0, (0.0, 0.0, -G_MPS2), (0.0, 0.0, 0.0), (20.0, 0.0, 40.0))


class Gx1Device:
    """A 3DM-GX1 as its host sees it: ``receive`` its commands, ``measure`` a sample.

    A calculation takes 2 ticks for vectors and 3 for a quaternion, or as many as EEPROM 246 says.
    ``reports_gravity`` and ``earth_to_body`` choose what no
    source settles. The host's unknown commands are met with silence, and so are the two whose
    arguments nobody knows (0x24, 0x25).
    """

    FIRMWARE, SERIAL = 3102, 1234

    def __init__(
        self,
        axes: Axes = AS_GIVEN,
        eeprom: Mapping[int, int] = FACTORY,
        reports_gravity: bool = False,
        earth_to_body: bool = True,
    ) -> None:
        self.eeprom = dict(eeprom)
        self.streams = self.eeprom.get(132, 0)
        self._axes = axes
        self._signs = (reports_gravity, earth_to_body)
        self._newest = _REST
        self._pace = Pace()
        self._pending = b""
        self._encoder = self._made()

    def receive(self, data: bytes) -> bytes:
        """The replies to what the host sent; an unfinished command waits for its rest."""
        self._pending += data
        replies = b""
        while self._pending:
            length = 1 + _ARGUMENTS.get(self._pending[0], 0)
            if len(self._pending) < length:
                break
            command, self._pending = self._pending[:length], self._pending[length:]
            replies += self._reply(command)
        return replies

    def measure(self, sample: Sample) -> bytes:
        """Take a new measurement; in continuous mode, the message it sends."""
        if not self._pace.due(sample.device_ns, self.rate_hz):
            return b""
        self._newest = sample
        return self._measurement(self.streams)

    @property
    def rate_hz(self) -> float:
        """How often it measures: give it samples at this rate."""
        ticks = max(self.eeprom.get(246, 1), 2 if self.streams in (0x02, VECTORS) else 3)
        return 1e9 / (ticks * self._tick_ns)

    def _made(self) -> Gx1Encoder:
        word = self.eeprom.get
        self._tick_ns = max(word(238, 16) * word(240, 16) * word(242, 256), 1) * 100
        gains = (word(230, 8500), word(130, 10000), word(232, 2000))
        return Gx1Encoder(self._axes, Gx1Setup(*gains, self._tick_ns, *self._signs))

    def _reply(self, command: bytes) -> bytes:
        code, ticks = command[0], self._encoder.ticks(self._newest)
        if code in _STREAMS:
            return self._measurement(code)
        if code == 0x10:
            return self._start(command[2], ticks)
        if code in (0x08, 0x28):
            value = self.eeprom.get(command[-1], 0)
            return value.to_bytes(2) if code == 0x08 else framed(0x28, value, ticks)
        if code in (0x09, 0x29):
            return self._write(command, ticks)
        if code in (0xF0, 0xF1):
            return framed(code, self.FIRMWARE if code == 0xF0 else self.SERIAL)
        if code in (0x06, 0x0F, 0x11, 0x40):
            return framed(code, ticks)
        return framed(0x27, 0) if code == 0x27 else b""

    def _start(self, command: int, ticks: int) -> bytes:
        if command and command not in _STREAMS:
            return b""
        self.streams = command
        return framed(0x10, command, ticks)

    def _write(self, command: bytes, ticks: int) -> bytes:
        if command[1] != 0x71 or command[-1] != 0xAA:
            return b""
        value = int.from_bytes(command[-3:-1])
        self.eeprom[command[-4]] = value  # the clock's and the gains' words take effect at power-up
        return value.to_bytes(2) if command[0] == 0x09 else framed(0x29, value, ticks)

    def _measurement(self, code: int) -> bytes:
        encoder, sample = self._encoder, self._newest
        if code in (VECTORS, QUATERNION, QUATERNION_2, EULER):
            return encoder.message(code, sample)
        words: dict[int, Callable[[], list[int]]] = {
            0x01: lambda: [word ^ 0x8000 for word in self._vectors()],  # codes of an imagined converter
            0x02: self._vectors,
            0x04: lambda: encoder.quaternion(sample),
            0x05: lambda: encoder.quaternion(sample),
            0x07: lambda: [encoder.temperature(warming(sample.device_ns))],
            0x0A: self._matrix,
            0x0B: self._matrix,
            0x0D: lambda: encoder.euler(sample),
            0x0E: lambda: encoder.euler(sample),
        }
        return framed(code, *words[code](), encoder.ticks(sample)) if code in words else b""

    def _vectors(self) -> list[int]:
        message = self._encoder.message(VECTORS, self._newest)
        return [int.from_bytes(message[i : i + 2]) for i in range(1, 19, 2)]

    def _matrix(self) -> list[int]:
        """M, which takes earth to body, by columns."""
        w, x, y, z = (code / 8192 for code in self._encoder.quaternion(self._newest))
        q: Quaternion = (w, x, y, z)
        return [round(8192 * part) for part in _columns(q if self._signs[1] else conjugate(q))]
