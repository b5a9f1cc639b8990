"""Heart: what the "Sensor Logger" app pushes by HTTP: readings of a phone's sensors, each with own stamps.

A sample is made for each reading of the accelerometer, with the gyroscope's value at that moment between its
two readings around it. Messages may come out of order: a missing one is waited for, but not long. Axes: the
app's are the phone's, x to the right, y to the top edge, z out of the screen; iOS may negate all
forces, which the first still stand shows.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from statistics import median
from typing import NamedTuple

from app.formats.mounting import Axes, parse_axes
from app.formats.options import FEET
from app.formats.wire.making import scaled
from app.formats.wire.message import MOST_NS, Malformed, Message
from app.formats.wire.readings import Readings
from app.motion.basics import G_MPS2, InputError, Vector
from app.motion.samples import Sample

#: On top of the shoe, screen up, top edge to the toe.
ON_TOP: Axes = parse_axes("y,x,-z")
MOST_BYTES = 2_000_000
MOST_PHONES = 8
_WAIT_MESSAGES = 3  # for one that is missing
_STILL = 50  # readings by which sign and unit are told
_FIELD_OLD_NS = 200_000_000

_FORCES = ("totalacceleration", "accelerometer", "accelerometeruncalibrated")
_NAMES = {
    **{name: name for name in _FORCES},
    "gravity": "gravity",
    "gyroscope": "gyroscope",
    "gyroscopeuncalibrated": "gyroscopeuncalibrated",
    "magnetometer": "magnetometer",
    "magnetometeruncalibrated": "magnetometeruncalibrated",
}


class Push(NamedTuple):
    """One message of the app."""

    number: int
    session: str
    device: str
    readings: list[tuple[str, int, Vector]]  # sensor, time, value


def parse(data: bytes | str) -> Push | Malformed:
    """A pushed body; readings of sensors that do not concern a walk are left out."""
    if len(data) > MOST_BYTES:
        return Malformed(f"{len(data)} bytes, expected at most {MOST_BYTES}")
    try:
        told = json.loads(data)
    except (ValueError, RecursionError):
        return Malformed("no JSON")
    if not isinstance(told, dict) or not isinstance(told.get("payload"), list):
        return Malformed("expected what the Sensor Logger app pushes: an object with payload")
    number = told.get("messageId", 0)
    if type(number) is not int or not 0 <= number < 1 << 53:
        return Malformed("messageId: expected a whole number")
    readings = [reading for entry in told["payload"] if (reading := _reading(entry)) is not None]
    return Push(number, str(told.get("sessionId", ""))[:64], str(told.get("deviceId", ""))[:64], readings)


def _reading(entry: object) -> tuple[str, int, Vector] | None:
    if not isinstance(entry, dict) or not isinstance(entry.get("name"), str):
        return None
    name, stamp, values = _NAMES.get(entry["name"].lower()), entry.get("time"), entry.get("values")
    if name is None or type(stamp) is not int or not 0 <= stamp < MOST_NS or not isinstance(values, dict):
        return None
    v = [values.get(axis) for axis in "xyz"]
    if any(type(number) not in (int, float) for number in v):
        return None
    try:
        x, y, z = (float(number) for number in v if number is not None)
    except (OverflowError, ValueError):
        return None
    return (name, stamp, (x, y, z)) if math.isfinite(x + y + z) else None


class Phone:
    """One phone's sensors joined into samples named ``sensor``, in the shoe's axes."""

    def __init__(self, sensor: str, axes: Axes = ON_TOP) -> None:
        self.notes: list[str] = []
        self.dropped = 0
        self.missing = 0  # messages
        self._sensor, self._axes = sensor, axes
        self._session = ""
        self._begin()

    def _begin(self) -> None:
        self._pending: dict[int, Push] = {}
        self._next: int | None = None
        self._readings = {name: Readings() for name in _NAMES.values()}
        self._seen: set[str] = set()
        self._seq, self._stamp = 0, -1
        self._scale = 0.0  # of the force: unit and sign, 0 until told
        self._held: list[tuple[int, Vector, Vector]] = []

    def wear(self, sensor: str, axes: Axes) -> None:
        """Which foot and how it sits, by now; after a change unit and sign are told anew."""
        if (sensor, axes) != (self._sensor, self._axes):
            self._sensor, self._axes = sensor, axes
            self._scale, self._held, self.notes = 0.0, [], []

    def push(self, push: Push, host_ns: int) -> Message | None:
        """The new samples, if the message completes some."""
        if push.session != self._session:
            self._session = push.session
            self._begin()
        self._order(push)
        samples = [
            s for stamp, force, rate in self._joined() if (s := self._sample(stamp, force, rate, host_ns))
        ]
        return Message(_number(push), samples) if samples else None

    def _order(self, push: Push) -> None:
        """Take messages by their number; go on without one that does not come."""
        if self._next is None:
            self._next = push.number
        if push.number < self._next:
            self._take(push)  # late or again: readings are sorted, and taken once by their time
            return
        self._pending[push.number] = push
        while self._pending:
            if self._next not in self._pending:
                if len(self._pending) <= _WAIT_MESSAGES:
                    return
                first = min(self._pending)
                self.missing += first - self._next
                self._next = first
            self._take(self._pending.pop(self._next))
            self._next += 1

    def _take(self, push: Push) -> None:
        for name, stamp, v in push.readings:
            self._seen.add(name)
            self._readings[name].add(stamp, v)

    def _joined(self) -> list[tuple[int, Vector, Vector]]:
        """Force and rate at each moment of the accelerometer for which all is known."""
        force_name = next((name for name in _FORCES if name in self._seen), None)
        gyro = self._readings["gyroscope" if "gyroscope" in self._seen else "gyroscopeuncalibrated"]
        gravity = self._readings["gravity"] if force_name == "accelerometer" else None
        if force_name is None:
            return []
        until = min(gyro.last, gyro.last if gravity is None else gravity.last)
        joined = []
        for stamp, v in self._readings[force_name].pop(until):
            rate, g = gyro.at(stamp), (0.0, 0.0, 0.0) if gravity is None else gravity.at(stamp)
            if rate is None or g is None or stamp <= self._stamp:
                self.dropped += 1
                continue
            self._stamp = stamp
            joined.append((stamp, (v[0] + g[0], v[1] + g[1], v[2] + g[2]), rate))
        for readings in (gyro, gravity) if gravity else (gyro,):
            readings.forget(self._stamp)
        return self._told(joined)

    def _told(self, joined: list[tuple[int, Vector, Vector]]) -> list[tuple[int, Vector, Vector]]:
        """Held back until the first still stand tells unit and sign."""
        if self._scale:
            return joined
        self._held += joined
        if len(self._held) < _STILL:
            return []
        size = median(math.hypot(*force) for _, force, _ in self._held)
        up = median(-self._turn(force)[2] for _, force, _ in self._held) / (size or 1.0)
        unit = G_MPS2 if size < 0.3 * G_MPS2 else 1.0
        self._scale = -unit if up < -0.5 else unit
        if unit != 1.0:
            self._note("accelerometer in g: told by its size")
        if self._scale < 0.0:
            self._note("forces negated, as iOS sends them without 'Standardise Units & Frames'")
        if abs(up) < 0.5:
            self._note("the phone does not sit as was said: no axis is upright as expected; say axes=")
        held, self._held = self._held, []
        return held

    def _sample(self, stamp: int, force: Vector, rate: Vector, host_ns: int) -> Sample | None:
        field = next(
            (
                v
                for name in ("magnetometer", "magnetometeruncalibrated")
                if (v := self._readings[name].before(stamp, _FIELD_OLD_NS)) is not None
            ),
            None,
        )
        seq = self._seq
        self._seq += 1
        return Sample(
            self._sensor,
            seq,
            stamp,
            host_ns,
            scaled(self._turn(force), self._scale),
            self._turn(rate),
            None if field is None else self._turn(field),
        )

    def _turn(self, v: Vector) -> Vector:
        (i, a), (j, b), (k, c) = self._axes
        return (a * v[i], b * v[j], c * v[k])

    def _note(self, sentence: str) -> None:
        if f"{self._sensor}: {sentence}" not in self.notes:
            self.notes.append(f"{self._sensor}: {sentence}")


def _number(push: Push) -> int:
    """The app's session as one of ours."""
    digest = hashlib.sha256(f"{push.device}\0{push.session}".encode("utf-8", "surrogatepass")).digest()
    return int.from_bytes(digest[:8])


def sensor_and_axes(query: Mapping[str, str], foot: str | None, axes: Axes | None) -> tuple[str, Axes]:
    """What a push address says of its phone: ``/push?foot=left&axes=y,x,-z``; else ``InputError``."""
    sensor = query.get("foot", foot or "foot")
    if sensor not in FEET:
        raise InputError(f"foot={sensor!r}: expected one of {', '.join(FEET)}")
    return sensor, parse_axes(query["axes"]) if "axes" in query else axes or ON_TOP
