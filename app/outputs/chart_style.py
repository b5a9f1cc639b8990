"""Edge: how charts look: colours for a light and a dark page, dashes and shapes beside them."""

from __future__ import annotations

LIGHT = (
    "--ink:#1d2733;--soft:#5a6675;--paper:#fff;--line:#dde3ea;--card:#f6f8fa;--c0:#0072b2;--c1:#d55e00;"
    "--c2:#009e73;--c3:#a8518a;--c4:#b07d00;--c5:#3a8fc4;--c6:#4a4a4a"
)
DARK = (
    "--ink:#e4e9ef;--soft:#9aa7b5;--paper:#14191f;--line:#303a45;--card:#1b222a;--c0:#56b4e9;--c1:#f0904a;"
    "--c2:#2fc79b;--c3:#dd95c0;--c4:#e6b93c;--c5:#8fcdf5;--c6:#c4c4c4"
)
#: Curves differ by their dashes too, so that nobody needs to tell colours apart.
_DASHES = ("none", "7 3", "2 3", "9 3 2 3", "4 2", "1 3 6 3", "12 4")
_CURVES = "".join(
    f".c{i} path,.c{i} circle{{fill:var(--c{i});stroke:var(--c{i})}}"
    f".c{i} .line{{fill:none;stroke-dasharray:{dash}}}"
    for i, dash in enumerate(_DASHES)
)
#: For a page that sets the colours above.
RULES = f"""
figure{{margin:0;padding:.8rem;background:var(--card);border:1px solid var(--line);border-radius:.5rem}}
figcaption{{font-weight:600}}figure .note{{color:var(--soft);margin:.3rem 0 0;font-size:.9em}}
.legend{{list-style:none;display:flex;flex-wrap:wrap;gap:.1rem 1rem;padding:0;margin:.3rem 0;font-size:.85em}}
.legend svg{{margin-right:.4em;vertical-align:middle}}
figure svg text{{fill:var(--soft);font-size:12px}}.mid{{text-anchor:middle}}.end{{text-anchor:end}}
figure svg .axis{{fill:var(--ink);font-size:13px}}figure .grid{{stroke:var(--line);fill:none}}
figure .line{{fill:none;stroke-width:1.8;stroke-linejoin:round}}.cross{{stroke-width:1.8}}
.band{{opacity:.2;stroke:none}}{_CURVES}
"""


def style(dark: bool) -> str:
    """For a page that is dark or light for good."""
    return f":root{{{DARK if dark else LIGHT}}}{RULES}"
