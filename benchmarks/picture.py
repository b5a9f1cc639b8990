"""Benchmarks: the accuracy of every profile and peer as one picture, SVG, made of the figures measured."""

from __future__ import annotations

import math
from collections.abc import Iterable
from html import escape

from benchmarks.figures import Figure, number

SETS = {"Vicon room": "#0072b2", "corridor": "#e69f00"}
SPREADS = {"RMSE / path, median": "median", "RMSE / path, worst": "worst"}
#: Per cent of the path: the ends of the logarithmic axis, and its lines.
LEAST, MOST, TICKS = 0.1, 100.0, (0.1, 1.0, 10.0, 100.0)
WIDTH, LEFT, RIGHT, TOP, BAR = 760, 190, 70, 62, 16


def drawn(figures: Iterable[Figure]) -> str:
    """A pair of bars for each estimator: median error of each set of walks, its worst as a dot."""
    got = {figure.what: figure.got for figure in figures if figure.got is not None}
    names = list(dict.fromkeys(what.partition(":")[0] for what in got if what.endswith(tuple(SPREADS))))
    names = [name for name in names if f"{name}: corridor: RMSE / path, median" in got]
    height = TOP + len(names) * (len(SETS) * BAR + 14) + 24
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" '
        f'viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" font-size="12">',
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        _text(12, 20, "Error to the truth, per cent of the path: bar the median recording, dot the worst"),
    ]
    for i, (name, colour) in enumerate(SETS.items()):
        parts.append(f'<rect x="{12 + 110 * i}" y="30" width="12" height="12" fill="{colour}"/>')
        parts.append(_text(30 + 110 * i, 40, name))
    for tick in TICKS:
        parts.append(f'<path d="M{_x(tick):.1f} {TOP - 6}V{height - 20}" stroke="#cccccc"/>')
        parts.append(_text(_x(tick) - 12, height - 6, f"{tick:g} %"))
    y = float(TOP)
    for name in names:
        parts.append(_text(12, y + BAR + 4, name))
        for walks, colour in SETS.items():
            median, worst = (got.get(f"{name}: {walks}: {spread}") for spread in SPREADS)
            if median is not None and worst is not None:
                parts += _bar(y, median, worst, colour)
            y += BAR
        y += 14
    return "\n".join([*parts, "</svg>", ""])


def _bar(y: float, median: float, worst: float, colour: str) -> list[str]:
    end, middle = _x(median), y + 0.5 * BAR
    return [
        f'<rect x="{LEFT}" y="{y + 1:.1f}" width="{end - LEFT:.1f}" height="{BAR - 2}" fill="{colour}"/>',
        f'<circle cx="{_x(worst):.1f}" cy="{middle:.1f}" r="4" fill="#ffffff" stroke="{colour}" '
        'stroke-width="2"/>',
        _text(_x(worst) + 8, middle + 4, f"{number(median)}, {number(worst)}"),
    ]


def _x(percent: float) -> float:
    share = math.log(min(max(percent, LEAST * 1.05), MOST) / LEAST) / math.log(MOST / LEAST)
    return LEFT + share * (WIDTH - LEFT - RIGHT)


def _text(x: float, y: float, text: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="#222222">{escape(text)}</text>'
