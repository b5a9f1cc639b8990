"""Heart: how a MIP sensor is started, and how it answers: its start-up and a model of the device."""

from __future__ import annotations

from dataclasses import replace

from app.formats.mounting import AS_GIVEN, Axes
from app.formats.wire.mip import (
    ACCEL,
    GPS_TIME,
    GYRO,
    MAG,
    ORIENTATION,
    OVER_RANGE,
    REFERENCE_TIME,
    SENSOR_DATA,
    TEMPERATURE,
    Fields,
    MipEncoder,
    MipSetup,
    fields_of,
    frames,
    holds,
    packet,
)
from app.formats.wire.pace import Pace
from app.formats.wire.stream import Frames
from app.formats.wire.talk import Ask, FindAnswer, RefusedError, Script
from app.formats.wire.warmth import RATE_HZ, warming
from app.motion.samples import Sample

BAUDS = (115200, 460800, 921600, 230400, 38400)
BASE, THREE_DM = 0x01, 0x0C
_ACK = 0xF1
#: For an answer of 90 bytes: where one in a hundred is damaged, three in five such answers are.
LONG_TRIES = 8
_WRITE = 1
PING = packet(BASE, (0x01, b""))
_ERRORS = {1: "unknown command", 2: "bad checksum", 3: "bad parameter", 4: "command failed", 5: "timed out"}
_OK, _UNKNOWN, _BAD_PARAMETER = 0, 1, 3


# --- starting a sensor ---------------------------------------------------------------------------


def start_up(rate_hz: float = 200.0) -> Script[MipSetup]:
    """Idle, ping, who it is, its base rate, the message format at about ``rate_hz``, stream, resume."""
    yield _ask(BASE, 0x02, b"", "stopping its stream")
    if (yield _ask(BASE, 0x01, b"", "waiting for a MIP sensor")) is None:
        raise RefusedError("no MIP sensor answers: check port, baud rate (115200 is usual) and power")
    who = yield replace(_ask(BASE, 0x03, b"", "reading its name"), tries=LONG_TRIES)
    model, serial, firmware = _who(who)
    generation = 7
    base_hz = _base_rate((yield _ask(THREE_DM, 0x0E, bytes([SENSOR_DATA]), "reading its base rate")), 0x8E)
    if base_hz is None:
        generation = 5
        base_hz = _base_rate((yield _ask(THREE_DM, 0x06, b"", "reading its base rate")), 0x83)
    if not base_hz:
        raise RefusedError("the MIP sensor does not tell its base rate: update its firmware")
    decimation = max(round(base_hz / rate_hz), 1)
    once = max(round(base_hz / RATE_HZ), decimation)  # the thermometer's decimation
    for optional in ([ORIENTATION, OVER_RANGE], [OVER_RANGE], [ORIENTATION], []):
        answer = yield _format(generation, decimation, [*optional, TEMPERATURE], once)
        if _error(answer) != _OK:
            answer = yield _format(generation, decimation, optional, once)
        if _error(answer) == _OK:
            break
    else:
        raise RefusedError(f"the MIP sensor refuses its message format: {_words(answer)}")
    stream = SENSOR_DATA if generation == 7 else 1
    answer = yield _ask(THREE_DM, 0x11, bytes([_WRITE, stream, 1]), "switching its stream on")
    if _error(answer) != _OK:
        raise RefusedError(f"the MIP sensor does not stream: {_words(answer)}")
    yield _ask(BASE, 0x06, b"", "starting its stream")
    notes = () if ORIENTATION in optional else ("this model sends no orientation of its own",)
    return MipSetup(model, serial, firmware, base_hz / decimation, generation, notes=notes)


def _ask(descriptor_set: int, command: int, data: bytes, what: str) -> Ask:
    return Ask(packet(descriptor_set, (command, data)), what, acknowledged(descriptor_set, command), 0.5)


def _format(generation: int, decimation: int, optional: list[int], once: int) -> Ask:
    time = REFERENCE_TIME if generation == 7 else GPS_TIME
    wanted = [time, ACCEL, GYRO, MAG, *optional]
    every = {TEMPERATURE: once}
    layout = b"".join(bytes([kind]) + every.get(kind, decimation).to_bytes(2) for kind in wanted)
    head = bytes([_WRITE, SENSOR_DATA, len(wanted)]) if generation == 7 else bytes([_WRITE, len(wanted)])
    return _ask(THREE_DM, 0x0F if generation == 7 else 0x08, head + layout, "choosing its messages")


def acknowledged(descriptor_set: int, command: int) -> FindAnswer:
    """Finds the packet of the same set that acknowledges the command, or refuses it."""

    def find(data: bytes) -> tuple[int, int] | None:
        at = data.find(b"\x75\x65" + bytes([descriptor_set]))
        while 0 <= at <= len(data) - 6:
            end = at + 6 + data[at + 3]
            whole = data[at:end]
            if end <= len(data) and holds(whole) and _acknowledges(fields_of(whole), command):
                return at, end
            at = data.find(b"\x75\x65" + bytes([descriptor_set]), at + 1)
        return None

    return find


def _acknowledges(fields: Fields, command: int) -> bool:
    return any(kind == _ACK and len(data) == 2 and data[0] == command for kind, data in fields)


def _error(answer: bytes | None) -> int | None:
    return None if answer is None else next(data[1] for kind, data in fields_of(answer) if kind == _ACK)


def _words(answer: bytes | None) -> str:
    error = _error(answer)
    return "no answer" if error is None else _ERRORS.get(error, f"error {error}")


def _data(answer: bytes | None, kind: int) -> bytes:
    return b"" if answer is None else dict(fields_of(answer)).get(kind, b"")


def _base_rate(answer: bytes | None, kind: int) -> float | None:
    data = _data(answer, kind)
    return float(int.from_bytes(data[-2:])) if len(data) >= 2 and _error(answer) == _OK else None


def _who(answer: bytes | None) -> tuple[str, str, str]:
    """Model, serial number and firmware; empty where it does not say."""
    data = _data(answer, 0x81)
    texts = [data[at : at + 16].decode("ascii", "replace").strip(" \0") for at in (2, 18, 34)]
    return texts[0], texts[2], str(int.from_bytes(data[:2])) if data else ""


# --- being a sensor ------------------------------------------------------------------------------


class MipDevice:
    """A MIP sensor as its host sees it: ``receive`` its commands, ``measure`` a sample.

    It sends at ``base_hz`` over the message format's decimation, each field at its own.
    """

    def __init__(self, axes: Axes = AS_GIVEN, generation: int = 7, base_hz: int = 1000) -> None:
        self.decimation = max(base_hz // 100, 1)
        self.streaming = True
        self.wanted = [REFERENCE_TIME if generation == 7 else GPS_TIME, ACCEL, GYRO, MAG]
        self._rarer: dict[int, Pace] = {}  # fields that come less often than the others
        self._every: dict[int, int] = {}
        self._enabled = True
        self._generation, self._base_hz = generation, base_hz
        self._encoder = MipEncoder(axes, MipSetup(generation=generation))
        self._frames: Frames = frames()
        self._pace = Pace()

    @property
    def rate_hz(self) -> float:
        """How often it sends: give it samples at this rate."""
        return self._base_hz / self.decimation

    def receive(self, data: bytes) -> bytes:
        """The replies to what the host sent; what is no packet is passed over, as the sensor does."""
        return b"".join(
            self._reply(whole[2], command, argument)
            for whole in self._frames.feed(data)
            for command, argument in fields_of(whole)
        )

    def measure(self, sample: Sample) -> bytes:
        """Take a new measurement; the packet, whenever one is due."""
        if not (self.streaming and self._enabled and self._pace.due(sample.device_ns, self.rate_hz)):
            return b""
        self._encoder.temperature_c = warming(sample.device_ns)
        ns, base_hz = sample.device_ns, self._base_hz
        left_out = [
            kind for kind, pace in self._rarer.items() if not pace.due(ns, base_hz / self._every[kind])
        ]
        return self._encoder.message(sample, [kind for kind in self.wanted if kind not in left_out])

    def _reply(self, descriptor_set: int, command: int, data: bytes) -> bytes:
        error, answer = self._obey(descriptor_set, command, data)
        return packet(descriptor_set, (_ACK, bytes([command, error])), *answer)

    def _obey(self, descriptor_set: int, command: int, data: bytes) -> tuple[int, Fields]:
        """The error code and the answer's fields."""
        newer = self._generation == 7
        match descriptor_set, command:
            case 0x01, 0x01:
                return _OK, []
            case 0x01, 0x02 | 0x06:
                self.streaming = command == 0x06
                return _OK, []
            case 0x01, 0x03:
                texts = ("Emulated MIP", "0000-0000", "0000.00001", "", "")
                return _OK, [(0x81, (1001).to_bytes(2) + b"".join(t.rjust(16).encode() for t in texts))]
            case 0x0C, 0x0E if newer and data == bytes([SENSOR_DATA]):
                return _OK, [(0x8E, bytes([SENSOR_DATA]) + self._base_hz.to_bytes(2))]
            case 0x0C, 0x06 if not newer:
                return _OK, [(0x83, self._base_hz.to_bytes(2))]
            case 0x0C, 0x0F if newer and data[:2] == bytes([_WRITE, SENSOR_DATA]):
                return self._set_format(data[2:]), []
            case 0x0C, 0x08 if not newer and data[:1] == bytes([_WRITE]):
                return self._set_format(data[1:]), []
            case 0x0C, 0x11 if len(data) == 3 and data[0] == _WRITE:
                self._enabled = data[2] != 0
                return _OK, []
        return _UNKNOWN, []

    def _set_format(self, data: bytes) -> int:
        if not data or len(data) != 1 + 3 * data[0]:
            return _BAD_PARAMETER
        entries = [(data[at], int.from_bytes(data[at + 1 : at + 3])) for at in range(1, len(data), 3)]
        if not entries or any(decimation < 1 for _, decimation in entries):
            return _BAD_PARAMETER
        self.wanted = [kind for kind, _ in entries]
        self.decimation = min(decimation for _, decimation in entries)
        self._every = {kind: every for kind, every in entries if every > self.decimation}
        self._rarer = {kind: Pace() for kind in self._every}
        return _OK
