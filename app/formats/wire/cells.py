"""Heart: the text of a line: cells, names and values, numbers and times, and what units they must be in."""

from __future__ import annotations

import json
import re
from itertools import pairwise
from statistics import median

from app.formats.wire.columns import find_columns
from app.motion.basics import G_MPS2, Quaternion, Vector

_CLOCK = re.compile(r"(\d{1,2}):(\d{1,2}):(\d{1,2}(?:\.\d*)?)")
_JSON = json.JSONDecoder(parse_int=str, parse_float=str)
_LETTERS = re.compile(r"\$?[A-Za-z]+")


def force_unit(rest: float) -> str | None:
    """The unit in which a still accelerometer reads this."""
    for unit, expected in (("g", 1.0), ("m/s2", G_MPS2), ("mg", 1000.0)):
        if abs(rest / expected - 1.0) < 0.2:
            return unit
    return None


def time_unit(cells: list[str]) -> str:
    """The unit of a time column by its median step; s where it does not tell."""
    times = [value for cell in cells if (value := number(cell)) is not None]
    steps = [after - before for before, after in pairwise(times) if after > before]
    step = median(steps) if steps else 0.0
    return "s" if step < 0.5 else "ms" if step < 900 else "us" if step < 900_000 else "ns"


def number(cell: str) -> float | None:
    """A cell as a number; None if it is none."""
    if "_" in cell:  # Python would read 1_0 as 10
        return None
    try:
        return float(cell)
    except ValueError:
        return None


def nanoseconds(cell: str, tick_ns: int) -> int | None:
    """A time in whole nanoseconds, without passing through a float where it is decimal or h:m:s."""
    clock = _CLOCK.fullmatch(cell)
    if clock is not None:
        return round((int(clock[1]) * 3600 + int(clock[2]) * 60 + float(clock[3])) * 1e9)
    whole, _, fraction = cell.partition(".")
    if (whole + fraction).isdigit() and cell.isascii() and len(cell) <= 40:
        part = int(fraction or "0") * tick_ns / float(10 ** len(fraction))
        return int(whole or "0") * tick_ns + round(part)
    value = number(cell)
    return round(value * tick_ns) if value is not None and abs(value) < 1e18 else None


def triple(cells: list[str], places: tuple[int, int, int]) -> Vector | None:
    """Three cells as numbers; None if one is none."""
    i, j, k = places
    try:
        v = (float(cells[i]), float(cells[j]), float(cells[k]))
    except ValueError:
        return None
    return None if "_" in cells[i] + cells[j] + cells[k] else v


def quad(cells: list[str], places: tuple[int, int, int, int] | None) -> Quaternion | None:
    """Four cells as numbers; None if one is none, or there are no such cells."""
    values = [] if places is None else [number(cells[place]) for place in places]
    w, x, y, z = values if len(values) == 4 else (None, None, None, None)
    return None if w is None or x is None or y is None or z is None else (w, x, y, z)


def split_cells(line: str) -> list[str]:
    """Cells by the first separator it has: comma, semicolon, tab, spaces."""
    for separator in ",;\t":
        if separator in line:
            return [cell.strip() for cell in line.split(separator)]
    return line.split()


def unwrapped(line: str) -> str | None:
    """A line without ``IMU,`` or ``$IMU,…*hh`` around it; None if that checksum is wrong."""
    if line.startswith("$") and "*" in line:
        line, _, given = line.rpartition("*")
        total = 0
        for byte in line[1:].encode():
            total ^= byte
        if given.strip().upper() != f"{total:02X}":
            return None
    head, _, rest = line.partition(",")
    return rest if _is_prefix(head, rest) else line


def _is_prefix(head: str, rest: str) -> bool:
    """A word before numbers is a prefix; before words it is a column's name."""
    return _LETTERS.fullmatch(head) is not None and number(rest.partition(",")[0]) is not None


def word_before(line: str) -> str:
    """The word with which a board begins lines of one kind, as ``IMU`` or ``$GPGGA``; empty without one."""
    head = line.partition(",")[0]
    return head if _LETTERS.fullmatch(head) else ""


def are_words(cells: list[str]) -> bool:
    """Whether it can be a header: its first cell and five more begin with a letter."""
    return cells[0][:1].isalpha() and sum(cell[:1].isalpha() for cell in cells) >= 6


def is_broken(cell: str) -> bool:
    """Whether a cell was a number before it was damaged: a board's own word, as ``nan``, has no digit."""
    return number(cell) is None and any(character.isdigit() for character in cell)


def is_torn(line: str, cells: list[str], count: int) -> bool:
    """Whether a line that fits no columns was a row of ``count`` cells before it was damaged.

    What else a board prints, it says in words, or in JSON that can be read.
    """
    numbers = sum(number(cell) is not None for cell in cells)
    return 2 * numbers >= count or (line.startswith("{") and cells == [])


def named_cells(line: str) -> tuple[list[str], list[str]]:
    """Names and values of ``name:value`` cells; a line of other cells has no names."""
    cells = split_cells(line)
    pairs = [cell.split(":") for cell in cells if cell] if ":" in line else []
    if pairs and all(len(pair) == 2 and pair[0] and not pair[0][0].isdigit() for pair in pairs):
        return [pair[0] for pair in pairs], [pair[1].strip() for pair in pairs]
    return [], cells


def flat_object(line: str) -> tuple[list[str], list[str]]:
    """Names and values of a flat JSON object; nothing where it is none."""
    try:
        read = _JSON.decode(line)
    except (ValueError, RecursionError):
        return ["?"], []
    if not isinstance(read, dict):
        return ["?"], []
    return list(read), [value if isinstance(value, str) else "" for value in read.values()]


def readable(line: bytes) -> bool:
    """Whether a whole line reads like a sensor's: a header, named values, or six numbers."""
    text = line.decode("utf-8", "replace").strip()
    if text.startswith("{"):
        return find_columns(flat_object(text)[0]) is not None
    names, cells = named_cells(unwrapped(text) or "")
    if find_columns(names or cells) is not None:
        return True
    return sum(number(cell) is not None for cell in cells) >= 6
