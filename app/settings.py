"""Heart: the settings of a track: names, units, limits, sentences, and what a profile means."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from app.limits import Limit, Limited, Value, setting
from app.motion.basics import G_MPS2


@dataclass(frozen=True)
class Settings(Limited):
    """One track's settings.

    Values are SI and radians. The defaults are the built-in profile ``papers`` (2012 paper, Table
    II; thresholds: see docs/method.md).
    """

    estimator: str = setting(
        "papers",
        Limit(
            "Estimator", "", "",
            "Which method turns samples into a walk: the papers' algorithm, or the Kalman filter, which is"
            " more exact at any gait.",
            choices=("papers", "kalman"),
        ),
    )  # fmt: skip
    gain_stance: float = setting(
        1.05,
        Limit(
            "Stance gain", "k_s", "1/s",
            "How fast gravity (and the magnetometer) pull the orientation straight while the foot"
            " stands; 0 trusts the gyro alone.",
            0.0, 50.0, (0.0, 3.0), 0.01,
            only="papers",
        ),
    )  # fmt: skip
    gain_swing: float = setting(
        0.0,
        Limit(
            "Swing gain", "k_d", "1/s",
            "The same pull while the foot swings; acceleration then disturbs gravity, so 0 is best"
            " on real walks.",
            0.0, 50.0, (0.0, 3.0), 0.01,
            only="papers",
        ),
    )  # fmt: skip
    threshold_radps: float = setting(
        1.0,
        Limit(
            "Rate threshold", "Ω_th", "rad/s",
            "Below this angular rate the foot counts as standing; too low misses stances, too high"
            " cuts swings short.",
            0.01, 20.0, (0.1, 4.0), 0.01,
        ),
    )  # fmt: skip
    min_duration_s: float = setting(
        0.06,
        Limit(
            "Minimum duration", "Γ", "s",
            "How long the rate must stay on the other side of the threshold before the phase flips;"
            " it hides short dips.",
            0.0, 1.0, (0.0, 0.3), 0.005,
        ),
    )  # fmt: skip
    zero_velocity: bool = setting(
        True,
        Limit(
            "Zero-velocity update", "", "",
            "Stop each stride's velocity where the foot stands. Off, every error it ever made stays, and"
            " position runs away.",
            only="papers",
        ),
    )  # fmt: skip
    magnetometer: bool = setting(
        False,
        Limit(
            "Magnetometer", "", "",
            "Whether the compass holds the heading; indoors iron bends it, so the gyro alone is"
            " often straighter.",
        ),
    )  # fmt: skip
    gravity_from_rest: bool = setting(
        True,
        Limit(
            "Gravity from rest", "", "",
            "Take gravity as the sensor reads it in the still start: no sensor is scaled exactly.",
        ),
    )  # fmt: skip
    gravity_mps2: float = setting(
        G_MPS2,
        Limit(
            "Gravity", "g", "m/s²",
            "The gravity to subtract when it is not taken from rest; 0.1 too much sinks each stride"
            " by centimetres.",
            8.0, 11.5, (9.5, 10.0), 0.001,
        ),
    )  # fmt: skip
    bias_from_rest: bool = setting(
        True,
        Limit(
            "Gyro bias from rest", "", "",
            "Subtract the rate the gyro shows in the still start, if it was truly still.",
        ),
    )  # fmt: skip
    still_window_s: float = setting(
        0.5,
        Limit(
            "Still start", "", "s",
            "How long the foot must stand still at the start to find level, gravity and gyro bias.",
            0.05, 10.0, (0.1, 3.0), 0.05,
        ),
    )  # fmt: skip
    start_heading_rad: float = setting(
        0.0,
        Limit(
            "Start heading", "ψ_0", "rad",
            "Turns the whole walk about the vertical: the heading at the start, or with the"
            " magnetometer, that of magnetic north.",
            -math.pi, math.pi, (-math.pi, math.pi), math.radians(1),
        ),
    )  # fmt: skip

    detector: str = setting(
        "adaptive",
        Limit(
            "Stance detector", "", "",
            "How the Kalman filter knows that the foot stands: by a threshold that follows the gait, or by"
            " a fixed one on the statistic (shoe), its rate (ared), or the papers' machine (rate).",
            choices=("adaptive", "shoe", "ared", "rate"),
            only="kalman",
        ),
    )  # fmt: skip
    gait_factor: float = setting(
        30.0,
        Limit(
            "Stance share", "", "s²/rad²",
            "Detector adaptive: how loud a stance may be beside the gait around it; too low misses stances"
            " of a runner, too high takes slow swings for stances.",
            1.0, 1000.0, (10.0, 100.0), 1.0,
            only="kalman",
        ),
    )  # fmt: skip
    still_statistic: float = setting(
        100.0,
        Limit(
            "Stance threshold", "T", "σ²",
            "Detector shoe: the statistic that a standing foot stays below; 100 suits walking, runners need"
            " ten times that.",
            1.0, 1e5, (10.0, 2000.0), 10.0,
            only="kalman",
        ),
    )  # fmt: skip
    sensor_height_m: float = setting(
        0.07,
        Limit(
            "Sensor height", "h", "m",
            "How high the sensor sits above the sole: a standing foot rolls, which moves it by h times the"
            " turn; 0 shortens the walk by about 2 %.",
            0.0, 0.3, (0.0, 0.15), 0.005,
            only="kalman",
        ),
    )  # fmt: skip
    same_floor_m: float = setting(
        0.06,
        Limit(
            "Same floor within", "", "m",
            "Footprints that differ in height by less are taken, softly, to be on one floor; stairs and ramps"
            " stay free, slopes below 2.5 % come out level; 0: never.",
            0.0, 0.3, (0.0, 0.1), 0.005,
            only="kalman",
        ),
    )  # fmt: skip
    steady_north: bool = setting(
        True,
        Limit(
            "Steady north", "", "",
            "Hold the heading by the magnetometer at footprints where its field is as strong, as steep and"
            " points as it did before; anywhere else by the gyro alone.",
            only="kalman",
        ),
    )  # fmt: skip
    gyro_range_radps: float = setting(
        0.0,
        Limit(
            "Gyro range", "", "rad/s",
            "The angular rate at which the gyro clips; 0: 8.7 rad/s (500 °/s) until faster rates were read.",
            0.0, 100.0, (0.0, 40.0), 0.1,
            only="kalman",
        ),
    )  # fmt: skip

    remembered_bias: bool = setting(
        True,
        Limit(
            "Remembered gyro bias", "", "",
            "Begin with what is remembered of this sensor's gyro bias, if anything is; a still start"
            " outweighs it.",
            only="kalman",
        ),
    )  # fmt: skip
    feet_apart_m: float = setting(
        1.0,
        Limit(
            "Feet at most apart", "d", "m",
            "Two feet: how far apart they can be when one touches down, or 0.65 of a longer stride; it keeps"
            " both walks and headings together. 0: each foot by itself.",
            0.0, 3.0, (0.0, 2.0), 0.05,
            only="kalman",
        ),
    )  # fmt: skip
    hindsight: bool = setting(
        False,
        Limit(
            "In hindsight", "", "",
            "Kalman filter: estimate each step by what came after it too, once the walk is over; a live"
            " walk runs as without.",
            only="kalman",
        ),
    )  # fmt: skip

    @property
    def looks_back(self) -> bool:
        """Whether a walk is smoothed when it is over: only the Kalman filter's can be."""
        return self.hindsight and self.estimator == "kalman"

    def differences(self, other: Settings) -> str:
        """In words, what changes from these settings to ``other``: ``gain_stance 1.05 → 2``."""
        return ", ".join(
            f"{f.name} {_short(getattr(self, f.name))} → {_short(getattr(other, f.name))}"
            for f in fields(self)
            if getattr(self, f.name) != getattr(other, f.name)
        )


LIMITS = Settings.limits()
BUILT_IN: dict[str, Settings] = {
    "papers": Settings(),
    "default": Settings(estimator="kalman"),
    "hindsight": Settings(estimator="kalman", hindsight=True),
}


def is_read(name: str, settings: Settings) -> bool:
    """Whether a setting has any effect beside the others: a slider that has none need not be shown."""
    if LIMITS[name].only not in ("", settings.estimator):
        return False
    if settings.estimator == "papers":
        return True
    detectors = {
        "gait_factor": ("adaptive",),
        "still_statistic": ("shoe",),
        "threshold_radps": ("ared", "rate"),
        "min_duration_s": ("rate",),
    }
    return settings.detector in detectors.get(name, (settings.detector,))


def parse(name: str, text: str) -> Value:
    """The value of a setting as typed on a command line (``--set gain_stance=1.2``).

    Raises ``ValueError`` that names what came and what was expected.
    """
    if name not in LIMITS:
        raise ValueError(f"unknown setting {name!r}: expected one of {', '.join(sorted(LIMITS))}")
    default = getattr(BUILT_IN["papers"], name)
    if isinstance(default, bool):
        words = {"true": True, "on": True, "yes": True, "1": True}
        words |= {"false": False, "off": False, "no": False, "0": False}
        if text.lower() not in words:
            raise ValueError(f"{name}={text!r}: expected on or off")
        return words[text.lower()]
    if isinstance(default, str):
        return text
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{name}={text!r}: expected a number in {LIMITS[name].unit or 'its unit'}") from None


def _short(value: Value) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    return str(value).lower() if isinstance(value, bool) else value
