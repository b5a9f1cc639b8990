"""Heart: a file's bytes into a recording, whatever its format: found by content, cleaned, checked, turned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.formats import gaitmap, kept, mcap, microstrain, mounting, plain, pyshoe, xio
from app.formats.clean import clean
from app.formats.mounting import Axes
from app.formats.options import Options
from app.formats.raw import Parsed, RawFoot, even_stamps
from app.formats.rest import Rest, check_units, find_rest
from app.formats.saturation import RANGES, Range, saturation
from app.formats.swing import face_forward
from app.formats.table import read_head, to_text
from app.motion.basics import InputError
from app.motion.recording import Recording
from app.motion.samples import Samples

EXPECTED = (
    "expected plain CSV, x-io, MicroStrain or gaitmap CSV, a PyShoe MATLAB file or a recording of Stridescope"
)

#: So many set-backs of a clock are told one by one.
MOST_SAID = 3

_NO_READINGS = ("", "t", "time", "timestamp", "index", "sample", "packet", "foot", "sensor")
_FOREIGN = {
    b"PK\x03\x04": "an Excel workbook or zip archive",
    b"\x89HDF": "an HDF5 file",
    b"\x1f\x8b": "a gzip archive",
    b"%PDF": "a PDF",
}


def read(name: str, data: bytes, options: Options | None = None) -> Recording:
    """The recording in ``data``. ``name`` is for messages only.

    Raises ``InputError``, one line, when it is none, or when its units contradict the foot at rest.
    """
    told = options or Options()
    if mcap.recognises(data):
        return _ours(kept.read(name, data), told)
    parsed = _pick(name, _timed(_parse(name, data, told.rate_hz), told.rate_hz), told.foot)
    cleaned, set_back = [], []
    for foot in parsed.feet:
        rows, said = _clean(name, foot)
        cleaned.append(rows)
        set_back += said
    full_scale = RANGES[told.device or parsed.device or "csv"]
    sensors, sentences = [], [*parsed.assumed, *set_back]
    for samples in cleaned:
        rest = find_rest(samples)
        check_units(name, samples, rest, parsed.force_unit)
        axes, how = _mounted(samples, rest, parsed, told)
        sensors.append(_turned(samples, axes, full_scale))
        sentences += [how, *_doubts(samples, rest, axes)]
    return Recording(
        name=name,
        format=parsed.format,
        sensors=tuple(_with_unread(sensors, parsed)),
        assumed=tuple(dict.fromkeys(sentence for sentence in sentences if sentence)),
        spec=parsed.spec,
        dropped_rows=_dropped_rows(sensors, parsed),
    )


def _ours(recording: Recording, told: Options) -> Recording:
    """A recording of ours says all of itself; only one foot of it can be asked for."""
    for key, value in (("rate", told.rate_hz), ("axes", told.axes), ("device", told.device)):
        if value is not None:
            raise InputError(f"{recording.name}: {key}= is given, but a recording of ours says it itself")
    if told.foot is None:
        return recording
    chosen = tuple(samples for samples in recording.sensors if samples.sensor == told.foot)
    if not chosen:
        holds = " and ".join(samples.sensor for samples in recording.sensors)
        raise InputError(f"{recording.name}: foot={told.foot}, but it holds {holds}")
    return replace(recording, sensors=chosen, journal=None)


def _parse(name: str, data: bytes, rate_hz: float | None) -> Parsed:
    """The parser's view of the file that the first bytes or the header call for."""
    if not data or data.isspace():
        raise InputError(f"{name}: an empty file, {EXPECTED}")
    for magic, what in _FOREIGN.items():
        if data.startswith(magic):
            raise InputError(f"{name}: {what}, {EXPECTED}")
    if pyshoe.recognises(data):
        return pyshoe.parse(name, data)
    text = to_text(name, data)
    head = read_head(text)
    if plain.recognises(head):
        return plain.parse(name, text, head)
    if xio.recognises(head):
        return xio.parse(name, text, head, rate_hz)
    if gaitmap.header_row(head) is not None:
        return gaitmap.parse(name, text, head, rate_hz)
    if microstrain.header_row(head) is not None:
        return microstrain.parse(name, text, head, rate_hz)
    raise InputError(f"{name}: {_unknown(head.rows)}")


def _unknown(rows: Sequence[tuple[str, ...]]) -> str:
    first = ",".join(rows[0])[:50] if rows else ""
    if len(rows) < 2 or len(rows[0]) < 4 or not _is_data(rows[1], len(rows[0])):
        return f"begins with {first!r}, {EXPECTED}"
    if all(_is_number(cell) for cell in rows[0]):
        return f"begins with numbers ({first}), expected a header with units such as {plain.HEADER}"
    column = next((cell for cell in rows[0] if cell.lower() not in _NO_READINGS), rows[0][1])
    return f"column {column!r} has no unit, expected a header with units such as {plain.HEADER}"


def _is_data(cells: tuple[str, ...], width: int) -> bool:
    return len(cells) == width and all(_is_number(cell) for cell in cells[1:] if cell)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _timed(parsed: Parsed, rate_hz: float | None) -> Parsed:
    """With a rate told, rows of a file with times are spread evenly instead."""
    if rate_hz is None:
        return parsed
    why = "not the file's own times" if parsed.timed else "the file has no times"
    assumed = (*parsed.assumed, f"{rate_hz:g} Hz as told, {why}")
    feet = tuple(_spread(foot, rate_hz) for foot in parsed.feet) if parsed.timed else parsed.feet
    return replace(parsed, feet=feet, assumed=assumed)


def _spread(foot: RawFoot, rate_hz: float) -> RawFoot:
    return replace(foot, stamps_ns=even_stamps(np.arange(len(foot.stamps_ns)), rate_hz))


def _pick(name: str, parsed: Parsed, foot: str | None) -> Parsed:
    """The foot asked for, out of two, or the name of a single nameless one."""
    if foot is None:
        return parsed
    by_name = {raw.sensor: raw for raw in parsed.feet}
    chosen = by_name.get(foot)
    if chosen is None and list(by_name) == ["foot"]:
        chosen = replace(by_name["foot"], sensor=foot)
    if chosen is None:
        raise InputError(f"{name}: foot={foot}, but it holds {' and '.join(by_name)}")
    return replace(parsed, feet=(chosen,))


def _clean(name: str, foot: RawFoot) -> tuple[Samples, list[str]]:
    """Its rows that count, and in words where its clock was set back."""
    try:
        samples, set_back = clean(foot)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    said = [
        f"{foot.sensor}: its clock was set back {back.by_s:.2f} s at {back.at_s:.2f} s: a new segment there"
        for back in set_back[:MOST_SAID]
    ]
    more = len(set_back) - len(said)
    return samples, [*said, f"{foot.sensor}: its clock was set back {more} more times"] if more else said


def _turned(samples: Samples, axes: Axes, full_scale: Range) -> Samples:
    """The samples in the shoe's axes, with those that touch the sensor's range flagged."""
    matrix = samples.matrix.copy()
    for first in (1, 4, 7):
        matrix[:, first : first + 3] = mounting.turn(matrix[:, first : first + 3], axes)
    return replace(samples, matrix=matrix, saturation=saturation(matrix, full_scale))


def _with_unread(sensors: list[Samples], parsed: Parsed) -> list[Samples]:
    """Rows that no foot got are counted with the first."""
    first = replace(sensors[0], dropped={**sensors[0].dropped, **parsed.unread})
    return [first, *sensors[1:]]


def _dropped_rows(sensors: list[Samples], parsed: Parsed) -> int:
    per_foot = [sum(samples.dropped.values()) for samples in sensors]
    return sum(parsed.unread.values()) + (max(per_foot) if parsed.wide else sum(per_foot))


def _mounted(samples: Samples, rest: Rest, parsed: Parsed, told: Options) -> tuple[Axes, str]:
    """How the sensor sits, and in words where that is from; no words where the format says it."""
    if told.axes:
        return told.axes, f"{mounting.describe(told.axes)}, as told"
    if parsed.mounted:
        return mounting.AS_GIVEN, ""
    axes = mounting.snap(rest.force)
    forward = face_forward(samples, axes) if rest.still else None
    why = "the swing of the foot" if forward else "sensor x taken as forward"
    whose = f"{samples.sensor}: " if len(parsed.feet) > 1 else ""
    chosen = forward or axes
    return chosen, f"{whose}{mounting.describe(chosen)}, assumed from gravity at rest and {why}"


def _doubts(samples: Samples, rest: Rest, axes: Axes) -> list[str]:
    """What the foot at rest does not bear out, in words."""
    doubts = []
    force = mounting.turn(rest.force[None], axes)[0]
    if mounting.snap(force)[2] != mounting.AS_GIVEN[2]:
        reading = ", ".join(f"{value:.1f}" for value in force)
        doubts.append(f"{samples.sensor} rests at ({reading}) m/s²: z is not down, expected (0, 0, −9.8)")
    if not rest.still:
        doubts.append(f"{samples.sensor} never rests: units and mounting could not be checked")
    return doubts
