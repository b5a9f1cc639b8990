"""Heart: which rows count: finite, within any sensor's reach, and later than the last one kept.

The same rule as a live intake's. Gaps stay gaps. A magnetometer that reads nothing leaves the row. A device
whose clock was set back goes on behind a gap: nothing is integrated across, and no row is lost by it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from app.formats.raw import NO_STAMP, RawFoot
from app.motion.basics import Floats, InputError, Ints, role_of
from app.motion.samples import (
    BACKWARD,
    GAP_NS,
    MOST_READ,
    NOT_FINITE,
    REPEATED,
    SAMPLE_WIDTH,
    Samples,
)

LEAPT = "a time far off"

_MOST_NS = 2**62
_LONGEST_NS = 2**53  # 104 days: beyond it ELAPSED_NS would not be exact
#: A clock that fell back is believed after so many stamps that follow each other, as live. At a file's end
#: fewer have to do, where they are further back than anything comes late.
FELL_BACK, AT_THE_END = 8, 2


class SetBack(NamedTuple):
    """A clock that was set back: when, by the stamps as they are told on, and by how much."""

    at_s: float  # since the first row
    by_s: float


def clean(raw: RawFoot) -> tuple[Samples, tuple[SetBack, ...]]:
    """The rows that count, how many were dropped for which reason, and where the clock was set back.

    ``InputError`` if no row is left.
    """
    raw, lone = without_lone_leaps(raw)
    raw, set_back = told_on(raw)
    rows, dropped = countable(raw)
    dropped = {LEAPT: lone} | dropped if lone else dropped
    if not len(rows):
        raise InputError(f"{raw.sensor}: none of {len(raw.stamps_ns)} rows is finite, expected samples")
    stamps_ns = raw.stamps_ns[rows]
    samples = Samples(
        sensor=raw.sensor,
        role=role_of(raw.sensor),
        device_ns=int(stamps_ns[0]),
        matrix=_matrix(raw, rows, stamps_ns),
        saturation=np.zeros(len(rows), np.uint16),
        dropped=dropped,
    )
    return samples, set_back


def told_on(raw: RawFoot) -> tuple[RawFoot, tuple[SetBack, ...]]:
    """With the stamps behind each set-back of the clock moved behind all before them.

    Stamps that are merely late (fewer than ``FELL_BACK`` in a row) stay as they are.
    """
    at = np.flatnonzero(raw.stamps_ns != NO_STAMP)
    if len(at) <= AT_THE_END:
        return raw, ()
    stamps = raw.stamps_ns[at]
    added = np.zeros(len(at), np.int64)
    found, begin, passed_ns, latest_ns = [], 0, 0, int(stamps[0])
    for fall in _falls(stamps).tolist():
        latest_ns = max(latest_ns, int(stamps[begin:fall].max()))
        begin, by_ns = fall, latest_ns - int(stamps[fall])
        if stamps[min(fall + FELL_BACK, len(at)) - 1] <= latest_ns and passed_ns + by_ns < _MOST_NS:
            found.append(SetBack((latest_ns + passed_ns - int(stamps[0])) * 1e-9, by_ns * 1e-9))
            added[fall] = by_ns + GAP_NS + 1
            passed_ns, latest_ns = passed_ns + by_ns + GAP_NS + 1, int(stamps[fall])
    if not found:
        return raw, ()
    shift = np.cumsum(added)
    within = np.abs(stamps.astype(np.float64) + shift) < _MOST_NS
    told = raw.stamps_ns.copy()
    told[at] = np.where(within, stamps + shift, NO_STAMP)
    return replace(raw, stamps_ns=told), tuple(found)


def _falls(stamps: Ints) -> Ints:
    """Where a stamp is not later than the one before, and the next ones follow it closely."""
    steps = np.diff(stamps)
    small = (steps > 0) & (steps <= GAP_NS)
    near = np.concatenate([[0], np.cumsum(small)])
    run = FELL_BACK - 1
    follow = near[run:] - near[:-run] == run  # from each stamp the next ``run`` steps
    falls = np.flatnonzero(follow[1:] & (steps[: max(len(follow) - 1, 0)] <= 0)) + 1
    end = np.flatnonzero(~small)[-1:] + 1  # from here on all follow closely, to the last
    few = (len(stamps) - end >= AT_THE_END) & (len(stamps) - end < FELL_BACK) & (steps[end - 1] < -GAP_NS)
    return np.concatenate([falls, end[few]])


def without_lone_leaps(raw: RawFoot) -> tuple[RawFoot, int]:
    """Without rows whose stamp leaps ahead by a gap while the next one goes on before it, and how many.

    Such a stamp would make all that follow it late. Rows that are no use anyway are left as they are.
    """
    at = np.flatnonzero(raw.stamps_ns != NO_STAMP)
    stamps = raw.stamps_ns[at].astype(np.float64)
    if len(stamps) < 3:
        return raw, 0
    before, after = np.r_[-np.inf, stamps[:-1]], np.r_[stamps[1:], np.inf]
    before[0] = after[0] - 1.0  # the first leapt if the second is a gap before it
    lone = (stamps - before > GAP_NS) & (stamps - after > GAP_NS) & (after > before)
    keep = np.ones(len(raw.stamps_ns), np.bool_)
    keep[at[lone]] = False
    field = None if raw.field is None else raw.field[keep]
    return replace(
        raw, stamps_ns=raw.stamps_ns[keep], force=raw.force[keep], rate=raw.rate[keep], field=field
    ), int(lone.sum())


def countable(raw: RawFoot) -> tuple[Ints, dict[str, int]]:
    """Which rows count, and how many others were dropped for which reason."""
    finite = _usable(raw)
    later = _later(raw.stamps_ns[finite])
    dropped = {NOT_FINITE: int(len(finite) - finite.sum())}
    dropped |= {REPEATED: int((later == 0).sum()), BACKWARD: int((later < 0).sum())}
    rows = np.flatnonzero(finite)[later > 0]
    return rows, {reason: count for reason, count in dropped.items() if count}


def _usable(raw: RawFoot) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    with np.errstate(invalid="ignore"):
        values = (np.abs(raw.force) < MOST_READ).all(axis=1) & (np.abs(raw.rate) < MOST_READ).all(axis=1)
    usable: np.ndarray[tuple[int], np.dtype[np.bool_]] = values & (raw.stamps_ns != NO_STAMP)
    if usable.any():  # a first stamp sets the start; what lies beyond the clock's reach is unreadable
        first = int(raw.stamps_ns[np.argmax(usable)])
        usable &= raw.stamps_ns.astype(np.float64) - first < _LONGEST_NS
    return usable


def _later(stamps_ns: Ints) -> Ints:
    """1 where a stamp is later than all before it, 0 where it repeats the latest, −1 where it is earlier."""
    if not len(stamps_ns):
        return stamps_ns
    latest = np.maximum.accumulate(stamps_ns)
    sign = np.ones(len(stamps_ns), np.int64)
    sign[1:] = np.sign(stamps_ns[1:] - latest[:-1])
    return sign


def _matrix(raw: RawFoot, rows: Ints, stamps_ns: Ints) -> Floats:
    matrix = np.full((len(rows), SAMPLE_WIDTH), np.nan)
    matrix[:, 0] = stamps_ns - stamps_ns[0]
    matrix[:, 1:4] = raw.force[rows]
    matrix[:, 4:7] = raw.rate[rows]
    if raw.field is not None:
        with np.errstate(invalid="ignore"):
            whole = (np.abs(raw.field[rows]) < MOST_READ).all(axis=1)
        matrix[whole, 7:10] = raw.field[rows[whole]]
    return matrix
