"""Heart: what a calibration is: a null and a scale for force, rate and field, and how a sample is corrected.

true = scale · (read − null), in the axes in which the samples come. ``scale`` is a matrix: its diagonal is
the scale of each axis, the rest turns the sensor's axes square.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.motion.basics import Floats, InputError, Vector
from app.motion.samples import Sample

Matrix = tuple[Vector, Vector, Vector]
ONE: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
ZERO: Vector = (0.0, 0.0, 0.0)
VERSION = 1
UNITS = {"force": "m/s²", "rate": "rad/s", "field": "µT"}
#: No honest calibration is further off: a file that says so is not one.
MOST = {"force": 20.0, "rate": 2.0, "field": 500.0}
SCALES = (0.2, 5.0)


@dataclass(frozen=True)
class Correction:
    """Of one kind of reading."""

    null: Vector = ZERO
    scale: Matrix = ONE

    def apply(self, read: Vector) -> Vector:
        """The true reading."""
        a, b, c = read[0] - self.null[0], read[1] - self.null[1], read[2] - self.null[2]
        x, y, z = self.scale
        return (
            x[0] * a + x[1] * b + x[2] * c,
            y[0] * a + y[1] * b + y[2] * c,
            z[0] * a + z[1] * b + z[2] * c,
        )

    def table(self, read: Floats) -> Floats:
        """Readings [n, 3] made true."""
        return np.asarray((read - np.array(self.null)) @ np.array(self.scale).T)


@dataclass(frozen=True)
class Calibration:
    """One sensor's, as it is kept."""

    sensor: str  # its serial number, or what else names it
    made: str  # date and time, ISO 8601
    method: str  # of the fits: "fit" or "report"
    force: Correction = Correction()
    rate: Correction = Correction()
    field: Correction | None = None  # None: no magnetometer, or it was left as it is
    residuals: Mapping[str, float] = dataclasses.field(default_factory=dict)  # name with unit → value

    def apply(self, sample: Sample) -> Sample:
        """A sample, corrected."""
        field_b = sample.field_b
        if field_b is not None and self.field is not None:
            field_b = self.field.apply(field_b)
        return sample._replace(
            specific_force_b=self.force.apply(sample.specific_force_b),
            angular_rate_b=self.rate.apply(sample.angular_rate_b),
            field_b=field_b,
        )


def correction(null: Floats, scale: Floats) -> Correction:
    """From arrays [3] and [3] (a diagonal) or [3, 3]."""
    matrix = np.diag(scale) if scale.ndim == 1 else scale
    a, b, c = (_vector(row) for row in matrix.tolist())
    return Correction(_vector(null.tolist()), (a, b, c))


def _vector(values: list[float]) -> Vector:
    x, y, z = values
    return (float(x), float(y), float(z))


def to_json(calibration: Calibration) -> str:
    """As it is kept: for a person to read, with units."""
    kinds: dict[str, object] = {}
    for name, unit in UNITS.items():
        kind: Correction | None = getattr(calibration, name)
        if kind is not None:
            kinds[name] = {"unit": unit, "null": kind.null, "scale": kind.scale}
    told = {
        "stridescope_calibration": VERSION,
        "sensor": calibration.sensor,
        "made": calibration.made,
        "method": calibration.method,
        "meaning": "true = scale * (read - null), in the axes in which the samples come",
        **kinds,
        "residuals": dict(calibration.residuals),
    }
    return json.dumps(told, indent=2, ensure_ascii=False) + "\n"


def from_json(name: str, text: str) -> Calibration:
    """What ``to_json`` wrote; anything else is ``InputError``."""
    try:
        told = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"calibration {name}: not JSON: {error}") from None
    if not isinstance(told, dict) or told.get("stridescope_calibration") != VERSION:
        raise InputError(f"calibration {name}: expected a calibration of ours, version {VERSION}")
    sensor, made, method = (told.get(key) for key in ("sensor", "made", "method"))
    if not all(isinstance(word, str) and len(word) <= 200 for word in (sensor, made, method)):
        raise InputError(f"calibration {name}: expected sensor, made and method as texts")
    kinds = {kind: _correction(name, kind, told[kind]) for kind in UNITS if told.get(kind) is not None}
    return Calibration(
        str(sensor),
        str(made),
        str(method),
        force=kinds.get("force", Correction()),
        rate=kinds.get("rate", Correction()),
        field=kinds.get("field"),
        residuals=_residuals(told.get("residuals")),
    )


def _correction(name: str, kind: str, told: object) -> Correction:
    try:
        told = told if isinstance(told, dict) else {}
        null, scale = np.array(told["null"], float), np.array(told["scale"], float)
        diagonal = np.diag(scale)
        good = null.shape == (3,) and scale.shape == (3, 3) and told.get("unit") == UNITS[kind]
        good = good and bool(np.isfinite(null).all() and np.isfinite(scale).all())
        good = good and bool(np.abs(null).max() <= MOST[kind] and np.abs(scale).max() <= SCALES[1])
        good = good and bool(diagonal.min() >= SCALES[0])
    except (KeyError, TypeError, ValueError, OverflowError):
        good = False
    if not good:
        raise InputError(
            f"calibration {name}: {kind}: expected its unit {UNITS[kind]}, a null of three plausible numbers "
            "and a scale of three by three"
        )
    return correction(null, scale)


def _residuals(told: object) -> dict[str, float]:
    if not isinstance(told, dict):
        return {}
    return {
        str(key)[:60]: float(value)
        for key, value in told.items()
        if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    }
