"""Heart: how an x-IMU3 is started, and how it answers: one-key JSON commands and a model of the device."""

from __future__ import annotations

import json
from dataclasses import dataclass

from app.formats.mounting import Axes
from app.formats.wire.making import Z_UP
from app.formats.wire.talk import Ask, FindAnswer, RefusedError, Script
from app.formats.wire.ximu3 import Ximu3Encoder
from app.motion import Sample

BAUDS = (115200, 921600)
BASE_HZ = 400
_FIELD_NS = 50_000_000
_LONGEST = 1024


@dataclass(frozen=True)
class Ximu3Setup:
    """Who answered, and at which rate it was set to send."""

    name: str = ""
    serial: str = ""
    rate_hz: float = 0.0
    notes: tuple[str, ...] = ()


def start_up(rate_hz: float = 400.0) -> Script[Ximu3Setup]:
    """Ping, and an inertial rate near ``rate_hz``: 400 Hz over a whole number."""
    who = _value((yield _ask("ping", None, "waiting for an x-IMU3")), "ping")
    if not isinstance(who, dict):
        raise RefusedError("no x-IMU3 answers: check the port or address, and its power")
    divisor = min(max(round(BASE_HZ / rate_hz), 1), BASE_HZ)
    for key in ("inertialMessageRateDivisor", "ahrsMessageRateDivisor"):
        yield _ask(key, divisor, f"choosing {BASE_HZ / divisor:g} Hz")
    yield _ask("apply", None, "applying its settings")
    name = who.get("deviceName", who.get("name", ""))
    serial = who.get("serialNumber", who.get("sn", ""))
    return Ximu3Setup(str(name), str(serial), BASE_HZ / divisor)


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

    It is given samples at 400 Hz; its divisor is kept by leaving out, though the device averages.
    The magnetometer keeps to 20 Hz.
    """

    def __init__(self, axes: Axes = Z_UP, binary: bool = True, name: str = "emulated") -> None:
        self.settings: dict[str, object] = {"deviceName": name, "serialNumber": "0123-4567"}
        self.settings |= {"binaryModeEnabled": binary, "inertialMessageRateDivisor": 8}
        self.settings |= {"ahrsMessageRateDivisor": 8}
        self._encoders = {True: Ximu3Encoder(axes, True), False: Ximu3Encoder(axes, False)}
        self._count = 0
        self._field_due_ns = 0
        self._pending = b""

    def receive(self, data: bytes) -> bytes:
        """The answers to its commands; what is no command is passed over."""
        *lines, self._pending = (self._pending + data).split(b"\n")
        self._pending = self._pending[-_LONGEST:]
        return b"".join(self._reply(line) for line in lines)

    def measure(self, sample: Sample) -> bytes:
        """Take a new measurement; the messages that are due."""
        self._count += 1
        encoder = self._encoders[bool(self.settings["binaryModeEnabled"])]
        sent = b""
        if sample.field_b is not None and sample.device_ns >= self._field_due_ns:
            self._field_due_ns = sample.device_ns + _FIELD_NS
            sent += encoder.field(sample)
        if sample.device_q_nb is not None and self._due("ahrsMessageRateDivisor"):
            sent += encoder.orientation(sample)
        return sent + (encoder.inertial(sample) if self._due("inertialMessageRateDivisor") else b"")

    def _due(self, key: str) -> bool:
        divisor = self.settings[key]
        return isinstance(divisor, int) and divisor > 0 and self._count % divisor == 0

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
