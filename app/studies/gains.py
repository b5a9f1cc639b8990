"""Heart: the study `gains`: one gain or two, and which (dissertation IV-F, IV-G; 2012 paper IV-B)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import NamedTuple

import numpy as np

from app.estimator.sweep import sweep
from app.estimator.tracker import store, track
from app.motion.basics import Floats
from app.motion.estimate import POSITION
from app.motion.samples import Samples
from app.settings import Settings
from app.simulate.options import WalkOptions
from app.simulate.walk import simulate
from app.studies.monte_carlo import WalkConfig, ideal, walk_many
from app.studies.verdicts import Judge
from app.studies.words import Curve, Done, Plot, Row, Study, Table, Task

#: Fig. 91's grid, and a wider one that shows where its flat valley ends.
GAINS_STANCE = np.linspace(0.6, 1.6, 21)
GAINS_SWING = np.array([0.0, 0.005, 0.01, 0.015, 0.02])
WIDE_STANCE = np.concatenate([[0.0, 0.05], np.linspace(0.1, 4.0, 40)])
CONSTANT = (0.01, 0.15, 1.0, 5.0)  # Fig. 14 of the 2012 paper
_TRACK = (
    "walks around a running track that were never published; ours are simulated, with the same sensor class"
)
_FLAT = "the valley is flat: over the whole of Fig. 92 the simulated error changes by some centimetres"
_CONSTANT = (
    "with a gain in the swing gravity is sought in accelerations past 5 g, so it hangs on which samples fall"
    " where; the sampling grid of the paper is not known"
)


@dataclass(frozen=True)
class Config:
    """Three walks of one lap around the papers' lane, a noise of their sensor each, biases of a tenth."""

    walks: int = 3
    rate_hz: float = 50.0
    noise: float = 1.0
    bias: float = 0.1
    seed: int = 91
    straight: WalkConfig = WalkConfig()  # noqa: RUF009  (frozen)
    straight_walks: int = 20

    @property
    def settings(self) -> Settings:
        """The estimator's: a compass outdoors holds the heading, as in the papers."""
        return Settings(magnetometer=True, bias_from_rest=False)


class Surface(NamedTuple):
    """What one walk's end is off its start, m [k_s, k_d], and by constant gains and the papers' two."""

    name: str
    recorded: bool
    fine_m: Floats  # [GAINS_STANCE, GAINS_SWING]
    wide_m: Floats  # [WIDE_STANCE]: k_d = 0
    constant_m: Floats  # [CONSTANT]
    adaptive_m: float
    distance_m: float


def lap(config: Config, number: int) -> Samples:
    """One lap of the lane."""
    options = WalkOptions(
        path="oval", rate_hz=config.rate_hz, noise=config.noise, bias=config.bias, seed=config.seed + number
    )
    return simulate(options).recording.sensors[0]


def survey_lap(config: Config, number: int) -> Surface:
    """The surface of one simulated lap."""
    return survey(f"lap {number + 1}", False, lap(config, number), config.settings)


def survey(name: str, recorded: bool, samples: Samples, settings: Settings) -> Surface:
    """The surface of one walk that ends where it began."""
    table = store(samples)
    constant = [float(sweep(table, settings, np.array([k]), np.array([k]))[0, 0]) for k in CONSTANT]
    tracker = track(samples, replace(settings, gain_stance=1.05, gain_swing=0.0))
    end = tracker.rows.table(tracker.rows.end - 1, tracker.rows.end)[0, POSITION]
    return Surface(
        name,
        recorded,
        sweep(table, settings, GAINS_STANCE, GAINS_SWING),
        sweep(table, settings, WIDE_STANCE, np.zeros(1))[:, 0],
        np.array(constant),
        float(np.hypot(end[0], end[1])),
        tracker.distance_m,
    )


def recorded_tasks(recordings: Mapping[str, Samples]) -> list[Task]:
    """A task for each recorded walk; indoors a compass is better left alone."""
    return [Task(survey, (name, True, samples, Settings())) for name, samples in recordings.items()]


def constant_walks(config: Config, gain: float) -> Floats:
    """Ends of straight noisy walks under one constant gain [walks, 3], less the truth."""
    straight = replace(config.straight, gain_stance=gain, gain_swing=gain)
    _, truth = ideal(straight, straight.strides)
    found = walk_many(straight, straight.noise(1.0), straight.strides, 40, range(config.straight_walks))
    return found[:, -1] - truth


def tasks(config: Config) -> Sequence[Task]:
    """The straight walks under one gain, then a surface for each lap."""
    laps = [Task(survey_lap, (config, number)) for number in range(config.walks)]
    return [Task(constant_walks, (config, 1.0)), *laps]


def conclude(config: Config, done: Sequence[Done]) -> Study:
    """Fig. 14 and Table III, Figs. 16, 91 and 92; the constant gain of III-C."""
    straight, surfaces = done[0].value, [d.value for d in done[1:]]
    laps = [s for s in surfaces if not s.recorded]
    return Study(
        "gains",
        "One gain or two",
        f"{config.walks} simulated laps of the 437.5 m lane, and every recorded walk given with --recording,"
        " under one gain for the whole stride (constant), and with one for stance and one for swing."
        " The error is the distance from start to end.",
        asdict(config),
        tuple(_rows(config, straight, laps)),
        (_fig_92(laps), _wide_plot(surfaces)),
        (_table(surfaces),),
    )


def _rows(config: Config, straight: Floats, laps: Sequence[Surface]) -> list[Row]:
    judge = Judge("gains")
    distance = config.straight.strides * config.straight.stride_m
    error = 100 * float(np.mean(np.hypot(straight[:, 0], straight[:, 1]))) / distance
    fine = np.mean([s.fine_m for s in laps], axis=0)
    stance, swing = np.unravel_index(int(np.argmin(fine)), fine.shape)
    share = [100 * s.adaptive_m / s.distance_m for s in laps]
    rows = [
        judge.digits(
            "2012 paper, III-C: constant gain 1.0, position error", "13.6", error, "%",
            close=0.2, why=_CONSTANT,
        ),
        judge.no_data("Fig. 91: best k_d", "0", float(GAINS_SWING[swing]), "1/s", _TRACK),
        judge.no_data("Fig. 92: best k_s", "1.05", float(GAINS_STANCE[stance]), "1/s", f"{_TRACK}; {_FLAT}"),
    ]  # fmt: skip
    printed = (("0.58", "0.21"), ("0.77", "0.41"), ("1.10", "0.19"))
    for number, ((end, length), surface, got) in enumerate(zip(printed, laps, share, strict=False), start=1):
        long = 100 * abs(surface.distance_m - 437.5) / 437.5
        rows.append(judge.no_data(f"Table 13 (III), walk {number}, end error", end, got, "%", _TRACK))
        rows.append(
            judge.no_data(f"Table 13 (III), walk {number}, distance error", length, long, "%", _TRACK)
        )
    return rows


def _fig_92(laps: Sequence[Surface]) -> Plot:
    mean = np.mean([s.fine_m for s in laps], axis=0)
    curves = tuple(
        Curve(f"k_d = {k:g}", GAINS_STANCE, mean[:, j]) for j, k in enumerate(GAINS_SWING.tolist())
    )
    note = "Any gain in the swing makes it worse: the foot's own acceleration is taken for gravity."
    title = "Figs. 16, 91, 92: end error by both gains, simulated laps"
    return Plot(title, "k_s, 1/s", "distance from start to end, m", curves, note)


def _wide_plot(surfaces: Sequence[Surface]) -> Plot:
    curves = tuple(Curve(s.name, WIDE_STANCE, 100 * s.wide_m / s.distance_m) for s in surfaces)
    note = "No sharp optimum: k_s needs to be there, hardly to be tuned."
    return Plot(
        "End error by the stance gain, k_d = 0", "k_s, 1/s", "% of the distance", curves, note, log_y=True
    )


def _table(surfaces: Sequence[Surface]) -> Table:
    head = ("walk", "distance, m", "adaptive 1.05 / 0", *(f"constant {k:g}" for k in CONSTANT))
    lines: list[tuple[str | float, ...]] = [
        (s.name, s.distance_m, s.adaptive_m, *(float(c) for c in s.constant_m)) for s in surfaces
    ]
    return Table(
        "Distance from start to end, m (Fig. 14 and Table III of the 2012 paper)", head, tuple(lines)
    )
