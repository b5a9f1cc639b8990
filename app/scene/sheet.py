"""Edge, scene: what is seen as one page to hand in: the scene to turn about, and a sheet beside it.

The sheet has the lesson, the figures, plots and every setting with its unit. The page asks no network.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import NamedTuple

from app.limits import Limit, Value
from app.motion.snapshot import Snapshot
from app.motion.status import Status
from app.scene import figures, swinging, words
from app.scene.head import style
from app.scene.lab import notice
from app.scene.share import film
from app.settings import LIMITS, Settings
from app.simulate import lab

LAYOUT = Path(__file__).with_name("sheet.css")


class Sheet(NamedTuple):
    """What others made for it: plots as figures, their style, and what else to tell."""

    plots: str
    style: str
    about: Mapping[str, str]
    dark: bool


def page(snapshot: Snapshot, status: Status, sheet: Sheet) -> str:
    """The whole file."""
    styles = style() + sheet.style + LAYOUT.read_text("utf-8")
    beside = f"<style>{styles}</style>{_sheet(snapshot, status, sheet)}"
    with film(status.source.name, 1.0, sheet.dark) as made:
        made.show(snapshot)
        return made.page(beside)


def _sheet(snapshot: Snapshot, status: Status, sheet: Sheet) -> str:
    name = words.plain(status.lesson or "Lab")
    pairs = dict(sheet.about) | _seed(status)
    about = "".join(f"<tr><th>{key}</th><td>{words.plain(text)}</td></tr>" for key, text in pairs.items())
    return (
        f'<main id="sheet"><h1>{name}</h1>{notice(status.lesson)}{swinging.cards(snapshot)}{sheet.plots}'
        f"{_errors(status.errors or {})}{_settings(snapshot.main.settings)}"
        f"<h2>Changes to the estimator</h2>{figures.log(snapshot, status.source.rate_hz)}"
        f'<h2>This walk</h2><table class="ss-table">{about}</table></main>'
    )


def _seed(status: Status) -> dict[str, str]:
    seed = status.source.seed
    return {} if seed is None else {"Seed": f"{seed}, of the simulator's noise and of the sensor's errors"}


def _errors(errors: Mapping[str, float]) -> str:
    if not errors:
        return ""
    rows = "".join(_row(lab.LIMITS[n], value, getattr(lab.PERFECT, n)) for n, value in errors.items())
    note = '<div class="ss-note">As they were set when this was saved; bold: not a perfect sensor\'s.</div>'
    return f'<h2>The sensor\'s errors</h2>{note}<table class="ss-table ss-values">{rows}</table>'


def _settings(settings: Settings) -> str:
    usual = Settings()
    rows = "".join(
        _row(LIMITS[f.name], getattr(settings, f.name), getattr(usual, f.name)) for f in fields(Settings)
    )
    note = '<div class="ss-note">Of the walk as shown; bold: not as in the papers.</div>'
    return f'<h2>The estimator\'s settings</h2>{note}<table class="ss-table ss-values">{rows}</table>'


def _row(limit: Limit, value: Value, usual: Value) -> str:
    changed = ' class="changed"' if value != usual else ""
    symbol = f" {limit.symbol}" if limit.symbol else ""
    return f"<tr{changed}><td>{limit.label}{symbol}</td><td>{_told(limit, value)}</td></tr>"


def _told(limit: Limit, value: Value) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, str):
        return words.plain(value)
    k, unit = (math.degrees(1.0), "°") if limit.unit == "rad" else (1.0, limit.unit)
    return f"{value * k:.6g} {unit}".strip().replace("-", "−")
