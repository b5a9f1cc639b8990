"""Heart: the lab: a simulated sensor's errors, which may change while it walks, and lessons made of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from app.limits import Limit, Limited, Value, setting
from app.motion.basics import G_MPS2, InputError, Vector
from app.motion.commands import SetErrors
from app.motion.samples import Sample
from app.settings import Settings
from app.simulate.sensors import TABLE_II_NOISE


@dataclass(frozen=True)
class LabErrors(Limited):
    """What is wrong with the sensor. The defaults are a perfect one."""

    force_bias_mps2: float = setting(
        0.0,
        Limit(
            "Accelerometer bias", "", "m/s²",
            "Added to all three axes: it tilts what counts as level and bends every stride a little.",
            -2.0, 2.0, (-0.5, 0.5), 0.01,
        ),
    )  # fmt: skip
    rate_bias_dps: float = setting(
        0.0,
        Limit(
            "Gyro bias", "", "°/s",
            "Added to all three axes: the heading turns with it, and level too where no gain holds it.",
            -10.0, 10.0, (-2.0, 2.0), 0.05,
        ),
    )  # fmt: skip
    noise: float = setting(
        0.0,
        Limit(
            "Noise", "", "× Table II",
            "Random errors of all axes, in multiples of the papers' sensor (Table II, 2012).",
            0.0, 100.0, (0.0, 20.0), 0.5,
        ),
    )  # fmt: skip
    range_g: float = setting(
        20.0,
        Limit(
            "Accelerometer range", "", "g",
            "Readings are cut off here; heel strikes reach 5 g, and what is missing is missed in the stride.",
            1.0, 100.0, (1.5, 20.0), 0.1,
        ),
    )  # fmt: skip
    lost_percent: float = setting(
        0.0,
        Limit(
            "Lost samples", "", "%",
            "As many never arrive; the steps between those that do are longer and less exact.",
            0.0, 90.0, (0.0, 50.0), 1.0,
        ),
    )  # fmt: skip
    field_bias_ut: float = setting(
        0.0,
        Limit(
            "Magnetic disturbance", "", "µT",
            "Iron at the shoe, on its right: it bends a heading that the magnetometer holds. The earth's"
            " field is about 50 µT.",
            -200.0, 200.0, (-60.0, 60.0), 1.0,
        ),
    )  # fmt: skip


LIMITS = LabErrors.limits()
PERFECT = LabErrors()


class Lab:
    """Spoils samples. The same samples and errors in the same order give the same readings."""

    def __init__(self, seed: int = 0) -> None:
        self.errors = PERFECT
        self._random = np.random.default_rng(seed)

    def spoil(self, sample: Sample) -> Sample | None:
        """The sample as a sensor with these errors reads it; None: it is lost."""
        e = self.errors
        if e == PERFECT:
            return sample
        if e.lost_percent and 100.0 * self._random.random() < e.lost_percent:
            return None
        noise = self._random.standard_normal((3, 3)) * e.noise if e.noise else np.zeros((3, 3))
        limit = e.range_g * G_MPS2
        force = _off(sample.specific_force_b, e.force_bias_mps2, TABLE_II_NOISE[0] * noise[0])
        rate = _off(sample.angular_rate_b, math.radians(e.rate_bias_dps), TABLE_II_NOISE[1] * noise[1])
        return sample._replace(
            specific_force_b=_clipped(force, limit),
            angular_rate_b=rate,
            field_b=self._field(sample.field_b, noise[2]),
            saturation=sample.saturation | sum(1 << i for i, f in enumerate(force) if abs(f) >= limit),
        )

    def _field(self, field_b: Vector | None, noise: Any) -> Vector | None:
        if field_b is None:
            return None
        x, y, z = _off(field_b, 0.0, TABLE_II_NOISE[2] * noise)
        return (x, y + self.errors.field_bias_ut, z)


def _off(v: Vector, bias: float, noise: Any) -> Vector:
    return (v[0] + bias + float(noise[0]), v[1] + bias + float(noise[1]), v[2] + bias + float(noise[2]))


def _clipped(v: Vector, limit: float) -> Vector:
    return (max(-limit, min(limit, v[0])), max(-limit, min(limit, v[1])), max(-limit, min(limit, v[2])))


class Lesson(NamedTuple):
    """What to set, and two sentences on what to notice."""

    name: str
    errors: LabErrors
    changes: Mapping[str, Value]  # to the settings of ``papers``
    notice: str

    @property
    def settings(self) -> Settings:
        """The estimator's settings of this lesson."""
        return Settings().with_changes(self.changes)


LESSONS = (
    Lesson(
        "Perfect", PERFECT, {},
        "The estimate lies on the truth; what error remains is what sampling costs. Watch the dashed stride"
        " snap into place when the foot stands.",
    ),
    Lesson(
        "Gyro bias", LabErrors(rate_bias_dps=0.5), {"bias_from_rest": False},
        "The walk bends: nothing but the gyro knows the heading, it turns half a degree every second, and"
        " what it shows at rest is not taken off here. Stride lengths stay right, because each one begins"
        " anew from zero velocity.",
    ),
    Lesson(
        "Gain to zero", LabErrors(rate_bias_dps=0.5),
        {"gain_stance": 0.0, "gain_swing": 0.0, "bias_from_rest": False},
        "Without feedback nothing holds level: gravity leaks into the acceleration and the height runs off."
        " Raise the stance gain and see it come back within a few strides.",
    ),
    Lesson(
        "ZUPT off", LabErrors(force_bias_mps2=0.02), {"zero_velocity": False},
        "Velocity keeps every error it ever had, so position runs away as ½·b·t²: look at the speed graph"
        " while the foot stands. Switch the zero-velocity update on again and each stride is whole.",
    ),
    Lesson(
        "Noise", LabErrors(noise=10.0), {},
        "Ten times the papers' noise: the graphs shiver, yet the walk hardly suffers, because noise averages"
        " out over a stride. Compare with a bias, which never does.",
    ),
    Lesson(
        "Saturation", LabErrors(range_g=2.0), {},
        "Whatever exceeds 2 g is cut off, and the missing push shortens or lifts the stride."
        " The health line counts the saturated samples.",
    ),
    Lesson(
        "Lost samples", LabErrors(lost_percent=30.0), {},
        "Nearly a third never arrives: the integration takes longer steps, and the light turns red."
        " The walk survives single losses; long gaps would begin a new segment.",
    ),
    Lesson(
        "Magnet", LabErrors(field_bias_ut=20.0), {"magnetometer": True},
        "The compass holds the heading now, and iron at the shoe bends it: the error depends on which way"
        " you walk. Switch the magnetometer off and the heading comes from the gyro alone.",
    ),
)  # fmt: skip


def lesson(name: str) -> tuple[SetErrors, Settings]:
    """What to give the sensor and the estimator; a name that is none is ``InputError``."""
    for one in LESSONS:
        if one.name == name:
            return SetErrors(tuple((key, getattr(one.errors, key)) for key in LIMITS)), one.settings
    raise InputError(f"lesson {name!r}: expected one of {', '.join(x.name for x in LESSONS)}")


def pendulum(angle_deg: float) -> str:
    """The SPEC of a pendulum let go from this angle."""
    return f"sim:pendulum?start_deg={angle_deg:g}"
