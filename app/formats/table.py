"""Heart: delimited text into columns: the one place that cuts lines and cells.

The body is read in blocks and column by column, so that a long file costs little memory and
columns nobody wants cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.raw import NO_STAMP, whole_ns
from app.motion.basics import Floats, InputError, Ints

Converter = Callable[[list[str]], NDArray[Any]]

_HEAD_BYTES = 65536
_BLOCK_BYTES = 1 << 21
_EXACT_S = 1e6  # a float64 second times 1e9 is right to the nanosecond up to here

TRUNCATED = "truncated row"
MISSHAPEN = "wrong number of cells"


@dataclass(frozen=True)
class Head:
    """The first lines of a text file: ``rows`` are cells, stripped; ``ends`` the bytes each row ends at."""

    comments: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    ends: tuple[int, ...]
    separator: str


def to_text(name: str, data: bytes) -> bytes:
    """The file as UTF-8 bytes with \\n line ends and no byte-order mark; ``InputError`` if it is no text."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        data = data.decode("utf-16", errors="replace").encode()
    data = data.removeprefix(b"\xef\xbb\xbf")
    if b"\0" in data[:_HEAD_BYTES]:
        raise InputError(f"{name}: binary data, expected a CSV recording or a MATLAB file")
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return data


def read_head(data: bytes) -> Head:
    """The comments and rows among the first 64 kB of text, and 64 kB more behind the first comments."""
    comments, rows, ends = [], [], []
    lines = data[: _first_row(data) + _HEAD_BYTES].split(b"\n")
    separator = _separator(lines)
    end = 0
    for line in lines:
        end += len(line) + 1
        text = _decode(line).strip()
        if text.startswith("#"):
            comments.append(text.lstrip("# "))
        elif text:
            rows.append(tuple(cell.strip().strip('"') for cell in text.split(separator)))
            ends.append(min(end, len(data)))
    return Head(tuple(comments), tuple(rows), tuple(ends), separator)


def _first_row(data: bytes) -> int:
    """Where the first line begins that is no comment."""
    start = 0
    while data.startswith(b"#", start):
        start = data.find(b"\n", start) + 1 or len(data)
    return start


def _decode(line: bytes) -> str:
    try:
        return line.decode()
    except UnicodeDecodeError:
        return line.decode("latin-1")


def _separator(lines: list[bytes]) -> str:
    """A comma, a semicolon or a tab: whichever the first line that is no comment has most of."""
    first = next((line for line in lines if line.strip() and not line.lstrip().startswith(b"#")), b"")
    return max(",;\t", key=lambda mark: first.count(mark.encode()))


def read_columns(
    name: str, data: bytes, head: Head, header: int, converters: Mapping[int, Converter]
) -> tuple[dict[int, NDArray[Any]], dict[str, int]]:
    """Columns below row ``header`` of the head, each by its converter, and the rows not read by reason.

    Rows with too few or too many cells are left out. ``InputError`` if no row is left.
    """
    width = len(head.rows[header])
    parts: dict[int, list[NDArray[Any]]] = {column: [] for column in converters}
    unread: dict[str, int] = {}
    for lines, is_last in _blocks(data, head.ends[header]):
        good = [line for line in lines if line.count(head.separator) == width - 1]
        _count_unread(unread, lines, len(good), is_last, head.separator, width)
        cells = head.separator.join(good).split(head.separator) if good else []
        if head.separator != ",":
            cells = [cell.replace(",", ".") for cell in cells]
        for column, convert in converters.items():
            parts[column].append(convert(cells[column::width]))
    columns = {column: np.concatenate(arrays) for column, arrays in parts.items() if arrays}
    if not columns or not len(next(iter(columns.values()))):
        raise InputError(f"{name}: a header but no whole row below it, expected samples")
    return columns, unread


def _count_unread(
    unread: dict[str, int], lines: list[str], good: int, is_last: bool, separator: str, width: int
) -> None:
    bad = len(lines) - good
    if bad and is_last and lines[-1].count(separator) < width - 1:
        unread[TRUNCATED] = 1
        bad -= 1
    if bad:
        unread[MISSHAPEN] = unread.get(MISSHAPEN, 0) + bad


def _blocks(data: bytes, start: int) -> Iterator[tuple[list[str], bool]]:
    """Lines of text, neither blank nor comments, a few megabytes at a time, and whether it is the last."""
    while start < len(data):
        end = data.rfind(b"\n", start, start + _BLOCK_BYTES) + 1
        if end <= start:
            end = data.find(b"\n", start) + 1 or len(data)
        lines = data[start:end].decode(errors="replace").split("\n")
        start = end
        yield [line for line in lines if line and line[0] != "#" and not line.isspace()], start >= len(data)


# --- converters: a column's cells into numbers ----------------------------------------------------


def floats(cells: list[str]) -> Floats:
    """Numbers; NaN where a cell is empty or no number."""
    try:
        return np.array(list(map(float, cells)), np.float64)
    except ValueError:
        return np.array([_float(cell) for cell in cells], np.float64)


def _float(cell: str) -> float:
    try:
        return float(cell.strip().strip('"'))
    except ValueError:
        return float("nan")


def shifted_floats(digits: int) -> Converter:
    """Numbers times 10^digits, rounded once, so that writing the shift back is exact."""
    return partial(_shifted, suffix=f"e{digits}")


def _shifted(cells: list[str], suffix: str) -> Floats:
    try:
        return np.array([float(cell + suffix) if cell else np.nan for cell in cells], np.float64)
    except ValueError:
        return np.array([_shifted_float(cell, suffix) for cell in cells], np.float64)


def _shifted_float(cell: str, suffix: str) -> float:
    """One cell that is perhaps empty, perhaps written with an exponent of its own."""
    value = _decimal(cell)
    try:
        return float(value.scaleb(int(suffix[1:]))) if value is not None else float("nan")
    except (InvalidOperation, OverflowError):
        return float("nan")


def _decimal(cell: str) -> Decimal | None:
    try:
        value = Decimal(cell.strip().strip('"'))
    except InvalidOperation:
        return None
    return value if value.is_finite() else None


def nanoseconds(digits: int) -> Converter:
    """Stamps times 10^digits (9: from seconds) as whole nanoseconds, exact; NO_STAMP where unreadable."""
    return partial(_nanoseconds, digits=digits)


def _nanoseconds(cells: list[str], digits: int) -> Ints:
    values = floats(cells)
    finite = values[np.isfinite(values)]
    if np.all(np.abs(finite) < _EXACT_S * 10.0 ** (9 - digits)):
        return whole_ns(values * 10.0**digits)
    return np.array([_exact_ns(cell, digits) for cell in cells], np.int64)


def _exact_ns(cell: str, digits: int) -> int:
    value = _decimal(cell)
    if value is None or value.adjusted() + digits > 18:
        return NO_STAMP
    return int(value.scaleb(digits).to_integral_value())


def words(cells: list[str]) -> NDArray[np.str_]:
    """Words, in small letters."""
    plain = {cell: cell.strip().strip('"').lower() for cell in set(cells)}
    return np.array([plain[cell] for cell in cells], np.str_)
