"""Door: what is printed once when it opens: the addresses, and their pictures for a phone's camera. Pure."""

from __future__ import annotations

import io

import segno

BESIDE = "   "


def greeting(operate: str, watch: str | None, *, reachable: bool) -> list[str]:
    """The lines to print: whom each address is for, and as QR codes where a phone could reach them."""
    lines = [f"Stridescope is at {operate}  (Ctrl-C ends it)"]
    if watch:
        lines.append(f"To watch only:     {watch}")
    if not reachable:
        return lines
    codes = [qr_lines(address) for address in (operate, watch) if address]
    return lines + beside(["to operate", "to watch only"][: len(codes)], codes)


def qr_lines(address: str) -> list[str]:
    """A QR code in half blocks, two rows a line, for a terminal with a dark ground."""
    out = io.StringIO()
    segno.make(address, error="l", micro=False).terminal(out, border=2, compact=True)
    return out.getvalue().rstrip("\n").split("\n")


def beside(titles: list[str], blocks: list[list[str]]) -> list[str]:
    """Blocks of text side by side, each under its title."""
    widths = [max(map(len, block)) for block in blocks]
    rows = [
        titles,
        *([block[i] if i < len(block) else "" for block in blocks] for i in range(max(map(len, blocks)))),
    ]
    return [
        BESIDE.join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
