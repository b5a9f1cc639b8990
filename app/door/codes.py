"""Door: an address as a QR code for a phone's camera, or words in its place: as SVG. Pure."""

from __future__ import annotations

import io
from html import escape

import segno

QUIET = 4  # modules around the code, as cameras need


def picture(address: str) -> str:
    """The code, dark on white whatever the page's colours."""
    out = io.BytesIO()
    segno.make(address, error="m", micro=False).save(
        out, kind="svg", border=QUIET, dark="#000", light="#fff", xmldecl=False, omitsize=True
    )
    return out.getvalue().decode()


def words(*lines: str) -> str:
    """A picture of words."""
    style = "font:13px system-ui,sans-serif;fill:#8a94a3"
    rows = "".join(f'<text x="0" y="{18 + 20 * i}">{escape(line)}</text>' for i, line in enumerate(lines))
    size = f'viewBox="0 0 400 {12 + 20 * len(lines)}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} style="{style}">{rows}</svg>'
