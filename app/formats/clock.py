"""Heart: times as loggers write them: seconds, nanoseconds since 1970, or the time of day.

A spreadsheet that saved the file may have cut a time of day to tenths of a second; then the
rows are spread evenly, and that is said.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.formats.raw import even_stamps, whole_ns
from app.formats.table import nanoseconds
from app.motion.basics import Floats, InputError, Ints

_EPOCH_NS = 1e16  # a time above this is in nanoseconds: as seconds it would be 300 million years
_ROUND = 0.005


def stamps(name: str, cells: NDArray[np.str_], rate_hz: float | None) -> tuple[Ints, tuple[str, ...]]:
    """Stamps [n] of the time cells, and in words what was assumed.

    Raises ``InputError`` if the first cell is no time.
    """
    first = str(cells[0])
    if ":" in first:
        return _times_of_day(name, cells, rate_hz)
    try:
        in_ns = abs(float(first)) > _EPOCH_NS
    except ValueError:
        raise InputError(f"{name}: the time reads {first!r}, expected seconds or h:m:s") from None
    return np.asarray(nanoseconds(0 if in_ns else 9)(cells.tolist()), np.int64), ()


def _times_of_day(name: str, cells: NDArray[np.str_], rate_hz: float | None) -> tuple[Ints, tuple[str, ...]]:
    period_s = 86400.0 if str(cells[0]).count(":") > 1 else 3600.0
    seconds = _unwrapped(np.array([_second_of_day(cell) for cell in cells.tolist()]), period_s)
    known = seconds[np.isfinite(seconds)]
    if len(known) < 2 or rate_hz or np.mean(np.diff(known) == 0.0) <= 0.5:
        return whole_ns(seconds * 1e9), ()
    span_s = known[-1] - known[0]
    if span_s <= 0.0:
        raise InputError(f"{name}: every row has the time {cells[0]}, expected it to increase: give rate=")
    rate_found_hz = (len(seconds) - 1) / span_s
    if abs(round(rate_found_hz) / rate_found_hz - 1.0) < _ROUND:
        rate_found_hz = float(round(rate_found_hz))
    sentence = f"{rate_found_hz:.4g} Hz assumed: the file's clock is too coarse, rows were spread evenly"
    return even_stamps(np.arange(len(seconds)), rate_found_hz), (sentence,)


def _second_of_day(cell: str) -> float:
    """Seconds of ``14:03:05.25``, ``2:03:05 pm`` or ``55:29.2``, whatever the date before it; NaN if none."""
    parts = cell.replace("t", " ").split()
    time = next((part for part in parts if ":" in part), "")
    try:
        values = [float(part) for part in time.rstrip("z").split(":")]
    except ValueError:
        return float("nan")
    if not 2 <= len(values) <= 3:
        return float("nan")
    if parts[-1] in ("am", "pm") and len(values) == 3:
        values[0] = values[0] % 12 + (12 if parts[-1] == "pm" else 0)
    return float(sum(value * 60.0 ** (len(values) - 1 - i) for i, value in enumerate(values)))


def _unwrapped(seconds: Floats, period_s: float) -> Floats:
    """Times of day made to run on past midnight (past the hour, where hours are not written)."""
    known = np.isfinite(seconds)
    steps = np.diff(seconds[known], prepend=seconds[known][:1])
    unwrapped = seconds.copy()
    unwrapped[known] += period_s * np.cumsum(steps < -0.5 * period_s)
    return unwrapped
