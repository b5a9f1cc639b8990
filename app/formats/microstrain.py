"""Heart: MicroStrain SensorConnect's CSV export: ``inertial-6253.76535:scaledAccelX`` and so on.

scaledAccel is in g, scaledGyro in rad/s, scaledMag in gauss by the maker's definition; a unit in
the header goes first, and exports exist whose force is in m/s² without saying so: at rest 9.8
cannot be g. A ``:valid`` column after a value says whether to believe it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from app.formats.clock import stamps
from app.formats.raw import Parsed, RawFoot
from app.formats.table import Converter, Head, floats, read_columns, words
from app.formats.units import FIELD, FORCE, RATE, factor, split_unit
from app.motion.basics import Floats, InputError

_FORCE, _RATE, _FIELD = "scaledaccel", "scaledgyro", "scaledmag"
_QUANTITIES = {_FORCE: (FORCE, "g"), _RATE: (RATE, "rad/s"), _FIELD: (FIELD, "gauss")}
_MUCH_G = 5.0  # a median force above this many "g" is m/s²

Places = dict[tuple[str, str], tuple[int, float, str]]  # quantity, axis → column, factor, unit


def header_row(head: Head) -> int | None:
    """The row of the head that is the header (an export may put notes above it), or None."""
    for row, cells in enumerate(head.rows):
        if any(_FORCE in cell.lower() for cell in cells):
            return row
    return None


def parse(name: str, data: bytes, head: Head, rate_hz: float | None) -> Parsed:
    """The one foot of a SensorConnect export; ``InputError`` if a column is missing."""
    row = header_row(head) or 0
    header = head.rows[row]
    places, valid = _find(name, header)
    has_field = (_FIELD, "x") in places
    for quantity in (_FORCE, _RATE, *([_FIELD] if has_field else [])):
        _demand(name, quantity, places)
    clock = _time_column(name, header)
    converters: dict[int, Converter] = {column: floats for column, _, _ in places.values()}
    converters |= dict.fromkeys(valid.values(), floats)
    columns, unread = read_columns(name, data, head, row, {**converters, clock: words})
    stamps_ns, timing = stamps(name, columns[clock], rate_hz)
    force, force_unit, units = _force(places, columns, valid)
    foot = RawFoot(
        "foot",
        stamps_ns,
        force,
        _vectors(_RATE, places, columns, valid),
        _vectors(_FIELD, places, columns, valid) if has_field else None,
    )
    return Parsed("MicroStrain CSV", (foot,), unread, (*timing, *units), force_unit=force_unit)


def _find(name: str, header: tuple[str, ...]) -> tuple[Places, dict[int, int]]:
    """Where each quantity stands, and for a column its ``:valid`` column."""
    places: Places = {}
    valid: dict[int, int] = {}
    devices: set[str] = set()
    for column, cell in enumerate(header):
        device, _, channel = cell.rpartition(":")
        if channel.lower() == "valid":
            valid[column - 1] = column
            continue
        label, unit = split_unit(channel)
        quantity, axis = label[:-1].lower(), label[-1:].lower()
        if quantity in _QUANTITIES and axis in ("x", "y", "z"):
            table, usual = _QUANTITIES[quantity]
            places[quantity, axis] = (column, factor(name, cell, unit or usual, table), unit or "")
            devices.add(device)
    if len(devices) > 1:
        listed = " and ".join(sorted(devices))
        raise InputError(f"{name}: samples of {listed}, expected one device: export each to its own file")
    return places, valid


def _demand(name: str, quantity: str, places: Places) -> None:
    for axis in "xyz":
        if (quantity, axis) not in places:
            raise InputError(f"{name}: the header has no {quantity} {axis.upper()}, expected x, y and z")


def _time_column(name: str, header: tuple[str, ...]) -> int:
    for column, cell in enumerate(header):
        if split_unit(cell)[0].lower() in ("time", "timestamp"):
            return column
    raise InputError(f"{name}: the header has no column 'Time', expected one")


def _axes(quantity: str, places: Places) -> Iterator[tuple[int, float]]:
    for axis in "xyz":
        column, scale, _ = places[quantity, axis]
        yield column, scale


def _vectors(quantity: str, places: Places, columns: dict[int, Floats], valid: dict[int, int]) -> Floats:
    """[n, 3] in SI; NaN where the export says that a value is not valid."""
    vectors = np.column_stack([columns[column] * scale for column, scale in _axes(quantity, places)])
    for axis, (column, _) in enumerate(_axes(quantity, places)):
        if column in valid:
            vectors[columns[valid[column]] == 0.0, axis] = np.nan
    return vectors


def _force(
    places: Places, columns: dict[int, Floats], valid: dict[int, int]
) -> tuple[Floats, str, tuple[str, ...]]:
    """Force [n, 3], its unit, and what was assumed about it."""
    force = _vectors(_FORCE, places, columns, valid)
    unit = places[_FORCE, "x"][2].lower()
    if unit:
        return force, unit, ()
    usual = "units of SensorConnect: {}, rad/s and gauss"
    lengths = np.linalg.norm(force, axis=1) / FORCE["g"]
    lengths = lengths[np.isfinite(lengths)]
    if len(lengths) and np.median(lengths) > _MUCH_G:
        return force / FORCE["g"], "m/s²", (usual.format("m/s² (9.8 at rest cannot be g)"),)
    return force, "g", (usual.format("g"),)
