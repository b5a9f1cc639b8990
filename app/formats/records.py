"""Heart: the records of an MCAP chunk as a table, and columns of equal messages: reading's compiled part."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from app.compiled import kernel
from app.motion.basics import Floats, Ints

Octets = NDArray[np.uint8]

MESSAGE = 0x05
_HEAD, _MESSAGE_HEAD = 9, 22  # bytes before a record's content; before a message's data


class At(IntEnum):
    """Columns of a chunk's table, int64 [n, 7]: a row for each record. Stamps are modulo 2⁶⁴."""

    OPCODE = 0
    NUMBER = 1  # of the channel or schema
    SEQUENCE = 2
    LOG_NS = 3
    PUBLISH_NS = 4
    BEGIN = 5  # of a message's data, or of another record's content
    END = 6


WIDTH = len(At)


@kernel
def _whole(octets: Octets, at: int, count: int) -> int:
    """A little-endian number; of eight bytes it is what int64 makes of them."""
    value = np.int64(0)
    for i in range(count):
        value |= np.int64(octets[at + i]) << np.int64(8 * i)
    return value  # type: ignore[return-value]


@kernel
def _fill(octets: Octets, rows: Ints) -> int:
    """Rows of ``At`` for every record; how many, or −1 where the records do not fit the chunk exactly."""
    count, at, end = 0, 0, octets.shape[0]
    while at < end:
        if at + _HEAD > end:
            return -1
        opcode, length = octets[at], _whole(octets, at + 1, 8)
        at += _HEAD
        if length < 0 or length > end - at:
            return -1
        row = rows[count]
        row[0], row[1], row[2], row[3], row[4], row[5], row[6] = opcode, -1, 0, 0, 0, at, at + length
        if opcode == MESSAGE:
            if length < _MESSAGE_HEAD:
                return -1
            row[2] = _whole(octets, at + 2, 4)
            row[3], row[4] = _whole(octets, at + 6, 8), _whole(octets, at + 14, 8)
            row[5] = at + _MESSAGE_HEAD
        if length >= 2:
            row[1] = _whole(octets, at, 2)
        count += 1
        at += length
    return count


@kernel
def _copy(octets: Octets, begins: Ints, columns: Ints, copied: Octets) -> None:
    """Eight bytes each from ``begins`` [n] + 8 × ``columns`` [m] into ``copied`` [n, 8 m]."""
    for i in range(begins.shape[0]):
        for j in range(columns.shape[0]):
            begin = begins[i] + 8 * columns[j]
            for k in range(8):
                copied[i, 8 * j + k] = octets[begin + k]


@kernel
def _fill_all(octets: Octets, bounds: Ints, rows: Ints, counts: Ints) -> int:
    """``_fill`` for each chunk between ``bounds`` [k + 1], one behind the other; how many rows in all."""
    total = 0
    for i in range(counts.shape[0]):
        begin, end = bounds[i], bounds[i + 1]
        counts[i] = _fill(octets[begin:end], rows[total:])
        for row in range(total, total + max(counts[i], 0)):
            rows[row, 5] += begin
            rows[row, 6] += begin
        total += max(counts[i], 0)
    return total


def table(records: bytes) -> Ints | None:
    """All records of a chunk as rows [n, 7] by ``At``; None if they are not what a chunk holds."""
    rows, counts = tables(records, np.array([0, len(records)]))
    return rows if counts[0] >= 0 else None


def tables(records: bytes, bounds: Ints) -> tuple[Ints, Ints]:
    """The rows of many chunks, chunk i from ``bounds[i]`` to ``bounds[i + 1]``, and how many each has.

    −1, and no row, for one that is not what a chunk holds. Places are those in ``records``.
    """
    octets = np.frombuffer(records, np.uint8)
    rows = np.empty((len(records) // _HEAD, WIDTH), np.int64)
    counts = np.empty(len(bounds) - 1, np.int64)
    return rows[: _fill_all(octets, bounds, rows, counts)], counts


def last_doubles(records: bytes, rows: Ints, last: int, columns: Sequence[int]) -> Floats:
    """Of the ``last`` doubles of each message those in ``columns``, [n, m]; too short is ``ValueError``."""
    if len(rows) and int((rows[:, At.END] - rows[:, At.BEGIN]).min()) < 16 + 8 * last:
        raise ValueError("a message is too short")
    copied = np.empty((len(rows), 8 * len(columns)), np.uint8)
    begins = rows[:, At.END] - 8 * last
    _copy(np.frombuffer(records, np.uint8), begins, np.array(columns, np.int64), copied)
    return copied.view("<f8").astype(np.float64, copy=False)
