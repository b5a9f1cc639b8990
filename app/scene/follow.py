"""Edge, scene: the world glides so that the walker stays in view and the person keeps their orbit.

The camera belongs to whoever looks: setting it costs 1.3 ms a browser and fights the mouse. Moving
``/ned`` is one message for all browsers. It glides as a critically damped spring, since a foot
alone goes by jerks: still for half a second, then 4 m/s.
"""

from __future__ import annotations

import math

from app.motion.basics import Quaternion, Vector

#: North–east–down into viser's east–north–up: half a turn about the line between north and east.
NED_WXYZ: Quaternion = (0.0, 0.5**0.5, 0.5**0.5, 0.0)
#: North, east, down: slow in height, or the floor would bob with every step.
STIFFNESS_PER_S = (3.2, 3.2, 0.7)
JUMP_M = 4.0  # a seek or a new walk: go there at once


class Glide:
    """Where in *n* the view is centred."""

    def __init__(self) -> None:
        self.centre: Vector = (0.0, 0.0, 0.0)
        self._velocity: Vector = (0.0, 0.0, 0.0)

    def towards(self, target: Vector, elapsed_s: float) -> Vector:
        """The centre ``elapsed_s`` later, drawn to ``target``; exact for any step."""
        if math.dist(target, self.centre) > JUMP_M:
            self.centre, self._velocity = target, (0.0, 0.0, 0.0)
            return self.centre
        axes = zip(self.centre, self._velocity, target, STIFFNESS_PER_S, strict=True)
        moved = [_spring(at, speed, to, k, elapsed_s) for at, speed, to, k in axes]
        self.centre = (moved[0][0], moved[1][0], moved[2][0])
        self._velocity = (moved[0][1], moved[1][1], moved[2][1])
        return self.centre


def _spring(at: float, speed: float, target: float, k: float, elapsed_s: float) -> tuple[float, float]:
    """Critically damped: x(t) = (a + b t) e^(−kt) about the target."""
    a = at - target
    b = speed + k * a
    decay = math.exp(-k * elapsed_s)
    return target + (a + b * elapsed_s) * decay, (b - k * (a + b * elapsed_s)) * decay


def middle(positions: list[Vector]) -> Vector:
    """The point between the feet; the walk's start when there are none."""
    if not positions:
        return (0.0, 0.0, 0.0)
    north, east, down = (sum(axis) / len(positions) for axis in zip(*positions, strict=True))
    return (north, east, down)
