"""Heart: the results of a calibration as lines of text, the fits beside the report's formulas."""

from __future__ import annotations

from app.calibration.words import UNITS, Calibration, Correction

NOT_TOLD = f"{'not told':17}"


def table(fit: Calibration, report: Calibration) -> list[str]:
    """Null and scale of each axis by both methods, with units, and what the fits leave over."""
    lines = ["axis    fit: null ×scale  | report: null ×scale"]
    for kind, unit in UNITS.items():
        one, other = getattr(fit, kind), getattr(report, kind)
        if one is None:
            lines.append(f"{kind}: no magnetometer")
            continue
        lines += [f"{kind} {'xyz'[i]} {_cell(one, i)} | {_cell(other, i)} {unit}" for i in range(3)]
    return lines + [f"{name}: {value:.2g}" for name, value in fit.residuals.items()]


def _cell(correction: Correction | None, axis: int) -> str:
    if correction is None:
        return NOT_TOLD
    return f"{correction.null[axis]:+8.4f} ×{correction.scale[axis][axis]:.5f}"
