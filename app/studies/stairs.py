"""Heart: the study `stairs`: one flight and two, foot over foot or step by step (Um 2007, Tables 6, 7)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from app.motion.basics import Floats
from app.studies.experiments import Case, Outcome, path_plot, rows_of, table_of, walk_case
from app.studies.legs import Leg, Sensor, leg
from app.studies.verdicts import Judge
from app.studies.words import Curve, Done, Plot, Study, Task

HEIGHT_M, LENGTH_M, BOTH_M = 1.92, 2.29, 4.46
_CROSSING = (("2.3215", "1.9229", 0.28), ("2.3714", "1.9337", 0.33))
_ONE_FOOT = (("1.9646", "1.9087", 0.28), ("1.9052", "1.8624", 0.33))
_DOUBLE = (("4.3799", 0.33), ("4.5416", 0.33))


@dataclass(frozen=True)
class Config:
    """The staircase of Fig. 19: 9 steps of 0.213 m, a landing, 12 more."""

    sensor: Sensor = Sensor(gyro_bias=(0.0, 0.0, math.radians(0.3)))  # noqa: RUF009  (immutable)
    steps: tuple[int, int] = (9, 12)
    landing_strides: int = 3
    seed: int = 1907


def crossing(steps: int, pause_s: float) -> Leg:
    """Foot over foot: this foot takes two steps in each stride, and the last one if it is odd."""
    strides = [2.0] * (steps // 2) + [1.0] * (steps % 2)
    tread, riser = LENGTH_M / 9, _riser(steps)
    return Leg(
        pause_s, tuple(n * tread for n in strides), (0.0,) * len(strides), tuple(n * riser for n in strides)
    )


def one_foot(steps: int, pause_s: float) -> Leg:
    """Step by step: the foot goes ahead by one step and waits for the other."""
    return leg(pause_s, steps, steps * LENGTH_M / 9 / steps, climb_m=steps * _riser(steps))


def _riser(steps: int) -> float:
    """The two flights' steps differ: 9 for 1.92 m, 12 for the rest of 4.46 m."""
    return HEIGHT_M / 9 if steps == 9 else (BOTH_M - HEIGHT_M) / 12


def cases(config: Config) -> list[Case]:
    """Every line of Tables 6 and 7."""
    first, second = config.steps
    found = []
    for how, lines, legs in (
        ("both feet", _CROSSING, (crossing(first, 3.0),)),
        ("one foot", _ONE_FOOT, (one_foot(first, 3.0),)),
    ):
        for k, (length, height, threshold) in enumerate(lines, start=1):
            item = f"Table 6, {how}, experiment {k}"
            found.append(Case(f"{item}, horizontal", length, LENGTH_M, "horizontal", legs, threshold))
            found.append(Case(f"{item}, vertical", height, HEIGHT_M, "height", legs, threshold))
    landing = leg(0.0, config.landing_strides, 0.7, math.pi)
    for k, (height, threshold) in enumerate(_DOUBLE, start=1):
        whole = (crossing(first, 3.0), landing, crossing(second, 0.0))
        found.append(Case(f"Table 7, experiment {k}, vertical", height, BOTH_M, "height", whole, threshold))
    return found


def tasks(config: Config) -> Sequence[Task]:
    """One for each line."""
    return [Task(walk_case, (case, config.sensor, config.seed + k)) for k, case in enumerate(cases(config))]


def conclude(config: Config, done: Sequence[Done]) -> Study:
    """Tables 6 and 7; Figs. 20–25."""
    outcomes: list[Outcome] = [d.value for d in done]
    return Study(
        "stairs",
        "Up the stairs",
        "A flight of nine steps, foot over foot and step by step, and two flights with a turn on the landing."
        " The thesis' method beside the papers' estimator and the Kalman filter.",
        asdict(config),
        tuple(rows_of(Judge("stairs"), outcomes)),
        (path_plot("Figs. 24, 25: two flights from above", outcomes[-1]), _heights(outcomes)),
        (table_of("All climbs", outcomes),),
    )


def _heights(outcomes: Sequence[Outcome]) -> Plot:
    """Error of the height by method over all climbs."""
    climbs = [o for o in outcomes if o.case.quantity == "height"]
    number: Floats = np.arange(1.0, len(climbs) + 1)
    curves = tuple(
        Curve(
            name,
            number,
            np.array([100 * (-float(o.by[name].end_n[2]) - o.case.true) for o in climbs]),
            dots=True,
        )
        for name in ("thesis", "papers", "Kalman")
    )
    note = "; ".join(f"{k}: {o.case.item.removesuffix(', vertical')}" for k, o in enumerate(climbs, start=1))
    return Plot("Height error of every climb: estimate less truth", "climb", "error, cm", curves, note + ".")
