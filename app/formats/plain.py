"""Heart: the project's plain CSV, both ways: body axes, SI, gauss, both feet mixed in time order.

What ``encode`` writes, ``parse`` reads back to the bit: stamps in whole nanoseconds, forces and
rates as the shortest decimals that name the same double. Only saturation is not written.
"""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal

import numpy as np

from app.formats.raw import Parsed, RawFoot
from app.formats.table import Converter, Head, floats, nanoseconds, read_columns, shifted_floats, words
from app.motion.basics import InputError
from app.motion.recording import Recording
from app.motion.samples import Samples

HEADER = "t_s,foot,fx_mps2,fy_mps2,fz_mps2,wx_radps,wy_radps,wz_radps,mx_gauss,my_gauss,mz_gauss"
FORMAT = "plain CSV"

_NAMES = HEADER.split(",")
_FEET = ("left", "right", "foot")
_SPEC = "spec:"
_UNKNOWN_FOOT = "neither left, right nor foot"


def recognises(head: Head) -> bool:
    """Whether the header has columns that only the plain CSV has."""
    return bool(head.rows) and len(set(_NAMES) & set(head.rows[0])) >= 2


def parse(name: str, data: bytes, head: Head) -> Parsed:
    """The feet of a plain CSV; ``InputError`` if a column is missing."""
    header = head.rows[0]
    for column in _NAMES[:8]:
        if column not in header:
            raise InputError(f"{name}: the header has no column {column!r}, expected {HEADER}")
    wanted = [column for column in _NAMES if column in header]
    converters = {header.index(column): _converter(column) for column in wanted}
    columns, unread = read_columns(name, data, head, 0, converters)
    table = {column: columns[header.index(column)] for column in wanted}
    unknown = int((~np.isin(table["foot"], _FEET)).sum())
    if unknown:
        unread[_UNKNOWN_FOOT] = unknown
    feet = tuple(_foot(foot, table) for foot in _FEET if (table["foot"] == foot).any())
    if not feet:
        first = str(table["foot"][0])
        raise InputError(f"{name}: column 'foot' reads {first!r}, expected left, right or foot")
    return Parsed(FORMAT, feet, unread, spec=_spec(head), mounted=True)


def _converter(column: str) -> Converter:
    if column == "t_s":
        return nanoseconds(9)
    if column == "foot":
        return words
    return shifted_floats(2) if column.endswith("_gauss") else floats


def _foot(foot: str, table: dict[str, np.ndarray]) -> RawFoot:
    rows = table["foot"] == foot
    force, rate, field = (_NAMES[2:5], _NAMES[5:8], _NAMES[8:11])
    return RawFoot(
        foot,
        table["t_s"][rows],
        np.column_stack([table[column][rows] for column in force]),
        np.column_stack([table[column][rows] for column in rate]),
        np.column_stack([table[column][rows] for column in field]) if set(field) <= set(table) else None,
    )


def _spec(head: Head) -> str | None:
    specs = (comment.removeprefix(_SPEC).strip() for comment in head.comments if comment.startswith(_SPEC))
    return next(specs, None)


def encode(recording: Recording) -> bytes:
    """The recording as plain CSV, rows in time order; the SPEC that made it in the first comment.

    A sensor goes by its foot, or by its own name where two of them stand for the same foot.
    """
    lines = [f"# {_SPEC} {' '.join(recording.spec.split())}"] if recording.spec else []
    begin_ns = min(recording.sensors, key=recording.offset_ns).device_ns if recording.sensors else 0
    roles = [s.role for s in recording.sensors]
    feet = [s.sensor if roles.count(s.role) > 1 else s.role for s in recording.sensors]
    rows = [
        row
        for foot, s in zip(feet, recording.sensors, strict=True)
        for row in _rows(foot, s, begin_ns + recording.offset_ns(s))
    ]
    rows.sort(key=lambda row: row[0])
    return "\n".join([*lines, HEADER, *(line for _, line in rows), ""]).encode()


def _rows(foot: str, samples: Samples, begin_ns: int) -> Iterator[tuple[int, str]]:
    """Stamp and line of every sample; the first came at ``begin_ns``."""
    elapsed = samples.matrix[:, 0].astype(np.int64).tolist()
    readings = samples.matrix[:, 1:7].tolist()
    fields = samples.matrix[:, 7:10].tolist()
    for elapsed_ns, reading, field in zip(elapsed, readings, fields, strict=True):
        stamp_ns = begin_ns + elapsed_ns
        cells = [_seconds(stamp_ns), foot, *map(repr, reading), *map(_gauss, field)]
        yield stamp_ns, ",".join(cells)


def _seconds(stamp_ns: int) -> str:
    sign = "-" if stamp_ns < 0 else ""
    whole, rest = divmod(abs(stamp_ns), 1_000_000_000)
    return f"{sign}{whole}.{rest:09d}"


def _gauss(field_ut: float) -> str:
    """µT in gauss, moved by two decimal places and not divided: a quotient would not come back."""
    return f"{Decimal(repr(field_ut)).scaleb(-2):f}" if field_ut == field_ut else ""
