"""Edge: the studies as one HTML page that needs nothing else: no script, no network."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from html import escape
from itertools import groupby, zip_longest

from app.outputs.chart import chart
from app.outputs.chart_style import DARK, LIGHT, RULES
from app.studies.words import Row, Study, Table, Verdict

_STYLE = f""":root{{color-scheme:light dark;{LIGHT}}}
@media(prefers-color-scheme:dark){{:root{{{DARK}}}}}{RULES}"""
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_PAGE = """
body{margin:0 auto;max-width:76rem;padding:1.5rem;background:var(--paper);color:var(--ink);
font:15px/1.5 system-ui,sans-serif}
h1{font-size:1.5rem}h2{font-size:1.2rem;margin-top:2.5rem;border-top:1px solid var(--line);padding-top:1rem}
p,dl{max-width:60rem}a{color:var(--c0)}
table{border-collapse:collapse;margin:1rem 0;font-variant-numeric:tabular-nums}
th,td{padding:.25rem .7rem;text-align:left;border-bottom:1px solid var(--line);vertical-align:top}
th{color:var(--soft);font-weight:600}th.n,td.n{text-align:right;white-space:nowrap}
.wide{overflow-x:auto}.why{color:var(--soft);max-width:30rem;font-size:.9em}
.v{white-space:nowrap}.v::before{margin-right:.4em}
.reproduced::before{content:"✓";color:var(--c2)}.close::before{content:"≈";color:var(--c4)}
.not-reproduced::before{content:"✗";color:var(--c1)}.no-data::before{content:"–";color:var(--soft)}
.plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,30rem),1fr));gap:1.2rem}
summary{cursor:pointer;color:var(--soft)}code{font-size:.9em}
"""


def report(studies: Sequence[Study], about: Mapping[str, str]) -> str:
    """The page. ``about`` are words and figures of the run itself: version, seconds, machine."""
    rows = [row for study in studies for row in study.rows]
    body = "".join(_section(study) for study in studies)
    return (
        "<!doctype html><html lang=en><meta charset=utf-8>"
        '<meta name=viewport content="width=device-width,initial-scale=1">'
        f"<title>Stridescope: the papers’ studies</title><style>{_STYLE}{_PAGE}</style>"
        f"<h1>The papers’ studies</h1><p>{escape(_in_words(rows))}</p>{_contents(studies)}{body}"
        f"<h2>This run</h2>{_pairs(about)}</html>"
    )


def _in_words(rows: Sequence[Row]) -> str:
    counts = Counter(row.verdict for row in rows)
    told = ", ".join(f"{counts[verdict]} {verdict}" for verdict in Verdict if counts[verdict])
    return (
        f"{len(rows)} printed figures: {told}. Reproduced: equal to the printed digits, within the printed"
        " bound, or, where chance has a part, no further off than three standard errors (two for a spread)."
        " Close: not that, but near, and the reason is given. No data:"
        " printed from measurements that were never published; ours is a simulation's, compared in shape."
    )


def _contents(studies: Sequence[Study]) -> str:
    head = "".join(f"<th>{verdict}</th>" for verdict in Verdict)
    lines = []
    for study in studies:
        counts = Counter(row.verdict for row in study.rows)
        cells = "".join(f"<td class=n>{counts[verdict] or ''}</td>" for verdict in Verdict)
        link = f'<a href="#{escape(study.name)}">{escape(study.name)}</a>'
        lines.append(f"<tr><td>{link}</td><td>{escape(study.title)}</td>{cells}</tr>")
    return f"<table><tr><th>study</th><th></th>{head}</tr>{''.join(lines)}</table>"


def _section(study: Study) -> str:
    plots = "".join(chart(plot) for plot in study.plots)
    return (
        f'<section id="{escape(study.name)}"><h2>{escape(study.title)}</h2><p>{escape(study.about)}</p>'
        f"<div class=plots>{plots}</div>{''.join(_table(table) for table in study.tables)}"
        f"{_rows(study.rows)}"
        f"<details><summary>Configuration and seed</summary>{_pairs(study.config)}</details></section>"
    )


def _rows(rows: Sequence[Row]) -> str:
    head = (
        "<tr><th>printed figure</th><th class=n>printed</th><th class=n>got</th><th></th><th>verdict</th>"
        "<th>why, or what it took</th></tr>"
    )
    lines = ""
    for why, together in groupby(rows, key=lambda row: row.why or row.needs):
        same = list(together)
        said = f'<td class=why rowspan="{len(same)}">{escape(why)}</td>'
        lines += "".join(_row(row, said if k == 0 else "") for k, row in enumerate(same))
    return f"<div class=wide><table>{head}{lines}</table></div>" if rows else ""


def _row(row: Row, said: str) -> str:
    return (
        f"<tr><td>{escape(row.item)}</td><td class=n>{escape(_minus(row.printed_as))}</td>"
        f"<td class=n>{number_beside(row.printed_as, row.got)}</td><td>{escape(row.unit)}</td>"
        f'<td class="v {row.verdict.replace(" ", "-")}">{row.verdict}</td>{said}</tr>'
    )


def _table(table: Table) -> str:
    numbers = [not isinstance(value, str) for value in table.lines[0]] if table.lines else []
    head = "".join(
        f"<th class=n>{escape(text)}</th>" if n else f"<th>{escape(text)}</th>"
        for text, n in zip_longest(table.head, numbers)
    )
    lines = "".join(f"<tr>{''.join(_cell(value) for value in line)}</tr>" for line in table.lines)
    return f"<h3>{escape(table.title)}</h3><div class=wide><table><tr>{head}</tr>{lines}</table></div>"


def _cell(value: str | float) -> str:
    if isinstance(value, str):
        return f"<td class=n>{value}</td>" if value == "–" else f"<td>{escape(value)}</td>"
    return f"<td class=n>{number(value)}</td>"


def _pairs(pairs: Mapping[str, object]) -> str:
    lines = "".join(
        f"<tr><td><code>{escape(key)}</code></td><td>{escape(_text(value))}</td></tr>"
        for key, value in pairs.items()
    )
    return f"<table>{lines}</table>"


def _text(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=str)


def number(value: float) -> str:
    """Four digits, more where they stand before the point."""
    return _minus(f"{value:.4g}" if abs(value) < 1e4 else f"{value:.0f}")


def number_beside(printed: str, value: float) -> str:
    """With no fewer decimals than the printed figure, so that the two can be read side by side."""
    decimals = len(printed.partition(".")[2])
    shown = len(f"{value:.4g}".partition(".")[2])
    exponents = "e" in printed.lower() + f"{value:.4g}"
    return number(value) if exponents or shown >= decimals else _minus(f"{value:.{decimals}f}")


def _minus(text: str) -> str:
    mantissa, e, exponent = text.partition("e")
    power = f" × 10{str(int(exponent)).translate(_RAISED)}" if e else ""
    return mantissa.replace("-", "−") + power
