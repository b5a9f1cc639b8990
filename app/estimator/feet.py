"""Heart: two feet of one person: no further apart than legs let them, both walks and headings stay together.

Each foot's own estimate drifts in heading, and where its toe points at the start is its own north. Here the
paired step: at every contact of either foot the two may be at most so far apart (after J.-O. Nilsson,
I. Skog, P. Händel, "A note on the limitations of ZUPTs and the implications on sensor error modeling", and
"Foot-mounted inertial navigation made easy", IPIN 2012: "sphere limit"). What has to turn is found for the
whole walk at once, by damped least squares: each foot's heading error is a bias and a random walk, both as
probable as a gyro's; a bound that holds says nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

import numpy as np

from app.blocks import Blocks
from app.estimator.kalman_state import turn_walk
from app.estimator.together import BESIDE_M, BOUND_M, OF_A_STRIDE, START_RAD, TOO_FAR_M, WANDER_RADPS
from app.estimator.tracker import Tracker
from app.estimator.turns import turned, turned_attitude
from app.motion.basics import Floats, Role
from app.motion.samples import Column

#: The random walk has at most so many knots, no closer than this; so many strides at least tell anything.
MOST_KNOTS, KNOT_S, LEAST_STRIDES = 40, 5.0, 3
#: At most so many contacts are looked at (an odd share, so that both feet's are); the first so many first.
MOST_CONTACTS, FIRST_CONTACTS = 1500, 24
STEPS, SHORTEST_STEP_RAD = 12, 1e-6


class Worn(NamedTuple):
    """Where a sensor is worn, and when its first sample came on a clock that both feet share."""

    role: Role
    offset_s: float = 0.0
    pace: float = 1.0  # seconds of the shared clock in one of the sensor's


class Foot(NamedTuple):
    """One foot's walk: its tracker, and its rows' times as seconds on the shared clock."""

    worn: Worn
    tracker: Tracker
    t_s: Floats  # [n]

    def shared_s(self, elapsed_s: float) -> float:
        """Seconds since the sensor's first sample, on the shared clock."""
        return self.worn.offset_s + elapsed_s * self.worn.pace


class Turning(NamedTuple):
    """How far a foot's walk has to be turned at these times, rad, clockwise from above."""

    t_s: Floats
    yaw_rad: Floats


def link_worn(
    trackers: Mapping[str, Tracker], worn: Mapping[str, Worn], stores: Mapping[str, Blocks], apart_m: float
) -> bool:
    """The same for trackers, what is known of their sensors and their samples, all by the sensor's name."""
    if len(trackers) != 2 or any(tracker.rows.start for tracker in trackers.values()):
        return False
    feet = []
    for name, tracker in trackers.items():
        elapsed_s = stores[name].table(0, tracker.rows.end)[:, Column.ELAPSED_NS] * 1e-9
        feet.append(Foot(worn[name], tracker, worn[name].offset_s + elapsed_s * worn[name].pace))
    return link(feet, apart_m)


def link(feet: list[Foot], apart_m: float) -> bool:
    """Give both feet one heading and keep them within ``apart_m``, their rows and strides in place.

    Says whether it could: two feet, left and right, from the start of the walk, with some strides each.
    """
    sides = {foot.worn.role: foot for foot in feet}
    if len(feet) != 2 or set(sides) != {Role.LEFT, Role.RIGHT} or apart_m <= 0.0:
        return False
    both = (sides[Role.LEFT], sides[Role.RIGHT])
    if any(foot.tracker.rows.start or len(foot.tracker.strides) < LEAST_STRIDES for foot in both):
        return False
    if any(foot.tracker.segments for foot in both):  # where a foot went in a gap nobody knows
        return False
    found = turns_of(both, apart_m)
    if found is None:
        return False
    for foot, turns in zip(both, found, strict=True):
        turn(foot, turns)
    return True


def turns_of(both: tuple[Foot, Foot], apart_m: float) -> tuple[Turning, Turning] | None:
    """What turns the left and the right foot's walk so that the bound holds; None if nothing does.

    The walk is taken from its beginning, twice as much of it each time: where headings drift by more than a
    right angle, its end alone would not say which way.
    """
    t_s, bound_m = _contacts(both, apart_m)
    if len(t_s) < 2 * LEAST_STRIDES:
        return None
    steps = [np.diff(_places(foot, t_s), axis=0, prepend=0.0) for foot in both]
    knots_s = _knots(t_s)
    shapes = _shapes(t_s, knots_s)
    parts = shapes.shape[1]
    apart = np.array([0.0, BESIDE_M])
    begin = min(FIRST_CONTACTS, len(t_s))
    first = _first_turn(*(np.cumsum(step[:begin], axis=0) for step in steps))
    weights = np.concatenate([_weights(foot, knots_s, START_RAD[i]) for i, foot in enumerate(both)])

    def look(x: Floats, count: int) -> tuple[float, Floats, Floats]:
        """The cost, the first bounds' residuals [count] and their slopes [count, 2 · parts]."""
        away, slopes, shape = -np.tile(apart, (count, 1)), [], shapes[:count]
        for side, (whole, sign) in enumerate(zip(steps, (1.0, -1.0), strict=True)):
            step = whole[:count]
            yaw = shape @ x[side * parts : (side + 1) * parts] + (first if side else 0.0)
            moved = turned(step, yaw)
            away = away + sign * np.cumsum(moved, axis=0)
            aside = np.column_stack([-moved[:, 1], moved[:, 0]])
            slopes.append(sign * np.cumsum(aside[:, None, :] * shape[:, :, None], axis=0))
        far = np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-9)
        over = np.maximum(far - bound_m[:count], 0.0) / BOUND_M
        unit = away / far[:, None] * (over > 0.0)[:, None] / BOUND_M
        slope = np.einsum("mpk,mk->mp", np.concatenate(slopes, axis=1), unit)
        return float(over @ over + (weights * x) @ (weights * x)), over, slope

    x, count = np.zeros(2 * parts), begin
    while True:
        x = _least(partial(look, count=count), x, weights)
        if count == len(t_s):
            break
        count = min(2 * count, len(t_s))
    if look(x, count)[1].max() > TOO_FAR_M / BOUND_M:
        return None
    left, right = x[:parts], x[parts:]
    at = _shapes(knots_s, knots_s)
    return Turning(knots_s, at @ left), Turning(knots_s, at @ right + first)


def _least(look: Callable[[Floats], tuple[float, Floats, Floats]], x: Floats, weights: Floats) -> Floats:
    """The least cost from ``x`` on, by Levenberg and Marquardt."""
    damping = 1e-3
    cost, over, slope = look(x)
    for _ in range(STEPS):
        normal = slope.T @ slope + np.diag(weights**2)
        down = slope.T @ over + weights**2 * x
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), -down)
        new_cost, new_over, new_slope = look(x + step)
        if new_cost < cost:
            x, cost, over, slope, damping = x + step, new_cost, new_over, new_slope, 0.3 * damping
            if np.abs(step).max() < SHORTEST_STEP_RAD:
                break
        else:
            damping *= 10.0
    return x


def _contacts(both: tuple[Foot, Foot], apart_m: float) -> tuple[Floats, Floats]:
    """Times of all contacts that both feet saw, and how far the feet may be apart then, m."""
    begin, end = max(foot.t_s[0] for foot in both), min(foot.t_s[-1] for foot in both)
    found = sorted(
        (foot.shared_s(stride.end_s), max(apart_m, OF_A_STRIDE * stride.length_m))
        for foot in both
        for stride in foot.tracker.strides
    )
    kept = np.array([pair for pair in found if begin <= pair[0] <= end])
    each = len(kept) // MOST_CONTACTS // 2 * 2 + 1
    kept = kept.reshape(-1, 2)[::each]
    return kept[:, 0], kept[:, 1]


def _places(foot: Foot, t_s: Floats) -> Floats:
    """North and east at these times [m, 2], from the start."""
    rows = foot.tracker.rows.table(0, foot.tracker.rows.end)
    return np.column_stack([np.interp(t_s, foot.t_s, rows[:, k] - rows[0, k]) for k in (0, 1)])


def _knots(t_s: Floats) -> Floats:
    """Where the random walk's pieces join."""
    count = int(np.clip((t_s[-1] - t_s[0]) / KNOT_S, 1, MOST_KNOTS))
    return np.linspace(t_s[0], t_s[-1], count + 1)


def _shapes(t_s: Floats, knots_s: Floats) -> Floats:
    """What each part of a heading error does at each time [m, 2 + knots − 1]: start, bias, pieces."""
    pieces = np.clip((t_s[:, None] - knots_s[:-1]) / np.diff(knots_s), 0.0, 1.0)
    return np.column_stack([np.ones(len(t_s)), t_s - knots_s[0], pieces])


def _weights(foot: Foot, knots_s: Floats, start_rad: float) -> Floats:
    """1/σ of each part."""
    _, known, moved = foot.tracker.method.doubts(foot.tracker.state)
    lasts_s = np.diff(knots_s)
    pieces = 1.0 / np.sqrt(WANDER_RADPS**2 * lasts_s + (moved * lasts_s) ** 2)
    return np.concatenate([[1.0 / start_rad, 1.0 / max(known, moved)], pieces])


def _first_turn(left: Floats, right: Floats) -> float:
    """The least-squares yaw of the right foot's walk onto the left's, about the start."""
    cosine = float(np.sum(left * right))
    sine = float(np.sum(right[:, 0] * left[:, 1] - right[:, 1] * left[:, 0]))
    return float(np.arctan2(sine, cosine))


def turn(foot: Foot, turns: Turning) -> None:
    """Turn a foot's rows, strides and state as far as each time says."""
    tracker = foot.tracker
    before: Floats | None = None
    place = np.zeros(2)
    for rows, number in tracker.rows.pieces(0, tracker.rows.end):
        yaw = np.interp(foot.t_s[number : number + len(rows)], turns.t_s, turns.yaw_rad)
        steps = np.diff(rows[:, :2], axis=0, prepend=(rows[:1, :2] if before is None else before[None]))
        before = rows[-1, :2].copy()
        rows[:, :2] = place + np.cumsum(turned(steps, yaw), axis=0)
        place = rows[-1, :2].copy()
        rows[:, 3:5] = turned(rows[:, 3:5], yaw)
        rows[:, 6:10] = turned_attitude(rows[:, 6:10], yaw)
    _turn_strides(foot, turns)
    state = tracker.state[0]
    turn_walk(state, float(np.interp(foot.t_s[-1], turns.t_s, turns.yaw_rad)))
    away = (float(place[0] - state["px"]), float(place[1] - state["py"]))
    for name in ("p", "from_", "at_", "start_"):
        state[f"{name}x"], state[f"{name}y"] = state[f"{name}x"] + away[0], state[f"{name}y"] + away[1]


def _turn_strides(foot: Foot, turns: Turning) -> None:
    rows = foot.tracker.rows.table(0, foot.tracker.rows.end)
    told = foot.tracker.strides
    for i, stride in enumerate(told):
        at_s = foot.shared_s(stride.end_s)
        north, east = (float(np.interp(at_s, foot.t_s, rows[:, k])) for k in (0, 1))
        heading = stride.heading_rad + float(np.interp(at_s, turns.t_s, turns.yaw_rad))
        told[i] = stride._replace(end_n=(north, east, stride.end_n[2]), heading_rad=heading)
    foot.tracker.stand()
