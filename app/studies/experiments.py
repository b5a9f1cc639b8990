"""Heart: one of Um's experiments, simulated: his method, the papers' and the Kalman filter."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from app.estimator.tracker import track
from app.motion.basics import Floats, Ints
from app.motion.estimate import ATTITUDE, POSITION
from app.settings import Settings
from app.studies import thesis
from app.studies.legs import Leg, Sensor, walk_legs
from app.studies.verdicts import Judge
from app.studies.words import Curve, Plot, Row, Table


class Case(NamedTuple):
    """One line of a table of the thesis. ``quantity`` is what was measured."""

    item: str
    printed: str  # nothing where there is only a figure
    true: float
    quantity: str  # distance | end | turned | horizontal | height
    legs: tuple[Leg, ...]
    threshold_radps: float
    compensate: bool = True


class Walked(NamedTuple):
    """What one method makes of it."""

    distance_m: float
    end_n: Floats  # [3] m
    turned_deg: float
    steps: int


class Outcome(NamedTuple):
    """A case by every method; for plots the paths [n, 2] and the thesis' phase of every sample [n]."""

    case: Case
    by: dict[str, Walked]
    paths: dict[str, Floats]
    phase: Ints


UNITS = {"distance": "m", "end": "m", "turned": "deg", "horizontal": "m", "height": "m"}
METHODS = ("thesis", "papers", "Kalman")
NO_DATA = (
    "walked with a sensor on a real foot and never published; ours is simulated, with the same sensor class"
)


def walk_case(case: Case, sensor: Sensor, seed: int) -> Outcome:
    """Walk it and estimate it three times; the thesis' method takes the papers' orientation."""
    made = walk_legs(case.legs, sensor, seed)
    by, paths = {}, {"truth": _truth(case)}
    orientation: Floats = np.empty((0, 4))
    for name, estimator in (("papers", "papers"), ("Kalman", "kalman")):
        tracker = track(made.samples, Settings(estimator=estimator))
        rows = tracker.rows.table(0, tracker.rows.end)
        turned = _turned(rows[:, ATTITUDE])
        by[name] = Walked(tracker.distance_m, rows[-1, POSITION], turned, tracker.stride_count)
        paths[name] = rows[::10, :2]
        if name == "papers":
            orientation = rows[:, ATTITUDE]
    found = thesis.walk(made.samples.matrix, orientation, case.threshold_radps, compensate=case.compensate)
    by["thesis"] = Walked(found.distance_m, found.end_n, math.degrees(found.turned_rad), found.steps)
    return Outcome(case, by, paths, found.phase)


def _truth(case: Case) -> Floats:
    """The footprints' path [n, 2], m."""
    place, heading, prints = np.zeros(2), 0.0, [np.zeros(2)]
    for part in case.legs:
        for stride, turn in zip(part.strides_m, part.turns_rad, strict=True):
            along = heading + 0.5 * turn
            place = place + stride * np.array([math.cos(along), math.sin(along)])
            heading += turn
            prints.append(place)
    return np.array(prints)


def _turned(q_nb: Floats) -> float:
    w, x, y, z = q_nb.T
    yaw = np.unwrap(np.arctan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z)))
    return math.degrees(float(yaw[-1] - yaw[0]))


def measure(walked: Walked, quantity: str) -> float:
    """The figure a table has of a walk."""
    north, east, down = (float(x) for x in walked.end_n)
    return {
        "distance": walked.distance_m,
        "end": math.hypot(north, east),
        "turned": abs(walked.turned_deg),
        "horizontal": math.hypot(north, east),
        "height": -down,
    }[quantity]


def rows_of(judge: Judge, outcomes: Sequence[Outcome]) -> list[Row]:
    """A row for each printed figure: the thesis' method on our simulation."""
    return [
        judge.no_data(
            o.case.item, o.case.printed, measure(o.by["thesis"], o.case.quantity), UNITS[o.case.quantity],
            NO_DATA,
        )
        for o in outcomes
    ]  # fmt: skip


def table_of(title: str, outcomes: Sequence[Outcome]) -> Table:
    """Every case with all methods side by side."""
    lines: list[tuple[str | float, ...]] = [
        (
            f"{o.case.item}, {UNITS[o.case.quantity]}",
            o.case.true,
            float(o.case.printed) if o.case.printed else "–",
            *(measure(o.by[m], o.case.quantity) for m in METHODS),
        )
        for o in outcomes
    ]
    head = ("", "true", "printed", "thesis' method", "papers' estimator", "Kalman filter")
    return Table(title, head, tuple(lines))


def path_plot(title: str, outcome: Outcome, note: str = "") -> Plot:
    """Where the walk went, seen from above."""
    curves = tuple(Curve(name, path[:, 1], path[:, 0]) for name, path in outcome.paths.items())
    return Plot(title, "east, m", "north, m", curves, note, equal=True)
