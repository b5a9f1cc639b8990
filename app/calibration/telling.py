"""Heart: the results of a calibration as lines of text, the fits beside the report's formulas."""

from __future__ import annotations

from app.calibration.words import UNITS, Calibration


def table(fit: Calibration, report: Calibration) -> list[str]:
    """Both, side by side, for a person: null and scale of each axis with units."""
    lines = [f"{'':14}{'fit':>34}{'report, eq. (1) to (5)':>34}"]
    for kind, unit in UNITS.items():
        one, other = getattr(fit, kind), getattr(report, kind)
        if one is None:
            lines.append(f"{kind}: no magnetometer")
            continue
        for i, axis in enumerate("xyz"):
            cells = [
                f"null {c.null[i]:+9.4f} {unit:5} scale {c.scale[i][i]:8.5f}" if c else "not told"
                for c in (one, other)
            ]
            lines.append(f"{kind + ' ' + axis:10}{cells[0]:>38}{cells[1]:>38}")
    lines += [f"  {name}: {value:.2g}" for name, value in fit.residuals.items()]
    return lines
