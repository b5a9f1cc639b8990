"""Heart: the study `gait`: are all steps found, and does a slide on a table have its length (II-C, II-D)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid

from app.compiled import kernel
from app.estimator.gait import STANCE, SWING, gait_phase
from app.estimator.strapdown import bias_of_swing
from app.motion.basics import Floats
from app.motion.samples import Column
from app.simulate.gait import minimum_jerk
from app.simulate.options import WalkOptions
from app.simulate.walk import simulate
from app.studies.verdicts import Judge
from app.studies.words import Curve, Done, Plot, Row, Study, Table, Task

STEPS = (286, 293, 289, 290, 291)  # Table 3
CADENCES_SPM = (70.0, 90.0, 110.0, 130.0, 150.0, 170.0)
THRESHOLDS = np.array([0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5])
#: stride in m, lift in m, cadence in steps a minute: people, made up.
WALKERS = {
    "short steps": (0.9, 0.07, 118.0),
    "average": (1.2, 0.10, 110.0),
    "long steps": (1.5, 0.13, 112.0),
    "shuffling": (0.7, 0.03, 96.0),
    "hurrying": (1.6, 0.15, 150.0),
}
AVERAGE = list(WALKERS).index("average")
_TRACK = "counted on walks that were never published; ours are simulated, with the same number of steps"
_TABLE_TOP = "measured with a sensor of unknown bias; ours is simulated with one of 0.1 m/s²"
_NO_RESET = (
    "the printed pseudo-code never sets γ back: once past its count every single sample over or under the"
    " threshold flips the phase (the rate of the papers' own foot has no such samples); counting consecutive"
    " ones, as ours does, finds every step"
)


@dataclass(frozen=True)
class Config:
    """``count``: γ's threshold in samples, as Fig. 12 has it, 3 at 50 Hz; ours says the same in seconds."""

    rate_hz: float = 50.0
    threshold_radps: float = 1.0
    count: int = 3
    noise: float = 1.0
    slide_bias_mps2: float = 0.0981
    seed: int = 3


class Count(NamedTuple):
    """Steps of one walk: true, and found with and without setting γ back, by threshold [n]."""

    true: int
    reset: Floats
    literal: Floats


@kernel
def count_steps(statistic: Floats, threshold: float, min_duration_s: float, dt_s: float) -> int:
    """Transitions 4 of our machine: γ counts consecutive samples."""
    phase, contrary, steps = STANCE, 0.0, 0
    for i in range(statistic.shape[0]):
        before = phase
        phase, contrary = gait_phase(phase, contrary, statistic[i], threshold, min_duration_s, dt_s)
        if before == SWING and phase == STANCE:
            steps += 1
    return steps


@kernel
def count_literally(statistic: Floats, threshold: float, count: int) -> int:
    """Fig. 12 to the letter: γ is only ever raised."""
    swinging, gamma, steps = False, 0, 0
    for i in range(statistic.shape[0]):
        contrary = statistic[i] <= threshold if swinging else statistic[i] >= threshold
        if not contrary:
            continue
        if gamma > count:
            swinging = not swinging
            steps += 0 if swinging else 1
        else:
            gamma += 1
    return steps


def count_walk(config: Config, options: WalkOptions) -> Count:
    """One walk's steps by every threshold."""
    walk = simulate(options)
    matrix = walk.recording.sensors[0].matrix
    statistic = np.linalg.norm(matrix[:, Column.WX : Column.WZ + 1], axis=1)
    dt_s = 1.0 / options.rate_hz
    span_s = config.count / config.rate_hz
    every = [*THRESHOLDS.tolist(), config.threshold_radps]
    return Count(
        walk.feet["foot"].strides,
        np.array([count_steps(statistic, t, span_s, dt_s) for t in every], dtype=np.float64),
        np.array([count_literally(statistic, t, config.count) for t in every], dtype=np.float64),
    )


def _walks(config: Config) -> list[WalkOptions]:
    """Table 3's five; one for each cadence, for each walker; the papers' foot."""
    rate, noise, seed = config.rate_hz, config.noise, config.seed
    table = [
        WalkOptions(
            strides=n, cadence_spm=104.0 + 3 * k, stride_m=1.5, rate_hz=rate, noise=noise, seed=seed + k
        )
        for k, n in enumerate(STEPS)
    ]
    speeds = [
        WalkOptions(strides=100, cadence_spm=spm, rate_hz=rate, noise=noise, seed=seed)
        for spm in CADENCES_SPM
    ]
    people = [
        WalkOptions(
            strides=100, stride_m=m, lift_m=lift, cadence_spm=spm, rate_hz=rate, noise=noise, seed=seed
        )
        for m, lift, spm in WALKERS.values()
    ]
    return [*table, *speeds, *people, WalkOptions(model="papers", strides=100, rate_hz=rate, seed=seed)]


def tasks(config: Config) -> Sequence[Task]:
    """One for each walk."""
    return [Task(count_walk, (config, options)) for options in _walks(config)]


def conclude(config: Config, done: Sequence[Done]) -> Study:
    """Table 2, Table 3, Fig. 12."""
    judge = Judge("gait")
    counts = [d.value for d in done]
    five, rest = counts[: len(STEPS)], counts[len(STEPS) :]
    speeds, people, papers = rest[: len(CADENCES_SPM)], rest[len(CADENCES_SPM) : -1], rest[-1]
    return Study(
        "gait",
        "Finding steps",
        "Stance turns to swing once γ has counted enough samples with |ω|, the angular rate, above the"
        " threshold Ω_th, and back (Fig. 12). As the papers print it γ is never set back; ours counts"
        " consecutive samples. Both over speeds, thresholds and walkers, on a smooth simulated foot; and"
        " slides of 1 to 3 m along a table, which show what the zero-velocity update is worth.",
        asdict(config),
        (*_table_3(judge, five), *_literal(judge, papers, people[AVERAGE]), *_table_2(judge, config)),
        (_speed_plot(speeds, literal=False), _speed_plot(speeds, literal=True), _walker_plot(people),
         _slide_plot(config)),
        (_speed_table(speeds), ),
    )  # fmt: skip


def _table_3(judge: Judge, counts: Sequence[Count]) -> list[Row]:
    return [
        judge.no_data(f"Table 3, walk {k}, steps found", str(n), float(count.reset[-1]), "steps", _TRACK)
        for k, (n, count) in enumerate(zip(STEPS, counts, strict=True), start=1)
    ]


def _literal(judge: Judge, papers: Count, average: Count) -> list[Row]:
    rows = []
    for foot, count in (("the papers' foot", papers), ("a smooth foot", average)):
        for how, found in (("γ set back", count.reset), ("to the letter", count.literal)):
            item = f"Fig. 12, {how}: steps found in 100 of {foot}"
            rows.append(judge.digits(item, "100", float(found[-1]), "steps", why=_NO_RESET))
    return rows


# --- Table 2: slides along a table -------------------------------------------------------------------


class Slide(NamedTuple):
    """One slide: seconds [n]; velocity as integrated and corrected [n]; and where both end, m."""

    t_s: Floats
    raw_mps: Floats
    corrected_mps: Floats
    raw_m: float
    corrected_m: float


def slide(config: Config, distance_m: float, seed: int) -> Slide:
    """At rest for 6 s, 2 s along the table, at rest for 7 s; the sensor's bias has some sign and size."""
    generator = np.random.default_rng([config.seed, seed])
    t = np.arange(round(15.0 * config.rate_hz) + 1) / config.rate_hz
    _, _, bend = minimum_jerk((t - 6.0) / 2.0)
    bias = config.slide_bias_mps2 * generator.uniform(-1.0, 1.0)
    measured = distance_m * bend / 4.0 + bias + 0.033 * config.noise * generator.standard_normal(len(t))
    raw = cumulative_trapezoid(measured, t, initial=0)
    moving = (t >= 6.0) & (t <= 8.0)
    corrected = np.zeros_like(raw)
    inside = cumulative_trapezoid(measured[moving], t[moving], initial=0)
    epsilon = bias_of_swing((float(inside[-1]), 0.0, 0.0), 2.0)[0]  # (2.3)
    corrected[moving] = inside - epsilon * (t[moving] - t[moving][0])  # (2.4)
    return Slide(t, raw, corrected, float(np.trapezoid(raw, t)), float(np.trapezoid(corrected, t)))


_TABLE_2 = ((1, "12.44", "1.00"), (2, "-1.45", "2.01"), (3, "-2.57", "2.99"))


def _table_2(judge: Judge, config: Config) -> list[Row]:
    rows = []
    for metres, raw, corrected in _TABLE_2:
        made = slide(config, float(metres), metres)
        rows.append(judge.no_data(f"Table 2, {metres} m, uncorrected", raw, made.raw_m, "m", _TABLE_TOP))
        rows.append(
            judge.no_data(f"Table 2, {metres} m, corrected", corrected, made.corrected_m, "m", _TABLE_TOP)
        )
    return rows


def _slide_plot(config: Config) -> Plot:
    made = slide(config, 1.0, 1)
    curves = (
        Curve("integrated", made.t_s, made.raw_mps),
        Curve("zero-velocity update", made.t_s, made.corrected_mps),
    )
    raw = f"{made.raw_m:.2f}".replace("-", "−")
    note = (
        f"One metre along a table: {raw} m as integrated, {made.corrected_m:.3f} m once the"
        " velocity is known to be zero before and after."
    )
    return Plot("Figs. 8, 9: the velocity of a slide", "time, s", "velocity, m/s", curves, note)


# --- speeds, thresholds, walkers ---------------------------------------------------------------------


def _speed_plot(speeds: Sequence[Count], *, literal: bool) -> Plot:
    curves = tuple(
        Curve(f"{spm:g} steps/min", THRESHOLDS, (c.literal if literal else c.reset)[:-1])
        for spm, c in zip(CADENCES_SPM, speeds, strict=True)
    )
    what = "γ never set back, as printed" if literal else "γ set back"
    note = (
        "100 is right. Where |ω| dips below the threshold for so long that γ is full, one swing counts as"
        " two or three: the slower the foot, the lower the threshold that does it."
    )
    return Plot(
        f"Steps found in 100: {what}", "threshold Ω_th, rad/s", "steps found", curves, "" if literal else note
    )


def _walker_plot(counts: Sequence[Count]) -> Plot:
    curves = tuple(
        Curve(name, THRESHOLDS, count.reset[:-1]) for name, count in zip(WALKERS, counts, strict=True)
    )
    people = "; ".join(f"{name} {m:g} m at {spm:g} steps/min" for name, (m, _, spm) in WALKERS.items())
    good = THRESHOLDS[np.all([c.reset[:-1] == c.true for c in counts], axis=0)]
    note = f"Strides: {people}. Every step of them all is found from {good.min():g} to {good.max():g} rad/s."
    return Plot("Steps found in 100, by walker", "threshold Ω_th, rad/s", "steps found", curves, note)


def _speed_table(speeds: Sequence[Count]) -> Table:
    lines = [
        (f"{spm:g} steps/min", count.reset[-1].item(), count.literal[-1].item())
        for spm, count in zip(CADENCES_SPM, speeds, strict=True)
    ]
    head = ("cadence", "γ set back", "as printed")
    return Table("Steps found in 100 at Ω_th = 1 rad/s", head, tuple(lines))
