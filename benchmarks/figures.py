"""Benchmarks: one measured figure beside the one wanted, and the table of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

Section = Iterator["Figure"]


class Figure(NamedTuple):
    """What was measured. ``got`` None: there was nothing to measure, and ``note`` says why."""

    what: str
    got: float | None
    unit: str = ""
    wanted: float | None = None
    at_least: bool = False  # wanted is a floor, not a ceiling
    note: str = ""

    @property
    def verdict(self) -> str:
        """``ok``, ``MISSED``, ``no data``, or nothing where no figure is wanted."""
        if self.got is None:
            return "no data"
        if self.wanted is None:
            return ""
        good = self.got >= self.wanted if self.at_least else self.got <= self.wanted
        return "ok" if good else "MISSED"

    def cells(self) -> tuple[str, str, str, str, str]:
        """As it stands in the table: what, wanted, got, verdict, note."""
        wanted = "" if self.wanted is None else f"{'≥' if self.at_least else '≤'} {number(self.wanted)}"
        got = "" if self.got is None else f"{number(self.got)} {self.unit}".rstrip()
        return (self.what, wanted, got, self.verdict, self.note)


def number(value: float) -> str:
    """Three significant digits; whole numbers whole."""
    if value == round(value) and abs(value) < 1e6:
        return f"{value:.0f}"
    if abs(value) >= 1e6:
        return f"{value / 1e6:.3g} million"
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:#.3g}"


def table(section: str, figures: Iterable[Figure]) -> list[str]:
    """The lines of one section."""
    rows = [(section, "wanted", "got", "", ""), *(figure.cells() for figure in figures)]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, [*widths, 0], strict=True)).rstrip()
        for row in rows
    ]
    return [lines[0], "─" * len(lines[0]), *lines[1:], ""]
