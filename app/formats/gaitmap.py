"""Heart: gaitmap's CSV: one or two header rows, one or two feet in a row, m/s² and deg/s.

The first column is a row number (204.8 Hz assumed) or a time in seconds; an ``index`` column
counts samples and goes before it.
"""

from __future__ import annotations

import math

import numpy as np

from app.formats.raw import Parsed, RawFoot, even_stamps
from app.formats.table import Converter, Head, floats, nanoseconds, read_columns
from app.motion.basics import Floats, InputError, Ints

RATE_HZ = 204.8

_FORCE = ("acc_x", "acc_y", "acc_z")
_RATE = ("gyr_x", "gyr_y", "gyr_z")


def header_row(head: Head) -> int | None:
    """0 where the axes stand in the first row, 1 where a row of sensor names is above, else None."""
    for row, cells in enumerate(head.rows[:2]):
        if set(cells) & set(_FORCE) and set(cells) & set(_RATE):
            return row
    return None


def parse(name: str, data: bytes, head: Head, rate_hz: float | None) -> Parsed:
    """One or two feet; ``InputError`` if an axis is missing or a sensor is neither foot."""
    row = header_row(head) or 0
    header = head.rows[row]
    places = _places(name, header, head.rows[0] if row else None)
    clock = header.index("index") if "index" in header else 0
    if header[clock] in (*_FORCE, *_RATE):
        raise InputError(f"{name}: the first column is {header[clock]!r}, expected a row number or a time")
    converters: dict[int, Converter] = dict.fromkeys(
        (column for columns in places.values() for column in columns), floats
    )
    columns, unread = read_columns(name, data, head, row, {**converters, clock: floats})
    counted = bool(_counts(columns[clock]))
    if counted:
        stamps_ns = even_stamps(columns[clock] - _first(columns[clock]), rate_hz or RATE_HZ)
    else:
        stamps_ns = _times(name, data, head, row, clock)
    feet = tuple(_foot(foot, stamps_ns, columns, place) for foot, place in places.items())
    assumed = ["units of a gaitmap file: m/s² and deg/s"]
    if counted and not rate_hz:
        assumed.insert(0, f"{RATE_HZ:g} Hz assumed: the file has row numbers, no times")
    return Parsed("gaitmap CSV", feet, unread, tuple(assumed), timed=not counted, wide=True)


def _places(name: str, header: tuple[str, ...], sensors: tuple[str, ...] | None) -> dict[str, list[int]]:
    """Foot → its six columns, force then rate."""
    found: dict[str, dict[str, int]] = {}
    for column, axis in enumerate(header):
        if axis in (*_FORCE, *_RATE):
            foot = _foot_of(sensors[column] if sensors and column < len(sensors) else "")
            if axis in found.setdefault(foot, {}):
                raise InputError(f"{name}: two columns {axis!r} of {foot}, expected one for each foot")
            found[foot][axis] = column
    for foot, axes in found.items():
        for axis in (*_FORCE, *_RATE):
            if axis not in axes:
                raise InputError(f"{name}: {foot} has no column {axis!r}, expected acc_x … gyr_z")
    return {foot: [found[foot][axis] for axis in (*_FORCE, *_RATE)] for foot in sorted(found)}


def _foot_of(sensor: str) -> str:
    return next((foot for foot in ("left", "right") if foot in sensor.lower()), "foot")


def _counts(clock: Floats) -> bool:
    """Whether the column counts samples: whole numbers, a step of one as a rule."""
    known = clock[np.isfinite(clock)]
    return bool(np.all(known == np.rint(known)) and (len(known) < 2 or np.median(np.diff(known)) >= 1.0))


def _first(clock: Floats) -> float:
    known = clock[np.isfinite(clock)]
    return float(known[0]) if len(known) else 0.0


def _times(name: str, data: bytes, head: Head, row: int, clock: int) -> Ints:
    columns, _ = read_columns(name, data, head, row, {clock: nanoseconds(9)})
    return np.asarray(columns[clock], np.int64)


def _foot(foot: str, stamps_ns: Ints, columns: dict[int, Floats], place: list[int]) -> RawFoot:
    force = np.column_stack([columns[column] for column in place[:3]])
    rate = np.column_stack([columns[column] for column in place[3:]])
    return RawFoot(foot, stamps_ns, force, rate * (math.pi / 180))
