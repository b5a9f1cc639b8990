"""The results in words: every axis by both methods, with units, narrow enough for the panel."""

from __future__ import annotations

from app.calibration.telling import table
from app.calibration.words import Calibration, Correction

FIT = Calibration("s", "now", "fit", Correction((0.1, -0.2, 12.3)), residuals={"force rms m/s²": 0.00123})
FULL = Calibration("s", "now", "fit", field=Correction((-12.0, 3.0, 4.0)))


def test_each_axis_has_null_and_scale_by_both() -> None:
    lines = table(FIT, Calibration("s", "now", "report"))
    assert lines[1] == "force x  +0.1000 ×1.00000 |  +0.0000 ×1.00000 m/s²"
    assert "field: no magnetometer" in lines
    assert lines[-1] == "force rms m/s²: 0.0012"
    assert max(map(len, lines)) <= 60


def test_what_the_formulas_cannot_tell_is_said() -> None:
    assert any("not told" in line and "µT" in line for line in table(FULL, FIT))
