"""Heart: decisions into a way through the town: smooth speeds, walls that are slid along, a safe stop.

Time comes with the call. Velocity is ahead, to the right and turning; each goes to what is asked for
at no more than a comfortable rate, faster when it is to stop.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from app.gestures.words import Decision, standing
from app.motion.basics import Floats, MotionId
from app.world import Town

#: Which way each motion goes: ahead, to the right.
_WAYS = {
    MotionId.FORWARD: (1.0, 0.0),
    MotionId.FORWARD_RIGHT: (1.0, 0.0),
    MotionId.FORWARD_LEFT: (1.0, 0.0),
    MotionId.BACKWARD: (-1.0, 0.0),
    MotionId.SIDE_RIGHT: (0.0, 1.0),
    MotionId.SIDE_LEFT: (0.0, -1.0),
}
_LONGEST_STEP_S = 0.1  # a longer pause (a sleeping computer) is not walked through


@dataclass(frozen=True)
class Comfort:
    """How gently the camera moves."""

    start_mps2: float = 2.0
    stop_mps2: float = 4.0
    start_radps2: float = 2.5
    stop_radps2: float = 6.0
    most_mps: float = 3.0
    most_radps: float = 1.5
    radius_m: float = 0.35


@dataclass(frozen=True)
class Walker:
    """Where the camera is in *n* (m, rad clockwise from north) and how it moves."""

    north: float = -30.0  # in the street south of the square, which lies ahead
    east: float = 0.0
    heading_rad: float = 0.0
    ahead_mps: float = 0.0
    right_mps: float = 0.0
    turn_radps: float = 0.0
    touching: bool = False  # a wall or the edge of town holds it back

    @property
    def at_rest(self) -> bool:
        """Whether nothing moves."""
        return self.ahead_mps == 0.0 and self.right_mps == 0.0 and self.turn_radps == 0.0


STOP = standing(0, "stopped by the operator")
"""What to steer by after an emergency stop, or when nothing is known."""


def steer(
    walker: Walker, decision: Decision, dt_s: float, town: Town, comfort: Comfort | None = None
) -> Walker:
    """The walker ``dt_s`` later. Rubbish in a decision is a stop."""
    c = comfort or Comfort()
    dt = min(max(dt_s, 0.0), _LONGEST_STEP_S) if math.isfinite(dt_s) else 0.0
    ahead, right, turn = _wanted(decision, c)
    now = replace(
        walker,
        ahead_mps=_towards(walker.ahead_mps, ahead, c.start_mps2 * dt, c.stop_mps2 * dt),
        right_mps=_towards(walker.right_mps, right, c.start_mps2 * dt, c.stop_mps2 * dt),
        turn_radps=_towards(walker.turn_radps, turn, c.start_radps2 * dt, c.stop_radps2 * dt),
    )
    return _moved(now, dt, town, c.radius_m)


def _wanted(decision: Decision, c: Comfort) -> tuple[float, float, float]:
    speed, turn = decision.speed_mps, decision.turn_radps
    if not (math.isfinite(speed) and math.isfinite(turn)) or decision.motion == MotionId.NONE:
        return 0.0, 0.0, 0.0
    speed = min(max(speed, 0.0), c.most_mps)
    ahead, right = _WAYS.get(decision.motion, (0.0, 0.0))
    return ahead * speed, right * speed, min(max(turn, -c.most_radps), c.most_radps)


def _towards(now: float, wanted: float, faster: float, slower: float) -> float:
    """One velocity a step nearer to the one wanted; through 0 it has to brake first."""
    if now * wanted < 0.0:
        wanted = 0.0
    most = faster if abs(wanted) > abs(now) else slower
    return now + min(max(wanted - now, -most), most)


def _moved(walker: Walker, dt_s: float, town: Town, radius_m: float) -> Walker:
    """Along the mean heading of the step, then out of every wall."""
    heading = walker.heading_rad + walker.turn_radps * dt_s
    middle = 0.5 * (walker.heading_rad + heading)
    c, s = math.cos(middle), math.sin(middle)
    north = walker.north + (c * walker.ahead_mps - s * walker.right_mps) * dt_s
    east = walker.east + (s * walker.ahead_mps + c * walker.right_mps) * dt_s
    clear_north, clear_east = slide(north, east, town.solid, town.half_m, radius_m)
    touching = (clear_north, clear_east) != (north, east)
    turned = math.remainder(heading, math.tau)
    return replace(walker, north=clear_north, east=clear_east, heading_rad=turned, touching=touching)


def slide(north: float, east: float, solid: Floats, half_m: float, radius_m: float) -> tuple[float, float]:
    """The nearest place where a circle touches no box [n, 4] and is in town: so walls are slid along."""
    for _ in range(4):  # a corner between two walls takes two
        s, w, n, e = solid.T
        away_n, away_e = north - np.clip(north, s, n), east - np.clip(east, w, e)
        distance = np.hypot(away_n, away_e)
        i = int(np.argmin(distance)) if len(distance) else -1
        if i < 0 or distance[i] >= radius_m:
            break
        if distance[i] > 0.0:
            scale = (radius_m + 1e-9) / distance[i]
            north = float(north - away_n[i] + away_n[i] * scale)
            east = float(east - away_e[i] + away_e[i] * scale)
        else:
            north, east = _out_of(north, east, solid[i], radius_m)
    most = half_m - radius_m
    return min(max(north, -most), most), min(max(east, -most), most)


def _out_of(north: float, east: float, box: Floats, radius_m: float) -> tuple[float, float]:
    """From within a box to its nearest side."""
    s, w, n, e = box.tolist()
    ways = {north - s: (s - radius_m, east), n - north: (n + radius_m, east)}
    ways |= {east - w: (north, w - radius_m), e - east: (north, e + radius_m)}
    return ways[min(ways)]
