"""Benchmarks: strides against pressure under heel and toe (marpino_both_feet), read here: it is no import."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from app.estimator.smoother import finish
from app.estimator.tracker import Tracker, store
from app.motion.basics import Floats, Role
from app.motion.samples import Samples
from app.settings import Settings
from benchmarks.measured import DATA

SHEET = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
#: Raw units: accelerometer 1e-4 g, gyro 0.01 °/s; suffix _1 is the right foot, _6 the left.
FEET = {"right": "_1", "left": "_6"}
G = 9.80665
#: Pressure that carries; a foot without any for so long swings; a contact is matched within so much, s.
LOADED, SWING_S, NEAR_S = 300.0, 0.2, 0.3


class Found(NamedTuple):
    """Strides of one foot: those the insole saw, those found, and how many are the same."""

    name: str
    true: int
    found: int
    both: int


def columns(path: Path) -> dict[str, Floats]:
    """The first sheet of an .xlsx by its header; an empty cell is NaN."""
    with zipfile.ZipFile(path) as book:
        words = [
            "".join(text.text or "" for text in item.iter(f"{SHEET}t"))
            for item in ElementTree.fromstring(book.read("xl/sharedStrings.xml"))
        ]
        sheet = next(name for name in book.namelist() if name.startswith("xl/worksheets/sheet1"))
        rows = [row_of(row, words) for row in ElementTree.fromstring(book.read(sheet)).iter(f"{SHEET}row")]
    names = {key: str(value).strip() for key, value in rows[0].items()}
    return {
        name: np.array([_number(row.get(key)) for row in rows[1:]], np.float64) for key, name in names.items()
    }


def row_of(row: ElementTree.Element, words: list[str]) -> dict[str, str]:
    """Column letters → text."""
    cells = {}
    for cell in row.iter(f"{SHEET}c"):
        value = cell.find(f"{SHEET}v")
        if value is not None and value.text is not None:
            text = words[int(value.text)] if cell.get("t") == "s" else value.text
            cells[re.sub(r"\d", "", cell.get("r", ""))] = text
    return cells


def _number(text: str | None) -> float:
    try:
        return float(text) if text is not None else np.nan
    except ValueError:
        return np.nan


def samples_of(table: dict[str, Floats], foot: str) -> tuple[Samples, Floats, Floats]:
    """One foot's samples, their seconds, and the larger of its two pressures.

    They stay in the sensor's axes: the filter levels any mounting.
    """
    end = FEET[foot]
    parts = [f"Acc_read_{a}{end}" for a in "xyz"] + [f"Gyro_read_{a}{end}" for a in "xyz"]
    named = {name.lower(): values for name, values in table.items()}
    time_ms = named[f"time{end}"]
    matrix = np.full((len(time_ms), 10), np.nan)
    matrix[:, 1:7] = np.column_stack([named[part.lower()] for part in parts])
    matrix[:, 1:4] *= G * 1e-4
    matrix[:, 4:7] *= np.radians(0.01)
    matrix[:, 0] = (time_ms - time_ms[0]) * 1e6
    load = np.maximum(named[f"ext1{end}"], named[f"ext2{end}"])
    good = np.isfinite(matrix[:, :7]).all(axis=1) & np.append(True, np.diff(matrix[:, 0]) > 0)
    matrix, load = matrix[good], load[good]
    samples = Samples(foot, Role(foot), 0, matrix, np.zeros(len(matrix), np.uint16))
    return samples, matrix[:, 0] * 1e-9, load


def contacts(t_s: Floats, load: Floats) -> Floats:
    """When the foot is loaded after a swing: the insole's strides, s."""
    loaded = load > LOADED
    begins = np.flatnonzero(loaded[1:] & ~loaded[:-1]) + 1
    ends = np.flatnonzero(~loaded[1:] & loaded[:-1]) + 1
    lifts = [t_s[ends[ends < begin][-1]] if np.any(ends < begin) else np.inf for begin in begins]
    swung = np.array([t_s[b] - lift >= SWING_S for b, lift in zip(begins, lifts, strict=True)], bool)
    return t_s[begins[swung]]


def matched(true_s: Floats, found_s: Floats) -> int:
    """How many of both lists, in time order, are within ``NEAR_S`` of one another, each used once."""
    both, i, j = 0, 0, 0
    while i < len(true_s) and j < len(found_s):
        if abs(true_s[i] - found_s[j]) <= NEAR_S:
            both, i, j = both + 1, i + 1, j + 1
        elif true_s[i] < found_s[j]:
            i += 1
        else:
            j += 1
    return both


def insoles(settings: Settings) -> Iterator[Found]:
    """Both feet of both recordings."""
    for path in sorted((DATA / "marpino_both_feet").glob("*.xlsx")):
        table = columns(path)
        for foot in FEET:
            samples, t_s, load = samples_of(table, foot)
            rows, tracker = store(samples), Tracker(settings)
            tracker.advance(rows)
            finish(tracker, rows)
            true_s, found_s = contacts(t_s, load), np.array([stride.end_s for stride in tracker.strides])
            yield Found(f"{path.stem} {foot}", len(true_s), len(found_s), matched(true_s, found_s))
