"""Heart: `sim:calibration`: a sensor with errors, led through the 2001 report's Appendix B.

Still on each side, the turns between, one round about y with x to the north, one about x with y to the north.
Every turn is about one axis of the sensor with a smooth angle, so orientation and rate are formulas.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from app.motion.basics import G_MPS2, Floats, InputError, Role
from app.motion.recording import Recording
from app.motion.samples import Samples
from app.simulate.sensors import FIELD_N_UT, TABLE_II_NOISE

#: Appendix B's turns: axis (0 x, 1 y, 2 z) and degrees; 0 is a pause.
TURNS = (
    (0, 90.0), (0, -180.0), (2, 90.0), (2, -180.0), (1, -90.0), (1, 180.0),
    (2, 90.0), (1, 360.0), (2, -90.0), (0, 360.0), (2, 90.0),
)  # fmt: skip
LIMITS = {
    "seed": (0.0, 2.0**31), "rate_hz": (20.0, 2000.0), "first_s": (0.5, 600.0), "still_s": (0.5, 60.0),
    "turn_s": (0.2, 60.0), "noise": (0.0, 1000.0), "sloppy_deg": (0.0, 20.0), "skew": (0.0, 0.1),
    "magnetometer": (0.0, 1.0),
}  # fmt: skip
_ROUND_S = 3.0  # a whole round takes so many times a turn


@dataclass(frozen=True)
class CalibrationOptions:
    """What `sim:calibration` can be asked for; the errors themselves come from the seed."""

    seed: float = 0.0
    rate_hz: float = 100.0
    first_s: float = 20.0  # flat at the beginning: a port is found meanwhile, and somebody presses Start
    still_s: float = 4.0
    turn_s: float = 1.5
    noise: float = 1.0  # in multiples of Table II of the 2012 paper
    sloppy_deg: float = 0.0  # how badly the turns are made
    skew: float = 0.0  # how far the axes are from square, 0.01 is 0.6°
    magnetometer: float = 1.0


@dataclass(frozen=True)
class Errors:
    """Of one kind: read = true / scale + null, axis by axis, or with a matrix."""

    null: Floats  # [3]
    scale: Floats  # [3, 3]

    def read(self, true: Floats) -> Floats:
        """What the sensor reads of true values [n, 3], but for noise."""
        return np.asarray(true @ np.linalg.inv(self.scale).T + self.null)


@dataclass(frozen=True)
class Calibrating:
    """The recording, and the errors that a calibration should find."""

    recording: Recording
    force: Errors
    rate: Errors
    field: Errors


def make_calibration(texts: Mapping[str, str]) -> Calibrating:
    """The recording a SPEC's options ask for; ``InputError`` says what is known."""
    options = _parse(texts)
    random = np.random.default_rng(int(options.seed))
    force, rate, field = (
        Errors(random.uniform(-null, null, 3), _scale(random, scale, options.skew))
        for null, scale in ((0.3, 0.02), (0.03, 0.02), (15.0, 0.05))
    )
    t_s, turned, rates = _motion(options, random)
    down = np.array([0.0, 0.0, -G_MPS2])
    readings = [
        force.read(np.einsum("nji,j->ni", turned, down)),
        rate.read(rates),
        field.read(np.einsum("nji,j->ni", turned, np.array(FIELD_N_UT))),
    ]
    for values, sigma in zip(readings, TABLE_II_NOISE, strict=True):
        values += random.normal(0.0, 1.0, values.shape) * sigma * options.noise
    if not options.magnetometer:
        readings[2][:] = math.nan
    matrix = np.column_stack([np.rint(t_s * 1e9), *readings])
    samples = Samples("foot", Role.FOOT, 0, matrix, np.zeros(len(matrix), np.uint16))
    serials = {"foot": f"SIM-{int(options.seed)}"}  # the errors are the seed's: it names the sensor
    recording = Recording("sim:calibration", "simulator", (samples,), serials=serials)
    return Calibrating(recording, force, rate, field)


def _scale(random: np.random.Generator, spread: float, skew: float) -> Floats:
    """A symmetric matrix near one: what lengths alone can tell."""
    aside = np.triu(random.uniform(-skew, skew, (3, 3)), 1)
    return np.asarray(np.diag(random.uniform(1.0 - spread, 1.0 + spread, 3)) + aside + aside.T)


def _motion(options: CalibrationOptions, random: np.random.Generator) -> tuple[Floats, Floats, Floats]:
    """Times [n], rotations from body to room [n, 3, 3] and rates [n, 3]."""
    step = 1.0 / options.rate_hz
    start = np.eye(3)
    poses: list[Floats] = []
    rates: list[Floats] = []
    for axis, degrees in ((0, 0.0), *TURNS):
        slip = random.normal(0.0, options.sloppy_deg) if degrees else 0.0
        about = np.eye(3)[axis] + np.radians(random.normal(0.0, options.sloppy_deg, 3))
        about /= np.linalg.norm(about)
        length_s = options.turn_s * (_ROUND_S if abs(degrees) == 360.0 else 1.0)
        s = np.arange(0.0, 1.0, step / length_s) if degrees else np.zeros(0)
        angle = np.radians(degrees + slip)
        angles = angle * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        speeds = angle * 30.0 * s**2 * (1.0 - s) ** 2 / length_s
        still = round((options.still_s if poses else options.first_s) * options.rate_hz)
        angles, speeds = np.append(angles, np.full(still, angle)), np.append(speeds, np.zeros(still))
        poses.append(start @ _about(about, angles))
        rates.append(speeds[:, np.newaxis] * about)
        start = poses[-1][-1]
    turned = np.concatenate(poses)
    times = np.arange(len(turned), dtype=np.float64) * step
    return times, turned, np.asarray(np.concatenate(rates))


def _about(axis: Floats, angles: Floats) -> Floats:
    """Rotations [n, 3, 3] about one axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    a = angles[:, np.newaxis, np.newaxis]
    return np.asarray(np.eye(3) + np.sin(a) * cross + (1.0 - np.cos(a)) * (cross @ cross))


def _parse(texts: Mapping[str, str]) -> CalibrationOptions:
    known = {f.name: f.name for f in fields(CalibrationOptions)} | {"rate": "rate_hz"}
    known |= {"first": "first_s", "still": "still_s", "turn": "turn_s"}
    values: dict[str, float] = {}
    for key, text in texts.items():
        if key not in known:
            raise InputError(f"sim:calibration: unknown option {key!r}: expected one of {', '.join(known)}")
        try:
            values[known[key]] = float({"on": "1", "off": "0"}.get(text, text))
        except ValueError:
            raise InputError(f"sim:calibration: {key}={text!r}: expected a number") from None
    options = CalibrationOptions(**values)
    for key, (low, high) in LIMITS.items():
        if not low <= getattr(options, key) <= high:
            raise InputError(
                f"sim:calibration: {key}={getattr(options, key):g}: expected {low:g} to {high:g}"
            )
    return options
