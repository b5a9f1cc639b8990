"""Edge: one plot of a study as an SVG that takes its colours from the page, so that dark mode is free."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from html import escape
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats
from app.studies.words import Curve, Plot

WIDTH, HEIGHT = 640, 340
LEFT, RIGHT, TOP, BOTTOM = 72, 16, 12, 48
#: More points than this cannot be told apart, and would make the report large.
MOST_POINTS = 400
MARKERS, LOOKS = 5, 7


class Axis(NamedTuple):
    """From values to pixels."""

    low: float
    high: float
    start: float
    end: float
    log: bool

    def at(self, values: Floats) -> Floats:
        """Pixels of these values [n]; those a logarithm cannot show are NaN."""
        with np.errstate(divide="ignore", invalid="ignore"):
            v = np.log10(values) if self.log else values
        v = np.where(np.isfinite(v), v, np.nan)
        return self.start + (v - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self) -> list[tuple[float, str]]:
        """Pixels and texts of some round values."""
        values = _decades(self.low, self.high) if self.log else _round_values(self.low, self.high)
        shown = [10.0**v for v in values] if self.log else values
        pixels = self.at(np.array(shown, dtype=np.float64)).tolist()
        return [(p, f"{v:.6g}".replace("-", "−")) for p, v in zip(pixels, shown, strict=True)]


def chart(plot: Plot) -> str:
    """The whole plot: axes with units, curves, a legend in words and shapes."""
    x, y = _axes(plot)
    marks = "".join(_curve(_look(i, curve), curve, x, y) for i, curve in enumerate(plot.curves))
    return (
        f"<figure><figcaption>{escape(plot.title)}</figcaption>{_legend(plot.curves)}"
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(plot.title)}">'
        f"{_frame(plot, x, y)}{marks}</svg>"
        + (f"<p class=note>{escape(plot.note)}</p>" if plot.note else "")
        + "</figure>"
    )


def _look(place: int, curve: Curve) -> int:
    return place if curve.look is None else curve.look


def _axes(plot: Plot) -> tuple[Axis, Axis]:
    x_low, x_high = _span([c.x for c in plot.curves], plot.log_x, margin=0.02)
    tall = [c.y + s * c.spread for c in plot.curves if c.spread is not None for s in (-1.0, 1.0)]
    y_low, y_high = _span([c.y for c in plot.curves] + tall, plot.log_y, margin=0.06)
    if plot.equal and not (plot.log_x or plot.log_y):
        x_low, x_high, y_low, y_high = _same_scale(x_low, x_high, y_low, y_high)
    return (
        Axis(x_low, x_high, LEFT, WIDTH - RIGHT, plot.log_x),
        Axis(y_low, y_high, HEIGHT - BOTTOM, TOP, plot.log_y),
    )


def _span(values: Sequence[Floats], log: bool, margin: float) -> tuple[float, float]:
    every = np.concatenate([np.ravel(v) for v in values]) if values else np.zeros(1)
    every = every[np.isfinite(every) & ((every > 0.0) | (not log))]
    if log:
        every = np.log10(every)
    if not len(every):
        return 0.0, 1.0
    low, high = float(every.min()), float(every.max())
    room = margin * (high - low) or max(abs(high), 1.0) * 0.05
    return low - room, high + room


def _same_scale(x0: float, x1: float, y0: float, y1: float) -> tuple[float, float, float, float]:
    wide, high = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM
    unit = max((x1 - x0) / wide, (y1 - y0) / high)
    dx, dy = 0.5 * unit * wide, 0.5 * unit * high
    xm, ym = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    return xm - dx, xm + dx, ym - dy, ym + dy


def _round_values(low: float, high: float) -> list[float]:
    rough = (high - low) / 5.0
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(s * power for s in (1.0, 2.0, 5.0, 10.0) if s * power >= rough)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [k * step for k in range(first, last + 1)]


def _decades(low: float, high: float) -> list[float]:
    """Logarithms of the ticks: 1, 2, 5 where there are few decades, else some powers of ten."""
    whole = range(math.floor(low), math.ceil(high) + 1)
    if high - low < 3.0:
        fine = [k + math.log10(m) for k in whole for m in (1, 2, 5)]
        return [v for v in fine if low <= v <= high]
    every = math.ceil((high - low) / 8.0)
    return [float(k) for k in whole if low <= k <= high and k % every == 0]


def _frame(plot: Plot, x: Axis, y: Axis) -> str:
    lines = [
        f'<path class=grid d="M{p:.1f} {TOP}V{HEIGHT - BOTTOM}"/>'
        f'<text x="{p:.1f}" y="{HEIGHT - BOTTOM + 16}" class=mid>{t}</text>'
        for p, t in x.ticks()
    ]
    lines += [
        f'<path class=grid d="M{LEFT} {p:.1f}H{WIDTH - RIGHT}"/>'
        f'<text x="{LEFT - 6}" y="{p + 4:.1f}" class=end>{t}</text>'
        for p, t in y.ticks()
    ]
    middle = 0.5 * (TOP + HEIGHT - BOTTOM)
    return "".join(lines) + (
        f'<text x="{0.5 * (LEFT + WIDTH - RIGHT)}" y="{HEIGHT - 8}" class="mid axis">'
        f"{escape(plot.x_label)}</text>"
        f'<text transform="translate(14 {middle}) rotate(-90)" class="mid axis">{escape(plot.y_label)}</text>'
    )


def _curve(number: int, curve: Curve, x: Axis, y: Axis) -> str:
    every = max(1, math.ceil(len(curve.x) / MOST_POINTS))
    px, py = x.at(curve.x[::every]), y.at(curve.y[::every])
    body = "" if curve.spread is None else _band(curve, every, x, y)
    if curve.dots:
        body += "".join(_marker(number, a, b) for a, b in _shown(px, py))
    else:
        body += f'<path class=line d="{_path(px, py)}"/>'
    return f'<g class="c{number % LOOKS}"><title>{escape(curve.label)}</title>{body}</g>'


def _band(curve: Curve, every: int, x: Axis, y: Axis) -> str:
    assert curve.spread is not None
    px = x.at(curve.x[::every])
    upper, lower = (y.at((curve.y + s * curve.spread)[::every]) for s in (1.0, -1.0))
    around = _path(np.concatenate([px, px[::-1]]), np.concatenate([upper, lower[::-1]]))
    return f'<path class=band d="{around}Z"/>'


def _shown(px: Floats, py: Floats) -> list[tuple[float, float]]:
    seen = np.isfinite(px) & np.isfinite(py)
    return list(zip(px[seen].tolist(), py[seen].tolist(), strict=True))


def _path(px: Floats, py: Floats) -> str:
    return "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in _shown(px, py))


def _marker(number: int, a: float, b: float) -> str:
    """A shape of its own for every curve: nobody needs to tell colours apart."""
    shapes: tuple[Callable[[], str], ...] = (
        lambda: f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3"/>',
        lambda: f'<path d="M{a - 3:.1f} {b - 3:.1f}h6v6h-6z"/>',
        lambda: f'<path d="M{a:.1f} {b - 4:.1f}l4 7h-8z"/>',
        lambda: f'<path class=cross d="M{a - 3:.1f} {b - 3:.1f}l6 6m0 -6l-6 6"/>',
        lambda: f'<path d="M{a:.1f} {b - 4:.1f}l4 4l-4 4l-4 -4z"/>',
    )
    return shapes[number % MARKERS]()


def _legend(curves: Sequence[Curve]) -> str:
    def key(number: int, curve: Curve) -> str:
        mark = _marker(number, 9.0, 6.0) if curve.dots else '<path class=line d="M0 6H18"/>'
        return (
            f'<li class="c{number % LOOKS}"><svg width="18" height="12" aria-hidden="true">{mark}</svg>'
            f"{escape(curve.label)}</li>"
        )

    if len(curves) < 2:
        return ""
    return "<ul class=legend>" + "".join(key(_look(i, c), c) for i, c in enumerate(curves)) + "</ul>"
