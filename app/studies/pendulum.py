"""Heart: the study `pendulum`: the complementary filter on a pendulum of known motion (III-E to III-I)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from app.motion.basics import Floats, Quaternion, Vector
from app.rotation import from_yaw_pitch_roll
from app.simulate.pendulum import Pendulum, read, swing
from app.studies.filters import roll_pitch_yaw_deg, run_filter
from app.studies.verdicts import Judge
from app.studies.words import Curve, Done, Plot, Row, Study, Task

ROLL, PITCH, YAW = 0, 1, 2
_EULER = "Euler's method, as Fig. 29 has it; the app's own step, exact within a sample, errs less at k = 50"
_START = "the filter starts from the true pose: at release the accelerometer reads along the rod"
_PITCH_45 = (
    "the filter of Fig. 29 on (3.62) and (3.73)–(3.75) is 2.5° off in the first swings at k = 1 (2.8° by"
    " the exact step); 1° is kept only once the swing has decayed"
)
_MEASURED = (
    "measured on a real pendulum that was never published; ours is simulated, with the same sensor class"
)


@dataclass(frozen=True)
class Config:
    """``euler``: as printed; off shows the app's own step. The bias is 0.033 % of 300 °/s on every axis."""

    rate_hz: float = 50.0
    duration_s: float = 20.0
    start_deg: float = 10.0
    damping: float = 0.313
    heavy_damping: float = 5.95
    gyro_bias_dps: float = 0.099
    euler: bool = True
    real_noise_mps2: float = 0.0325
    real_noise_radps: float = 0.0077
    real_noise_gauss: float = 0.8212e-3
    seed: int = 50

    @property
    def bias(self) -> Vector:
        """The gyro's, rad/s."""
        return (math.radians(self.gyro_bias_dps),) * 3

    @property
    def times(self) -> Floats:
        """Every sample's, s."""
        return np.arange(round(self.duration_s * self.rate_hz) + 1) / self.rate_hz

    @property
    def start(self) -> Quaternion:
        """The true pose at release."""
        return from_yaw_pitch_roll(0.0, math.radians(self.start_deg), 0.0)


@dataclass(frozen=True)
class Case:
    """One run of the filter."""

    gain: float
    biased: bool = True
    heavy: bool = False
    motion: bool = True  # whether the accelerometer feels the swing


FIGURES = {
    "Fig. 38: k = 0, perfect sensors": Case(0.0, biased=False),
    "Fig. 39: k = 0, gyro bias": Case(0.0),
    "Fig. 41: k = 50, gyro bias": Case(50.0),
    "Fig. 42: k = 50, without what the swing adds": Case(50.0, motion=False),
    "Fig. 44: k = 50, heavy damping": Case(50.0, heavy=True),
    "Fig. 45 (and 8): k = 1, gyro bias": Case(1.0),
}


def tasks(config: Config) -> Sequence[Task]:
    """None: it takes milliseconds once compiled."""
    return ()


def angles(config: Config, case: Case) -> tuple[Floats, Floats]:
    """What the filter says and what is true, roll–pitch–yaw [n, 3] in degrees."""
    pendulum = Pendulum(
        damping=config.heavy_damping if case.heavy else config.damping, start_deg=config.start_deg
    )
    truth = swing(pendulum, config.duration_s)
    bias = config.bias if case.biased else (0.0, 0.0, 0.0)
    samples = read(pendulum, truth, config.times, gyro_bias_radps=bias, motion=case.motion)
    found = roll_pitch_yaw_deg(run_filter(samples, case.gain, config.start, euler=config.euler))
    true = np.zeros_like(found)
    true[:, PITCH] = np.degrees(truth(config.times).angle)
    return found, true


def conclude(config: Config, done: Sequence[Done]) -> Study:
    """Figs. 37–45 and 50, eqs. (3.45), (3.47) and (3.61)."""
    judge = Judge("pendulum")
    found = {name: angles(config, case) for name, case in FIGURES.items()}
    gains, rms = rms_by_gain(config)
    rows = [*_figure_rows(judge, config, found), *_response_rows(judge, config), *_law_rows(judge, config)]
    best = float(gains[int(np.argmin(rms))])
    rows.append(judge.no_data("Fig. 50: gain of the least RMS error", "0.15", best, "1/s", _MEASURED))
    plots = [_figure(name, config, *pair) for name, pair in found.items()]
    return Study(
        "pendulum",
        "The filter on a pendulum",
        "A damped pendulum of 1 m is released at 10° and solved by SciPy; a sensor at its end reads (3.73) to"
        " (3.75). The complementary filter turns the readings into angles, with more and with less trust in"
        " gravity.",
        asdict(config),
        tuple(rows),
        (*plots, _fig_50(gains, rms), *_law_plots(config)),
    )


def _figure_rows(judge: Judge, config: Config, found: dict[str, tuple[Floats, Floats]]) -> list[Row]:
    def error(name: str) -> Floats:
        return next(np.abs(a - b) for figure, (a, b) in found.items() if figure.startswith(name))

    late = config.times >= 0.5 * config.duration_s
    rows = []
    for figure, printed, text in (
        ("Fig. 41", "0.002", "k = 50"),
        ("Fig. 45", "0.1", "k = 1 (2012 paper, Fig. 8)"),
    ):
        for axis, name in ((ROLL, "roll"), (YAW, "yaw")):
            got = float(np.median(error(figure)[late, axis]))
            rows.append(judge.digits(f"{figure}, {text}, {name} error", printed, got, "deg", needs=_EULER))
    for seconds, printed in ((1, "< 2"), (2, "< 0.2")):
        got = float(error("Fig. 44")[round(seconds * config.rate_hz), PITCH])
        rows.append(
            judge.bound(
                f"Fig. 44, heavy damping, pitch error at {seconds} s", printed, got, "deg", needs=_START
            )
        )
    rows.append(
        judge.bound(
            "Fig. 45, k = 1, pitch error at most", "< 1", float(error("Fig. 45")[:, PITCH].max()), "deg",
            why=_PITCH_45,
        )
    )  # fmt: skip
    return rows


def _response_rows(judge: Judge, config: Config) -> list[Row]:
    """Fig. 40: how the two branches of the filter share a pendulum's frequency, (3.29) and (3.33)."""
    p = Pendulum(damping=config.damping)
    omega = math.sqrt(p.gravity_mps2 / p.length_m - (p.damping / (2.0 * p.mass_kg * p.length_m)) ** 2)
    dynamic, static = omega / math.hypot(omega, 50.0), 50.0 / math.hypot(omega, 50.0)
    return [
        judge.digits("III-H: the pendulum's frequency", "3.128", omega, "rad/s"),
        judge.bound("Fig. 40, k = 50: dynamic branch there", "< -20", 20 * math.log10(dynamic), "dB"),
        judge.bound(
            "Fig. 40, k = 50: static over dynamic branch, power", "> 100", (static / dynamic) ** 2, "×"
        ),
    ]


def _still(config: Config, seconds: float, gyro: Vector, force: Vector) -> Floats:
    """A sensor that hangs at rest, with these biases."""
    t = np.arange(round(seconds * config.rate_hz) + 1) / config.rate_hz
    hanging = Pendulum(start_deg=0.0)
    return read(hanging, swing(hanging, seconds), t, gyro_bias_radps=gyro, force_bias_mps2=force)


def law_error(
    config: Config, gain: float, gyro_dps: float, force_mps2: float, seconds: float
) -> tuple[Floats, Floats]:
    """The pitch error that grows from a bias on a sensor at rest: measured, and by the laws; degrees."""
    gyro = (0.0, math.radians(gyro_dps), 0.0)
    samples = _still(config, seconds, gyro, (force_mps2, 0.0, 0.0))
    level = (1.0, 0.0, 0.0, 0.0)
    measured = roll_pitch_yaw_deg(run_filter(samples, gain, level, euler=config.euler))[:, PITCH]
    t = samples[:, 0] * 1e-9
    tilt_deg = math.degrees(math.asin(force_mps2 / math.hypot(force_mps2, Pendulum().gravity_mps2)))
    settled = 1.0 - np.exp(-gain * t)
    law = (gyro_dps / gain * settled if gain else gyro_dps * t) + tilt_deg * settled
    return measured, law


#: name, gain, gyro bias °/s, accelerometer bias m/s², seconds: each law at one instant.
LAWS = (
    ("(3.45), gyro bias 0.099 °/s, k = 1", 1.0, 0.099, 0.0, 5.0),
    ("(3.45), gyro bias 0.099 °/s, k = 0.15", 0.15, 0.099, 0.0, 20.0),
    ("(3.47), gyro bias 0.099 °/s, k = 0", 0.0, 0.099, 0.0, 20.0),
    ("(3.61), accelerometer bias 0.0981 m/s², k = 1", 1.0, 0.0, 0.0981, 5.0),
    ("(3.61), accelerometer bias 0.0981 m/s², k = 50", 50.0, 0.0, 0.0981, 1.0),
)


def _law_rows(judge: Judge, config: Config) -> list[Row]:
    rows = []
    for name, gain, gyro, force, seconds in LAWS:
        measured, law = law_error(config, gain, gyro, force, seconds)
        item = f"{name}: pitch error after {seconds:g} s"
        rows.append(
            judge.digits(item, f"{law[-1]:.2g}", float(measured[-1]), "deg", needs="“printed”: the law")
        )
    return rows


def _law_plots(config: Config) -> list[Plot]:
    plots = []
    for title, chosen in (
        ("Eqs. (3.45), (3.47): error by a gyro bias", LAWS[:3]),
        ("Eq. (3.61): error by an accelerometer bias", LAWS[3:]),
    ):
        curves = []
        for name, gain, gyro, force, seconds in chosen:
            measured, law = law_error(config, gain, gyro, force, seconds)
            t = np.arange(len(law)) / config.rate_hz
            short = name.rpartition(", ")[2]
            curves.append(Curve(f"{short}, law", t, law))
            curves.append(Curve(f"{short}, measured", t[::25], measured[::25], dots=True))
        note = (
            "A gain caps what a gyro's bias does, at bias/k; what an accelerometer's does it cannot change."
        )
        plots.append(Plot(title, "time, s", "pitch error, deg", tuple(curves), note))
    return plots


def rms_by_gain(config: Config) -> tuple[Floats, Floats]:
    """Gains from 0 to 1, and the RMS angle error of a pendulum read by a noisy, biased sensor, degrees."""
    pendulum = Pendulum(damping=config.damping, start_deg=config.start_deg)
    truth = swing(pendulum, config.duration_s)
    samples = read(pendulum, truth, config.times, gyro_bias_radps=config.bias)
    noise = np.random.default_rng(config.seed).standard_normal((len(samples), 9))
    noise *= np.repeat([config.real_noise_mps2, config.real_noise_radps, 100.0 * config.real_noise_gauss], 3)
    samples[:, 1:] += noise
    gains = np.linspace(0.0, 1.0, 41)
    true = np.zeros((len(samples), 3))
    true[:, PITCH] = np.degrees(truth(config.times).angle)
    rms = [
        np.sqrt(
            np.mean(
                (roll_pitch_yaw_deg(run_filter(samples, k, config.start, euler=config.euler)) - true) ** 2
            )
        )
        for k in gains.tolist()
    ]
    return gains, np.array(rms)


def _fig_50(gains: Floats, rms: Floats) -> Plot:
    note = "Too small a gain lets the gyro's bias run; too large a one believes the swing to be gravity."
    return Plot("Fig. 50: RMS error by gain", "gain k, 1/s", "RMS error, deg", (Curve("", gains, rms),), note)


def _figure(name: str, config: Config, found: Floats, true: Floats) -> Plot:
    t = config.times
    curves = (
        Curve("true pitch", t, true[:, PITCH]),
        Curve("pitch", t, found[:, PITCH]),
        Curve("roll", t, found[:, ROLL]),
        Curve("yaw", t, found[:, YAW]),
    )
    return Plot(name, "time, s", "angle, deg", curves)
