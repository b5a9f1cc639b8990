"""Heart: units as headers write them, and their factors to SI. 1 gauss is 100 µT."""

from __future__ import annotations

import math

from app.motion.basics import G_MPS2, InputError

FORCE = {"m/s²": 1.0, "m/s^2": 1.0, "m/s2": 1.0, "m/s/s": 1.0, "mps2": 1.0, "g": G_MPS2, "mg": G_MPS2 / 1000}
RATE = {"rad/s": 1.0, "radps": 1.0}
RATE |= dict.fromkeys(("deg/s", "°/s", "dps", "degps"), math.pi / 180)
FIELD = {"uT": 1.0, "µT": 1.0, "μT": 1.0, "gauss": 100.0, "G": 100.0, "nT": 1e-3, "mgauss": 0.1, "mG": 0.1}
FIELD |= dict.fromkeys(("a.u.", "au"), 1.0)
TIME_DIGITS = {"s": 9, "sec": 9, "ms": 6, "us": 3, "µs": 3, "μs": 3, "ns": 0}  # decimal digits down to 1 ns

RELATIVE = ("a.u.", "au")


def factor(name: str, column: str, unit: str | None, table: dict[str, float]) -> float:
    """What to multiply ``column`` by for SI; ``InputError`` if its header has no unit or an unknown one."""
    spellings: dict[float, str] = {}
    for name_of_unit, scale in table.items():
        spellings.setdefault(scale, name_of_unit)
    expected = " or ".join(spellings.values())
    if unit is None:
        raise InputError(f"{name}: column {column!r} has no unit, expected {expected} in brackets behind it")
    for name_of_unit, scale in table.items():
        if name_of_unit.lower() == unit.lower():
            return scale
    raise InputError(f"{name}: column {column!r} has the unit {unit!r}, expected {expected}")


def split_unit(cell: str) -> tuple[str, str | None]:
    """A header cell's name and its unit in round or square brackets, or None."""
    for opening, closing in ("()", "[]"):
        start = cell.rfind(opening)
        if start > 0 and cell.endswith(closing):
            return cell[:start].strip(), cell[start + 1 : -1].strip()
    return cell.strip(), None
