"""Heart: the study `heading`: straight walks, squares, circles and turns (Um 2007, Tables 2–5, 8–11)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from app.studies.experiments import Case, Outcome, measure, path_plot, rows_of, table_of, walk_case
from app.studies.legs import Leg, Sensor, leg
from app.studies.verdicts import Judge
from app.studies.words import Curve, Done, Plot, Study, Task

QUARTER = 0.5 * math.pi
#: Metres, steps, printed metres and thresholds.
_STRAIGHT = (
    ("Table 3", 8.0, ((7, "8.0161", 0.58), (7, "7.8244", 0.58), (7, "7.9337", 0.35), (6, "7.9337", 0.5),
                      (6, "8.0712", 0.58))),
    ("Table 4, 16 m", 16.0, ((13, "14.9214", 0.35), (13, "15.9549", 0.55), (13, "15.9725", 0.55))),
    ("Table 4, 24 m", 24.0, ((18, "23.8433", 0.55), (19, "20.5164", 0.58))),
    ("Table 5, walker A", 48.0, ((40, "47.7835", 0.54), (40, "46.5809", 0.6), (40, "47.7566", 0.55),
                                 (40, "47.9881", 0.58))),
    ("Table 5, walker B", 48.0, ((34, "48.2712", 0.2), (34, "45.4813", 0.35), (33, "46.7244", 0.4))),
    ("IV-B: 150 m", 150.0, ((125, "149.0796", 0.43),)),
)  # fmt: skip
_UNCOMPENSATED = ((40, "51.5266", 0.58), (40, "51.3447", 0.58), (40, "51.6490", 0.35))
_SQUARES = ("7.6182", "3.4926", "7.4341", "5.0103")  # Table 8: how far the end is from the start
_TURNS = (
    ("Table 9", 90.0, 1, (("82.2386", 0.4), ("76.6326", 0.36), ("89.3626", 0.35))),
    ("Table 10", 180.0, 2, (("163.4721", 0.35), ("153.9947", 0.31), ("163.0901", 0.46), ("174.0096", 0.37))),
    ("Table 11", 360.0, 4, (("341.4788", 0.33), ("343.4425", 0.36), ("354.4059", 0.35))),
)


@dataclass(frozen=True)
class Config:
    """The thesis saw 20° of drift in a walk of eight steps and two pauses: a gyro bias of about 0.8 °/s."""

    sensor: Sensor = Sensor(gyro_bias=(0.0, 0.0, math.radians(0.8)))  # noqa: RUF009  (immutable)
    court_m: tuple[float, float] = (23.77, 10.97)  # the tennis court he walked around
    stride_m: float = 1.2
    seed: int = 2007


def straight(metres: float, strides: int) -> tuple[Leg, ...]:
    """Standing, then one straight leg."""
    return (leg(3.0, strides, metres / strides),)


def turning(turns: int, *, pause_s: float = 1.5, side: int = 4) -> tuple[Leg, ...]:
    """Steps, a pause, steps, a pause, then so many right angles with steps after each (Figs. 35, 38–40)."""
    legs = [leg(3.0, 3, 1.1), leg(pause_s, 3, 1.1)]
    for _ in range(turns):
        legs += [leg(pause_s, 2, 0.6, QUARTER), leg(0.0, side, 1.1)]
    return tuple(legs)


def court(config: Config) -> tuple[Leg, ...]:
    """Around the court, clockwise, a quarter turn at each corner."""
    legs = []
    for k, metres in enumerate(config.court_m * 2):
        legs.append(leg(3.0 if k == 0 else 1.0, round(metres / config.stride_m), config.stride_m))
        legs.append(leg(0.0, 2, 0.6, QUARTER))
    return tuple(legs)


def circle() -> tuple[Leg, ...]:
    """Fig. 28: once around, 16 strides."""
    return (leg(3.0, 16, 1.0, 2.0 * math.pi),)


def cases(config: Config) -> list[Case]:
    """Every line of the thesis' tables of walks on level ground."""
    found = [
        Case(f"Table 2, experiment {k}, without ZVC", printed, 48.0, "distance", straight(48.0, n), th, False)
        for k, (n, printed, th) in enumerate(_UNCOMPENSATED, start=1)
    ]
    found += [
        Case(f"{table}, experiment {k}", printed, metres, "distance", straight(metres, n), threshold)
        for table, metres, lines in _STRAIGHT
        for k, (n, printed, threshold) in enumerate(lines, start=1)
    ]
    found += [
        Case(f"Table 8, experiment {k}, end off start", printed, 0.0, "end", court(config), 0.55)
        for k, printed in enumerate(_SQUARES, start=1)
    ]
    for table, degrees, turns, lines in _TURNS:
        for k, (printed, threshold) in enumerate(lines, start=1):
            # the last of Table 11 was walked without pauses
            pause_s = 0.0 if (table, k) == ("Table 11", 3) else 1.5
            legs = turning(turns, pause_s=pause_s)
            found.append(Case(f"{table}, experiment {k}", printed, degrees, "turned", legs, threshold))
    return found


def tasks(config: Config) -> Sequence[Task]:
    """One for each line, and the circle."""
    every = [*cases(config), Case("Fig. 28, end off start", "", 0.0, "end", circle(), 0.55)]
    return [Task(walk_case, (case, config.sensor, config.seed + k)) for k, case in enumerate(every)]


def phase_plot(config: Config, turn: Outcome) -> Plot:
    """Fig. 35: the four phases of a walk with one turn."""
    t = np.arange(len(turn.phase)) / config.sensor.rate_hz
    curve = Curve("phase", t, turn.phase.astype(np.float64))
    note = "0 initial (at rest for half a second or more), 1 stance, 2 swing, 3 turning swing."
    return Plot("Fig. 35: the phases of a walk with a turn of 90°", "time, s", "phase", (curve,), note)


def conclude(config: Config, done: Sequence[Done]) -> Study:
    """Tables 2–5 and 8–11; Figs. 26–41."""
    outcomes: list[Outcome] = [d.value for d in done]
    *lines, circle_walk = outcomes
    courts = [o for o in lines if o.case.item.startswith("Table 8")]
    worst_m = max(measure(o.by["papers"], "end") for o in courts)
    return Study(
        "heading",
        "Straight walks, squares and turns",
        "The 2007 thesis' walks on level ground, with its own method (swing windows on the horizontal rate,"
        " zero-velocity compensation; a heading that only turning swings may change), beside the papers'"
        " estimator and the Kalman filter, none of them with a compass.",
        asdict(config),
        tuple(rows_of(Judge("heading"), lines)),
        (
            path_plot(
                "Figs. 26–31: around a tennis court", courts[0],
                "Without a compass the gyro's bias bends the walk. A still start takes most of it away, where"
                f" the noise lets one be told: at worst the papers' end is {worst_m:.0f} m off.",
            ),
            path_plot("Fig. 28: a circle", circle_walk),
            phase_plot(config, next(o for o in lines if o.case.item.startswith("Table 9"))),
        ),
        (table_of("All walks", [*lines, circle_walk]),),
    )  # fmt: skip
