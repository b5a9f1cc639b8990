"""Heart: which column of a text line is what, by its name, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from app.formats.units import FIELD, FORCE, RATE, TIME_DIGITS, split_unit

#: Factors to SI by quantity and unit, in small letters.
UNITS: dict[str, dict[str, float]] = {
    kind: {unit.lower(): factor for unit, factor in table.items()}
    for kind, table in {"force": FORCE, "rate": RATE, "field": FIELD}.items()
}
_SAID_BY_NAME = {"millis": "ms", "micros": "us"}
_SUFFIX_UNITS = {"mps2", "g", "mg", "radps", "rads", "dps", "degps", "ut", "gauss", "s", "ms", "us", "ns"}
_SPELT = {"rads": "rad/s", "gauss": "gauss"}

_TIMES = {"t", "time", "ts", "timestamp", "millis", "micros", "rtctime"}
_STEMS = {
    "force": "a acc accel accelerometer acceleration f",
    "rate": "g gyr gyro gyroscope w r",
    "field": "m mag magnetometer h b",
}
_VECTORS = {
    stem + axis: (kind, i) for kind, s in _STEMS.items() for stem in s.split() for i, axis in enumerate("xyz")
}
_QUATERNION = {"w": 0, "qw": 0, "q0": 0, "real": 0, "quatw": 0, "qx": 1, "q1": 1, "i": 1, "quatx": 1}
_QUATERNION |= {"qy": 2, "q2": 2, "j": 2, "quaty": 2, "qz": 3, "q3": 3, "k": 3, "quatz": 3}
_ARTEMIS = {"rtcdate", "imudegc", "outputhz"}
_TEMPERATURE = re.compile(r"(imu)?temp(erature)?(deg)?c?|imudegc")
_CELSIUS = {None, "c", "°c", "degc", "celsius"}


@dataclass(frozen=True)
class Columns:
    """Places of a line's cells; ``units`` holds those that the header tells."""

    count: int
    time: int | None
    force: tuple[int, int, int]
    rate: tuple[int, int, int]
    field: tuple[int, int, int] | None
    orientation: tuple[int, int, int, int] | None
    seq: int | None
    temperature: int | None  # in °C
    units: dict[str, str]


def find_columns(cells: Sequence[str]) -> Columns | None:
    """The columns that a header names; None unless it names three forces and three rates."""
    if cells and not cells[-1]:
        cells = cells[:-1]  # a trailing separator
    found: dict[tuple[str, int], int] = {}
    units: dict[str, str] = {}
    for place, cell in enumerate(cells):
        name, unit = _split(cell)
        known = _known(name, unit)
        if known is None or known in found:
            continue
        found[known] = place
        if unit is not None and known[0] != "temperature":
            units.setdefault(known[0], unit)
    if not all((kind, i) in found for kind in ("force", "rate") for i in range(3)):
        return None
    if _ARTEMIS & {_split(cell)[0] for cell in cells}:  # OpenLog Artemis never writes its units
        units = {"time": "s", "force": "mg", "rate": "dps", "field": "ut"} | units
    names = {_split(cell)[0] for cell in cells}
    if "micros" in names and "rtctime" in names:
        found["time", 0] = [_split(cell)[0] for cell in cells].index("micros")
        units["time"] = "us"
    orientation = tuple(found.get(("orientation", i), -1) for i in range(4))
    return Columns(
        len(cells),
        found.get(("time", 0)),
        (found["force", 0], found["force", 1], found["force", 2]),
        (found["rate", 0], found["rate", 1], found["rate", 2]),
        _three(found, "field"),
        None if -1 in orientation else (orientation[0], orientation[1], orientation[2], orientation[3]),
        found.get(("seq", 0)),
        found.get(("temperature", 0)),
        units,
    )


def _three(found: dict[tuple[str, int], int], kind: str) -> tuple[int, int, int] | None:
    places = [found.get((kind, i), -1) for i in range(3)]
    return None if -1 in places else (places[0], places[1], places[2])


def _known(name: str, unit: str | None) -> tuple[str, int] | None:
    if name in _TIMES:
        return "time", 0
    if name == "seq":
        return "seq", 0
    if name in _QUATERNION:
        return "orientation", _QUATERNION[name]
    if _TEMPERATURE.fullmatch(name):
        return ("temperature", 0) if unit in _CELSIUS else None
    return _VECTORS.get(name)


def _split(cell: str) -> tuple[str, str | None]:
    """A cell's name in small letters without signs, and its unit: in brackets, behind ``_``, or implied."""
    name, unit = split_unit(cell)
    stem, _, suffix = name.rpartition("_")
    if unit is None and stem and suffix.lower() in _SUFFIX_UNITS:
        name, unit = stem, suffix.lower()
    plain = re.sub(r"[^a-z0-9]", "", name.lower())
    unit = _SAID_BY_NAME.get(plain, unit)
    return plain, None if unit is None else spelt(unit)


def spelt(unit: str) -> str:
    """A unit as ``UNITS`` spells it."""
    return _SPELT.get(unit.strip().lower(), unit.strip().lower())


def is_unit(kind: str, unit: str) -> bool:
    """Whether it is a unit of ``force``, ``rate``, ``field`` or ``time``."""
    return unit in (TIME_DIGITS if kind == "time" else UNITS[kind])
