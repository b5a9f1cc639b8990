"""Edge, scene: numbers with their units, and other people's words made harmless."""

from __future__ import annotations

import html
import math

DASH = "–"
LONGEST = 240


def plain(text: str, longest: int = LONGEST) -> str:
    """A user's text for HTML: markup shown as typed, control characters gone, cut to a length.

    File names, profile names and a file's own sentences come from outside; the page is HTML.
    """
    seen = "".join(c if c.isprintable() else " " for c in text).strip()
    return html.escape(seen if len(seen) <= longest else seen[: longest - 1] + "…", quote=True)


def number(value: float | None, digits: int = 2) -> str:
    """With a fixed count of digits; a dash for what is not known or not finite."""
    if value is None or not math.isfinite(value):
        return DASH
    text = f"{value:,.{digits}f}".replace(",", "\u2009")
    return text.replace("-", "−") if float(f"{value:.{digits}f}") != 0 else text.replace("-", "")


def signed(value: float, digits: int = 2) -> str:
    """With its sign: ``+0.12`` or ``−0.12``; zero has none."""
    text = number(value, digits)
    return "+" + text if math.isfinite(value) and value > 0 and float(f"{value:.{digits}f}") != 0 else text


def metres(value: float) -> tuple[str, str]:
    """A distance as (number, unit): 0.12 m, 45.7 m, 1.204 km."""
    if math.isfinite(value) and abs(value) >= 1000:
        return number(value / 1000, 3), "km"
    return number(value, 2 if abs(value) < 100 else 1), "m"


def clock(seconds: float) -> str:
    """``7.4 s``, ``1:35``, ``1:02:03``."""
    if not math.isfinite(seconds):
        return DASH
    if seconds < 60:
        return f"{max(seconds, 0.0):.1f} s"
    whole = int(seconds)
    hours, minutes = whole // 3600, whole // 60 % 60
    return f"{hours}:{minutes:02d}:{whole % 60:02d}" if hours else f"{minutes}:{whole % 60:02d}"


def megabytes(count: int) -> str:
    """Bytes for a person."""
    return f"{count / 1e6:.0f} MB" if count >= 1e6 else f"{count / 1e3:.0f} kB"


def percent(part: float, whole: float) -> str:
    """``1.2 %``; a dash while the whole is nothing."""
    return f"{number(100 * part / whole, 1)} %" if whole > 0 and math.isfinite(part / whole) else DASH


def counts(reasons: dict[str, int]) -> str:
    """``5 (3 repeated stamp, 2 time went backward)``, harmless; ``0`` for none."""
    total = sum(reasons.values())
    listed = ", ".join(f"{n} {plain(why, 60)}" for why, n in sorted(reasons.items()) if n)
    return f"{total} ({listed})" if listed else str(total)
