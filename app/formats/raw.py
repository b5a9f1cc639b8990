"""Heart: what a file parser hands on: one foot's numbers in SI and the sensor's own axes, not yet cleaned."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from app.motion.basics import Floats, Ints

#: A stamp that could not be read.
NO_STAMP = int(np.iinfo(np.int64).min)


@dataclass(frozen=True)
class RawFoot:
    """One sensor's rows as the file has them: nothing dropped, nothing turned."""

    sensor: str
    stamps_ns: Ints  # [n]; NO_STAMP where unreadable
    force: Floats  # [n, 3] m/s²
    rate: Floats  # [n, 3] rad/s
    field: Floats | None = None  # [n, 3] µT, NaN where there is none


@dataclass(frozen=True)
class Parsed:
    """A parsed file. ``unread`` counts rows that no foot got (reason → rows).

    ``wide``: one row of the file holds all feet. ``mounted``: already in toe, right, down.
    ``timed``: the stamps are the file's own. ``force_unit`` is what the file claims.
    """

    format: str
    feet: tuple[RawFoot, ...]
    unread: Mapping[str, int] = field(default_factory=dict)
    assumed: tuple[str, ...] = ()
    spec: str | None = None
    mounted: bool = False
    timed: bool = True
    wide: bool = False
    force_unit: str = "m/s²"
    device: str | None = None


def even_stamps(index: Floats | Ints, rate_hz: float) -> Ints:
    """Stamps of rows ``index`` [n] at an even rate, ns, each rounded once; NO_STAMP where not finite."""
    with np.errstate(all="ignore"):
        return whole_ns(np.asarray(index, np.float64) * 1e9 / rate_hz)


def whole_ns(stamps: Floats) -> Ints:
    """Nanoseconds as floats [n], rounded; NO_STAMP where not finite or past ±146 years."""
    with np.errstate(invalid="ignore"):
        usable = np.abs(stamps) < 2.0**62
        return np.where(usable, np.rint(np.where(usable, stamps, 0.0)), NO_STAMP).astype(np.int64)
