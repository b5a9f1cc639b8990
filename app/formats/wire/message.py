"""Heart: Stridescope's own message: numbered samples of one sensor, as JSON or binary (docs/message.md).

A message holds or does not: one that is damaged anywhere is refused whole, with the reason in words.
"""

from __future__ import annotations

import json
import math
import re
import struct
from collections.abc import Sequence
from typing import Any, NamedTuple

from app.formats.wire.warmth import COLDEST_C, HOTTEST_C, believed
from app.motion.basics import Quaternion, Vector
from app.motion.samples import Sample

VERSION = 1
MAGIC = b"STRD"
MOST_BYTES = 65_536
MOST_SAMPLES = 512
#: Numbers stay below this: JavaScript and JSON are exact up to here.
MOST_SEQ = 1 << 53
MOST_NS = 1 << 63
#: A session, as JSON writes it.
HEX = re.compile(r"[0-9a-fA-F]{1,16}")
#: A sensor's name: ``left``, ``right``, ``foot`` or any other.
NAME = re.compile(r"[A-Za-z0-9_.-]{1,16}")

FIELD, ORIENTATION, SATURATION, DOUBLES, TEMPERATURE = 1, 2, 4, 8, 16  # flags of a binary message
CHANNELS = 9

_HEAD = struct.Struct("<4sBBHQQ16s")
_TAIL = struct.Struct("<f")  # the temperature
_NAN3, _NAN4 = (math.nan,) * 3, (math.nan,) * 4


class Message(NamedTuple):
    """Samples of one sensor with consecutive numbers; ``session`` is one run of its sender."""

    session: int  # 64 bits, chosen at random by the sender when it starts
    samples: list[Sample]
    temperature_c: float | None = None  # the sensor's, where it tells it


class Malformed(NamedTuple):
    """No message, and why."""

    why: str


def decode(data: bytes | str, host_ns: int) -> Message | Malformed:
    """A message in either form, arrived at ``host_ns``."""
    if len(data) > MOST_BYTES:
        return Malformed(f"{len(data)} bytes, expected at most {MOST_BYTES}")
    if isinstance(data, bytes) and data.startswith(MAGIC):
        return _decode_binary(data, host_ns)
    return _decode_json(data, host_ns)


# --- binary ---------------------------------------------------------------------------------------


def row_of(flags: int) -> struct.Struct:
    """The layout of one sample in a binary message with these flags."""
    number = "d" if flags & DOUBLES else "f"
    count = 6 + 3 * bool(flags & FIELD) + 4 * bool(flags & ORIENTATION)
    return struct.Struct(f"<q{count}{number}{'H' if flags & SATURATION else ''}")


_ROWS = [row_of(flags) for flags in range(16)]


def _decode_binary(data: bytes, host_ns: int) -> Message | Malformed:
    if len(data) < _HEAD.size:
        return Malformed(f"{len(data)} bytes, expected a head of {_HEAD.size}")
    _, version, flags, count, session, first, padded = _HEAD.unpack_from(data)
    if version != VERSION:
        return Malformed(f"version {version}, expected {VERSION}")
    if flags >= 2 * TEMPERATURE:
        return Malformed(f"flags {flags}, expected 0 to {2 * TEMPERATURE - 1}")
    row, told = _ROWS[flags % TEMPERATURE], _TAIL.size * bool(flags & TEMPERATURE)
    frame = _HEAD.size + told
    if not 1 <= count <= MOST_SAMPLES or len(data) != frame + count * row.size:
        return Malformed(f"{len(data)} bytes for {count} samples, expected {frame} + {row.size} each")
    name = padded.rstrip(b"\0").decode("ascii", "replace")
    if NAME.fullmatch(name) is None:
        return Malformed("the sensor's name: expected letters, digits, _ . - and zeros behind them")
    samples = [
        _from_row(name, first + i, host_ns, flags, numbers)
        for i, numbers in enumerate(row.iter_unpack(data[_HEAD.size : len(data) - told]))
    ]
    return _checked(session, samples, _TAIL.unpack_from(data, len(data) - told)[0] if told else None)


def _from_row(name: str, seq: int, host_ns: int, flags: int, row: tuple[Any, ...]) -> Sample:
    field: Vector | None = None
    q: Quaternion | None = None
    at = 7
    if flags & FIELD:
        field = None if row[7] != row[7] else (row[7], row[8], row[9])  # NaN: this one has none
        at = 10
    if flags & ORIENTATION:
        q = _unit(row[at], row[at + 1], row[at + 2], row[at + 3])
    saturation = row[-1] if flags & SATURATION else 0
    force, rate = (row[1], row[2], row[3]), (row[4], row[5], row[6])
    return Sample(name, seq, row[0], host_ns, force, rate, field, saturation, q)


def encode_binary(
    session: int, samples: Sequence[Sample], doubles: bool = False, temperature_c: float | None = None
) -> bytes:
    """Samples of one sensor with consecutive numbers; ``doubles`` keeps every bit, else float32."""
    flags = (
        FIELD * any(s.field_b is not None for s in samples)
        | ORIENTATION * any(s.device_q_nb is not None for s in samples)
        | SATURATION * any(s.saturation for s in samples)
        | DOUBLES * doubles
    )
    row, first = _ROWS[flags], samples[0]
    told, tail = (0, b"") if temperature_c is None else (TEMPERATURE, _TAIL.pack(temperature_c))
    head = _HEAD.pack(
        MAGIC, VERSION, flags | told, len(samples), session, first.seq, first.sensor.encode("ascii")
    )
    return head + b"".join(row.pack(*_to_row(flags, sample)) for sample in samples) + tail


def _to_row(flags: int, sample: Sample) -> tuple[float, ...]:
    numbers: tuple[float, ...] = (sample.device_ns, *sample.specific_force_b, *sample.angular_rate_b)
    if flags & FIELD:
        numbers += sample.field_b or _NAN3
    if flags & ORIENTATION:
        numbers += sample.device_q_nb or _NAN4
    return (*numbers, sample.saturation) if flags & SATURATION else numbers


def fitting(size: int, doubles: bool = False) -> int:
    """How many samples surely fit into a binary message of ``size`` bytes."""
    widest = _ROWS[FIELD | ORIENTATION | SATURATION | DOUBLES * doubles]
    return max(min((size - _HEAD.size - _TAIL.size) // widest.size, MOST_SAMPLES), 1)


# --- JSON -----------------------------------------------------------------------------------------


def _decode_json(data: bytes | str, host_ns: int) -> Message | Malformed:
    try:
        told = json.loads(data)
    except (ValueError, RecursionError):
        return Malformed("neither JSON nor a binary message")
    if not isinstance(told, dict):
        return Malformed("JSON, but no object")
    return from_object(told, host_ns)


def from_object(told: dict[str, Any], host_ns: int) -> Message | Malformed:
    """The message that a JSON object is."""
    if told.get("v") != VERSION or isinstance(told["v"], bool):
        return Malformed(f"v: expected {VERSION}")
    session, name, first = told.get("session"), told.get("sensor"), told.get("seq")
    if not isinstance(session, str) or HEX.fullmatch(session) is None:
        return Malformed("session: expected 1 to 16 hexadecimal digits as a string")
    if not isinstance(name, str) or NAME.fullmatch(name) is None:
        return Malformed("sensor: expected 1 to 16 letters, digits, _ . -")
    if type(first) is not int:
        return Malformed("seq: expected a whole number")
    rows = told.get("samples")
    if not isinstance(rows, list) or not 1 <= len(rows) <= MOST_SAMPLES:
        return Malformed(f"samples: expected a list of 1 to {MOST_SAMPLES}")
    samples: list[Sample] = []
    for i, row in enumerate(rows):
        sample = _from_cells(name, first + i, host_ns, row)
        if isinstance(sample, Malformed):
            return Malformed(f"samples[{i}]: {sample.why}")
        samples.append(sample)
    degrees = told.get("temp_c")
    if degrees is not None and type(degrees) not in (int, float):
        return Malformed("temp_c: expected a number, or null")
    return _checked(int(session, 16), samples, degrees)


def _from_cells(name: str, seq: int, host_ns: int, row: object) -> Sample | Malformed:
    if not isinstance(row, dict):
        return Malformed("expected an object")
    stamp, saturation = row.get("t_ns"), row.get("sat", 0)
    if type(stamp) is not int:
        return Malformed("t_ns: expected whole nanoseconds")
    if type(saturation) is not int or not 0 <= saturation < 1 << CHANNELS:
        return Malformed(f"sat: expected 0 to {(1 << CHANNELS) - 1}")
    force, rate = _numbers(row.get("f"), 3), _numbers(row.get("w"), 3)
    if force is None or rate is None:
        return Malformed(f"{'w' if force else 'f'}: expected three numbers")
    field, q = _numbers(row.get("m"), 3), _numbers(row.get("q"), 4)
    if (field is None) != (row.get("m") is None) or (q is None) != (row.get("q") is None):
        return Malformed("m, q: expected three and four numbers, or null")
    return Sample(
        name,
        seq,
        stamp,
        host_ns,
        (force[0], force[1], force[2]),
        (rate[0], rate[1], rate[2]),
        None if field is None else (field[0], field[1], field[2]),
        saturation,
        None if q is None else _unit(q[0], q[1], q[2], q[3]),
    )


def _numbers(told: object, count: int) -> list[float] | None:
    if not isinstance(told, list) or len(told) != count:
        return None
    if any(type(number) not in (int, float) for number in told):
        return None
    try:
        return [float(number) for number in told]
    except OverflowError:  # a whole number of 400 digits
        return None


def encode_json(session: int, samples: Sequence[Sample], temperature_c: float | None = None) -> str:
    """The same message as JSON; it keeps every bit."""
    first = samples[0]
    rows = [_to_cells(sample) for sample in samples]
    told = {
        "v": VERSION,
        "session": f"{session:x}",
        "sensor": first.sensor,
        "seq": first.seq,
        "samples": rows,
    } | ({} if temperature_c is None else {"temp_c": temperature_c})
    return json.dumps(told, separators=(",", ":"))


def _to_cells(sample: Sample) -> dict[str, object]:
    row: dict[str, object] = {
        "t_ns": sample.device_ns,
        "f": sample.specific_force_b,
        "w": sample.angular_rate_b,
    }
    if sample.field_b is not None:
        row["m"] = sample.field_b
    if sample.device_q_nb is not None:
        row["q"] = sample.device_q_nb
    if sample.saturation:
        row["sat"] = sample.saturation
    return row


# --- both -----------------------------------------------------------------------------------------


def _checked(session: int, samples: list[Sample], told: float | None) -> Message | Malformed:
    if not 0 <= samples[0].seq <= MOST_SEQ - len(samples):
        return Malformed(f"seq {samples[0].seq}: expected 0 to 2^53")
    before = -1
    for sample in samples:
        if not before < sample.device_ns < MOST_NS:
            return Malformed(f"t_ns {sample.device_ns}: expected to increase, from 0 on")
        before = sample.device_ns
        if not math.isfinite(sum(sample.specific_force_b) + sum(sample.angular_rate_b)):
            return Malformed(f"sample {sample.seq}: force or rate is not finite")
        if sample.field_b is not None and not math.isfinite(sum(sample.field_b)):
            return Malformed(f"sample {sample.seq}: the field is not finite")
        if sample.saturation >= 1 << CHANNELS:
            return Malformed(f"sat {sample.saturation}: expected 0 to {(1 << CHANNELS) - 1}")
    degrees = None if told is None else believed(told)
    if degrees is None and told is not None:
        return Malformed(f"temperature: expected {COLDEST_C:g} to {HOTTEST_C:g} °C")
    return Message(session, samples, None if degrees is None else float(degrees))


def _unit(w: float, x: float, y: float, z: float) -> Quaternion | None:
    """A unit quaternion; None for what is none (NaN: the sample has none)."""
    square = w * w + x * x + y * y + z * z
    if not 0.9 < square < 1.1:
        return None
    if abs(square - 1.0) < 1e-9:
        return (w, x, y, z)
    norm = math.sqrt(square)
    return (w / norm, x / norm, y / norm, z / norm)
