"""Heart: an MCAP file gathered by channel: equal messages' doubles in columns, the others as bytes.

Nothing of a damaged file is lost that a chunk's CRC vouches for: messages whose channel is defined only
later wait for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from app.formats import mcap
from app.formats.records import MESSAGE, At, last_doubles, tables
from app.motion.basics import Floats, Ints

#: Bytes of records looked through at once: many chunks are small.
_TOGETHER = 8 * 2**20


class Doubles(NamedTuple):
    """What is wanted of CDR messages: some of their last ``last`` doubles."""

    last: int
    columns: tuple[int, ...]


#: What is wanted of a channel: doubles, all of its bytes (True), or only how many there are (False).
Want = Callable[[mcap.Channel], Doubles | bool]


class Gathered(NamedTuple):
    """One channel's messages in the file's order, [n]; ``place`` counts all messages of the file."""

    place: Ints
    sequence: Ints
    log_ns: Ints  # modulo 2⁶⁴, as int64
    publish_ns: Ints
    doubles: Floats  # [n, columns]; [n, 0] if none are wanted
    data: list[bytes]  # empty if none are wanted


class _Page(NamedTuple):
    """The message rows of some chunks, and the bytes they point into."""

    records: bytes
    rows: Ints
    place: Ints


@dataclass
class Contents:
    """All channels and what was wanted of each."""

    channels: dict[int, mcap.Channel] = field(default_factory=dict)
    gathered: dict[int, Gathered] = field(default_factory=dict)
    closed: bool = False
    damaged: int = 0  # chunks that the end of the file tells of, and that are not whole


def gather(data: bytes, want: Want) -> Contents:
    """Everything whole in a file; ``ValueError`` if a message is too short for the doubles wanted of it."""
    contents = Contents(closed=mcap.is_closed(data), damaged=_told(data))
    parts: dict[int, list[Gathered]] = {}
    waiting: list[_Page] = []
    for page in _pages(data, contents):
        rest = _sort(page, contents.channels, want, parts)
        waiting += [rest] if len(rest.rows) else []
    for page in waiting:
        _sort(page, contents.channels, want, parts)
    contents.gathered = {number: _joined(parts.get(number, [])) for number in contents.channels}
    return contents


def _told(data: bytes) -> int:
    """How many chunks a closed file has by its summary; 0 where that is not whole."""
    index = mcap.index(len(data), lambda at, count: data[at : at + count])
    return 0 if index is None else len(index.chunks)


def _pages(data: bytes, contents: Contents) -> Iterator[_Page]:
    """The messages of many chunks at once; channels are put where they belong on the way."""
    place = 0
    for chunks in _together(data):
        contents.damaged = max(contents.damaged - len(chunks), 0)
        records = b"".join(chunks)
        rows = _believed(records, chunks, contents.channels)
        rows = rows[rows[:, At.OPCODE] == MESSAGE]
        yield _Page(records, rows, place + np.arange(len(rows)))
        place += len(rows)


def _together(data: bytes) -> Iterator[list[bytes]]:
    """The file's chunks in lists of some size."""
    chunks: list[bytes] = []
    size = 0
    for chunk in mcap.whole_chunks(data):
        chunks.append(chunk)
        size += len(chunk)
        if size > _TOGETHER:
            yield chunks
            chunks, size = [], 0
    if chunks:
        yield chunks


def _believed(records: bytes, chunks: list[bytes], channels: dict[int, mcap.Channel]) -> Ints:
    """The rows of all chunks but of those whose records or definitions make no sense."""
    bounds = np.cumsum([0, *map(len, chunks)])
    rows, counts = tables(records, bounds)
    ends = np.cumsum(np.maximum(counts, 0))
    keep = np.ones(len(rows), np.bool_)
    others = np.searchsorted(ends, np.flatnonzero(rows[:, At.OPCODE] != MESSAGE), side="right")
    for i in np.unique(others).tolist():  # chunks that hold more than messages
        own = slice(int(ends[i] - counts[i]), int(ends[i]))
        keep[own] = mcap.define(records, rows[own], channels)
    return rows[keep]


def _sort(
    page: _Page, channels: dict[int, mcap.Channel], want: Want, parts: dict[int, list[Gathered]]
) -> _Page:
    """Each channel's messages to its part; what is left is of channels not known yet."""
    left = np.ones(len(page.rows), np.bool_)
    for number in np.unique(page.rows[:, At.NUMBER]).tolist():
        if number in channels:
            own = page.rows[:, At.NUMBER] == number
            left &= ~own
            made = _part(page.records, page.rows[own], page.place[own], want(channels[number]))
            parts.setdefault(number, []).append(made)
    return _Page(page.records, page.rows[left], page.place[left])


def _part(records: bytes, rows: Ints, place: Ints, wanted: Doubles | bool) -> Gathered:
    doubles: Floats = np.empty((len(rows), 0))
    data: list[bytes] = []
    if isinstance(wanted, Doubles):
        doubles = last_doubles(records, rows, wanted.last, wanted.columns)
    elif wanted:
        data = [records[begin:end] for begin, end in rows[:, At.BEGIN :].tolist()]
    sequence, log_ns, publish_ns = (rows[:, at].copy() for at in (At.SEQUENCE, At.LOG_NS, At.PUBLISH_NS))
    return Gathered(place, sequence, log_ns, publish_ns, doubles, data)


def _joined(parts: list[Gathered]) -> Gathered:
    if not parts:
        none = np.empty(0, np.int64)
        return Gathered(none, none, none, none, np.empty((0, 0)), [])
    parts = sorted(parts, key=lambda part: int(part.place[0]))  # those that had to wait come in between
    return Gathered(
        np.concatenate([part.place for part in parts]),
        np.concatenate([part.sequence for part in parts]),
        np.concatenate([part.log_ns for part in parts]),
        np.concatenate([part.publish_ns for part in parts]),
        np.concatenate([part.doubles for part in parts]),
        [item for part in parts for item in part.data],
    )
