"""Heart: x-io's CSV exports: x-IMU3 and NGIMU with times, the first x-IMU with packet numbers only.

The header names each column's unit: ``Gyroscope X (deg/s)``, ``Accelerometer X (g)``.
"""

from __future__ import annotations

import re

import numpy as np

from app.formats.raw import Parsed, RawFoot, even_stamps
from app.formats.table import Converter, Head, floats, nanoseconds, read_columns
from app.formats.units import FIELD, FORCE, RATE, RELATIVE, TIME_DIGITS, factor, split_unit
from app.motion.basics import Floats, InputError, Ints

XIMU_RATE_HZ = 256.0

_QUANTITY = re.compile(r"^(gyroscope|accelerometer|magnetometer) ([xyz])$", re.IGNORECASE)
_TIMES = ("time", "timestamp")
_PACKET = "packet number"

Found = dict[str, dict[str, tuple[int, str, str | None]]]  # quantity → axis → column, cell, unit


def recognises(head: Head) -> bool:
    """Whether the header names a gyroscope or accelerometer the way x-io does."""
    names = [split_unit(cell)[0].lower() for cell in head.rows[0]] if head.rows else []
    return "gyroscope x" in names or "accelerometer x" in names


def parse(name: str, data: bytes, head: Head, rate_hz: float | None) -> Parsed:
    """The one foot of an x-io export; ``InputError`` if a column or its unit is missing."""
    found = _find(head.rows[0])
    force, force_unit = _triple(name, found, "accelerometer", FORCE)
    rate, _ = _triple(name, found, "gyroscope", RATE)
    has_field = "magnetometer" in found
    field, field_unit = _triple(name, found, "magnetometer", FIELD) if has_field else ({}, "")
    clock, stamp_with, timed = _clock(name, head.rows[0])
    converters: dict[int, Converter] = dict.fromkeys([*force, *rate, *field], floats)
    columns, unread = read_columns(name, data, head, 0, {clock: stamp_with, **converters})
    foot = RawFoot(
        "foot",
        columns[clock] if timed else _packet_stamps(columns[clock], rate_hz or XIMU_RATE_HZ),
        _scaled(columns, force),
        _scaled(columns, rate),
        _scaled(columns, field) if has_field else None,
    )
    assumed = []
    if not timed and not rate_hz:
        assumed.append(f"{XIMU_RATE_HZ:g} Hz assumed: the file has packet numbers, no times")
    if field_unit in RELATIVE:
        assumed.append("the magnetic field has no unit: only its direction counts")
    return Parsed(
        "x-io CSV" if timed else "x-IMU CSV",
        (foot,),
        unread,
        tuple(assumed),
        timed=timed,
        force_unit=force_unit,
        device=None if timed else "ximu",
    )


def _find(header: tuple[str, ...]) -> Found:
    found: Found = {}
    for column, cell in enumerate(header):
        quantity, unit = split_unit(cell)
        match = _QUANTITY.match(quantity)
        if match:
            found.setdefault(match[1].lower(), {})[match[2].lower()] = (column, cell, unit)
    return found


def _triple(name: str, found: Found, quantity: str, units: dict[str, float]) -> tuple[dict[int, float], str]:
    """Column → factor for x, y, z, in that order, and the unit they are in."""
    columns: dict[int, float] = {}
    unit_of_x = ""
    for axis in "xyz":
        if axis not in found.get(quantity, {}):
            missing = f"{quantity.capitalize()} {axis.upper()}"
            raise InputError(f"{name}: the header has no column {missing!r}, expected it with its unit")
        column, cell, unit = found[quantity][axis]
        columns[column] = factor(name, cell, unit, units)
        unit_of_x = unit_of_x or (unit or "").lower()
    return columns, unit_of_x


def _clock(name: str, header: tuple[str, ...]) -> tuple[int, Converter, bool]:
    """The column that orders the rows, its converter, and whether it is a time."""
    for column, cell in enumerate(header):
        what, unit = split_unit(cell)
        if what.lower() in _TIMES:
            if unit is None or unit.lower() not in TIME_DIGITS:
                raise InputError(f"{name}: column {cell!r} has no unit of time, expected (s), (ms) or (us)")
            return column, nanoseconds(TIME_DIGITS[unit.lower()]), True
        if what.lower() == _PACKET:
            return column, floats, False
    raise InputError(f"{name}: the header has neither a time nor a packet number, expected Time (s)")


def _packet_stamps(packets: Floats, rate_hz: float) -> Ints:
    """Rows at an even rate: packets of other kinds share the numbers, so only a repeat tells anything."""
    new = np.ones(len(packets), np.int64)
    new[1:] = packets[1:] != packets[:-1]
    return even_stamps(np.cumsum(new) - 1, rate_hz)


def _scaled(columns: dict[int, Floats], factors: dict[int, float]) -> Floats:
    return np.column_stack([columns[column] * scale for column, scale in factors.items()])
