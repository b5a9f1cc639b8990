"""Heart: how an x-IMU3 is started, and how it answers: one-key JSON commands and a model of the device."""

from __future__ import annotations

import json
from dataclasses import dataclass

from app.formats.mounting import Axes
from app.formats.wire.making import Z_UP
from app.formats.wire.pace import Pace
from app.formats.wire.talk import Ask, FindAnswer, RefusedError, Script
from app.formats.wire.warmth import RATE_HZ, warming
from app.formats.wire.ximu3 import Ximu3Encoder
from app.motion.samples import Sample

BAUDS = (115200, 921600)
BASE_HZ = 400
_FIELD_HZ = 20.0
_LONGEST = 1024
#: So often it is asked who it is, until two answers agree.
PINGS = 10


@dataclass(frozen=True)
class Ximu3Setup:
    """Who answered, and at which rate it was set to send."""

    name: str = ""
    serial: str = ""
    rate_hz: float = 0.0
    notes: tuple[str, ...] = ()


def start_up(rate_hz: float = 400.0) -> Script[Ximu3Setup]:
    """Ping, and an inertial rate near ``rate_hz``: 400 Hz over a whole number."""
    who = yield from _who()
    divisor = min(max(round(BASE_HZ / rate_hz), 1), BASE_HZ)
    for key in ("inertialMessageRateDivisor", "ahrsMessageRateDivisor"):
        yield _ask(key, divisor, f"choosing {BASE_HZ / divisor:g} Hz")
    yield _ask("apply", None, "applying its settings")
    name = who.get("deviceName", who.get("name", ""))
    serial = who.get("serialNumber", who.get("sn", ""))
    return Ximu3Setup(str(name), str(serial), BASE_HZ / divisor)


def _who() -> Script[dict[str, object]]:
    """What it says of itself, twice the same: a line without a checksum may be damaged and read well."""
    seen: list[dict[str, object]] = []
    for _ in range(PINGS):
        answer = yield _ask("ping", None, "waiting for an x-IMU3")
        if answer is None:
            break
        who = _value(answer, "ping")
        if isinstance(who, dict):
            if who in seen:
                return who
            seen.append(who)
    if not seen:
        raise RefusedError("no x-IMU3 answers: check the port or address, and its power")
    return {}


def command(key: str, value: object) -> bytes:
    """A one-key command, or its answer."""
    return json.dumps({key: value}, separators=(",", ":")).encode() + b"\r\n"


def _ask(key: str, value: object, what: str) -> Ask:
    return Ask(command(key, value), what, _answer(key), 0.5)


def _answer(key: str) -> FindAnswer:
    """Finds the line whose one key is the command's."""

    def find(data: bytes) -> tuple[int, int] | None:
        at = data.find(b'{"' + key.encode() + b'"')
        end = data.find(b"\n", at) + 1
        return (at, end) if at >= 0 and end > 0 else None

    return find


def _value(line: bytes | None, key: str) -> object:
    try:
        return None if line is None else json.loads(line).get(key)
    except (ValueError, RecursionError):
        return None


class Ximu3Device:
    """An x-IMU3 as its host sees it: ``receive`` its commands, ``measure`` a sample.

    Its divisor is kept by leaving samples out, though the device averages. The magnetometer keeps
    to 20 Hz, the thermometer to 1 Hz.
    """

    def __init__(self, axes: Axes = Z_UP, binary: bool = True, name: str = "emulated") -> None:
        self.settings: dict[str, object] = {"deviceName": name, "serialNumber": "0123-4567"}
        self.settings |= {"binaryModeEnabled": binary, "inertialMessageRateDivisor": 8}
        self.settings |= {"ahrsMessageRateDivisor": 8}
        self._encoders = {True: Ximu3Encoder(axes, True), False: Ximu3Encoder(axes, False)}
        self._paces = {kind: Pace() for kind in ("field", "orientation", "inertial", "warmth")}
        self._pending = b""

    def receive(self, data: bytes) -> bytes:
        """The answers to its commands; what is no command is passed over."""
        *lines, self._pending = (self._pending + data).split(b"\n")
        self._pending = self._pending[-_LONGEST:]
        return b"".join(self._reply(line) for line in lines)

    def measure(self, sample: Sample) -> bytes:
        """Take a new measurement; the messages that are due."""
        encoder = self._encoders[bool(self.settings["binaryModeEnabled"])]
        sent = b""
        if self._paces["warmth"].due(sample.device_ns, RATE_HZ):
            sent += encoder.temperature(sample, warming(sample.device_ns))
        if sample.field_b is not None and self._paces["field"].due(sample.device_ns, _FIELD_HZ):
            sent += encoder.field(sample)
        if sample.device_q_nb is not None and self._due("orientation", "ahrsMessageRateDivisor", sample):
            sent += encoder.orientation(sample)
        due = self._due("inertial", "inertialMessageRateDivisor", sample)
        return sent + (encoder.inertial(sample) if due else b"")

    @property
    def rate_hz(self) -> float:
        """How often it sends inertial messages: give it samples at this rate."""
        return self._rate_hz("inertialMessageRateDivisor") or float(BASE_HZ)

    def _due(self, kind: str, key: str, sample: Sample) -> bool:
        rate_hz = self._rate_hz(key)
        return rate_hz > 0.0 and self._paces[kind].due(sample.device_ns, rate_hz)

    def _rate_hz(self, key: str) -> float:
        """0: these messages are switched off."""
        divisor = self.settings[key]
        return BASE_HZ / divisor if isinstance(divisor, int) and divisor > 0 else 0.0

    def _reply(self, line: bytes) -> bytes:
        try:
            asked = json.loads(line)
        except (ValueError, RecursionError):
            return b""
        if not isinstance(asked, dict) or len(asked) != 1:
            return b""
        ((key, value),) = asked.items()
        if key == "ping":
            who = {"interface": "Serial"} | {k: self.settings[k] for k in ("deviceName", "serialNumber")}
            return command(key, who)
        if key in self.settings and value is not None:
            self.settings[key] = value
        return command(key, self.settings.get(key))
