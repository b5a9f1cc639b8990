"""Heart: the walk by the orientation that a sensor computed itself: a track beside ours, by our gait phases.

The papers' "proprietary" comparison (dissertation, Tables 12 and 13). Where the walk begins its heading is
made ours. A swing is integrated by the sensor's quaternion; where it ends, the velocity that is left is
drift, taken to have grown evenly, and what it did to the position is taken back.
"""

from __future__ import annotations

import math
from collections import deque
from statistics import median

import numpy as np

from app.motion.basics import GaitPhase, Quaternion, Vector
from app.motion.samples import GAP_NS, Sample
from app.motion.snapshot import OwnView
from app.rotation import conjugate, from_yaw, multiply, rotate, yaw_of
from app.settings import Settings
from app.trail import TrailBuilder

_AT_ONCE = 64  # points to the trail
#: A swing began at most so long before it is told.
EARLY_NS = 120_000_000
_STILL = 8  # samples that tell gravity's length
_DOWN: Vector = (0.0, 0.0, 1.0)


class OwnWalk:
    """One sensor's walk by its own quaternion, from where ours knew level on, or from where a seek landed."""

    def __init__(self, name: str) -> None:
        """``name`` makes the keys of its trail's pieces unique."""
        self._name, self._turns = name, 0
        self._builder = TrailBuilder(name)
        self._points: list[Vector] = []
        self._heading_rad: float | None = None  # the start heading it is drawn by; None before level
        self._turn: Quaternion = (1.0, 0.0, 0.0, 0.0)  # from the sensor's north to ours
        self._still: list[float] = []  # |f| of a stance, until it has begun
        self._gravity = 0.0
        self._early: deque[tuple[Quaternion, Vector, int]] = deque()
        self._early_ns = 0
        self._last_ns = 0
        self._q_nb: Quaternion = (1.0, 0.0, 0.0, 0.0)
        self._position = self._velocity = self._lifted = (0.0, 0.0, 0.0)
        self._swing_s = 0.0
        self._distance_m = 0.0

    def take(
        self,
        sample: Sample,
        phase: GaitPhase,
        levelled: bool,
        q_nb: Quaternion,
        position_n: Vector,
        settings: Settings,
    ) -> None:
        """A sample with its own orientation; phase, levelled or not, ``q_nb`` and ``position_n`` are ours."""
        own, force = sample.device_q_nb, sample.specific_force_b
        if own is None:
            return
        if self._heading_rad is None:
            if phase is GaitPhase.SWING:  # in the middle of a walk: at the next stance
                self._still.clear()
                return
            self._still.append(math.hypot(*force))
            if not levelled or len(self._still) < _STILL:
                return
            self._gravity = median(self._still)
            self._heading_rad = settings.start_heading_rad
            self._position = self._lifted = position_n
            self._turn = from_yaw(yaw_of(q_nb) - yaw_of(own))
        self._q_nb = multiply(self._turn, own)
        step_ns, self._last_ns = sample.device_ns - self._last_ns, sample.device_ns
        if step_ns > GAP_NS:
            self._early.clear()
            self._early_ns = 0
            self._land(0.0)
            self._tell()
            self._builder.lift_pen()
        elif phase is GaitPhase.STANCE:
            self._land(0.5 * self._swing_s)
            self._wait(force, step_ns)
        else:
            for q_nb, early, early_ns in self._early:
                self._fly(rotate(q_nb, early), early_ns * 1e-9)
            self._early.clear()
            self._early_ns = 0
            self._fly(rotate(self._q_nb, force), step_ns * 1e-9)
        self._points.append(self._position)
        if len(self._points) >= _AT_ONCE and phase is GaitPhase.STANCE:
            self._tell()

    def _wait(self, force: Vector, step_ns: int) -> None:
        """Keep what may turn out to be a swing's beginning: a phase is told only when it has lasted."""
        self._early.append((self._q_nb, force, step_ns))
        self._early_ns += step_ns
        while self._early_ns > EARLY_NS:
            self._early_ns -= self._early.popleft()[2]

    def _fly(self, force_n: Vector, dt_s: float) -> None:
        gravity = self._gravity
        before, v = self._velocity, self._velocity
        v = (v[0] + force_n[0] * dt_s, v[1] + force_n[1] * dt_s, v[2] + (force_n[2] + gravity) * dt_s)
        p, half = self._position, 0.5 * dt_s
        self._position = (
            p[0] + half * (before[0] + v[0]),
            p[1] + half * (before[1] + v[1]),
            p[2] + half * (before[2] + v[2]),
        )
        self._velocity = v
        self._swing_s += dt_s

    def _land(self, drifted_s: float) -> None:
        """The foot stands: its velocity was drift, and moved it for ``drifted_s`` in the mean."""
        if self._swing_s == 0.0:
            return
        p, v = self._position, self._velocity
        self._position = (p[0] - v[0] * drifted_s, p[1] - v[1] * drifted_s, p[2] - v[2] * drifted_s)
        start, self._lifted = self._lifted, self._position
        self._distance_m += math.hypot(self._position[0] - start[0], self._position[1] - start[1])
        self._velocity, self._swing_s = (0.0, 0.0, 0.0), 0.0

    def _tell(self) -> None:
        """What is settled, to the trail."""
        if self._points:
            self._builder.add(np.array(self._points))
            self._points.clear()

    def _follow(self, heading_rad: float) -> None:
        """Ours was turned: turn with it."""
        angle = heading_rad - (self._heading_rad or 0.0)
        if self._heading_rad is None or angle == 0.0:
            return
        self._tell()
        self._turns += 1
        self._builder.turn(f"{self._name}t{self._turns}", angle)
        turn = from_yaw(angle)
        self._turn = multiply(turn, self._turn)
        self._q_nb = multiply(turn, self._q_nb)
        self._early = deque((multiply(turn, q_nb), force, step_ns) for q_nb, force, step_ns in self._early)
        self._position, self._velocity = rotate(turn, self._position), rotate(turn, self._velocity)
        self._lifted, self._heading_rad = rotate(turn, self._lifted), heading_rad

    def view(self, q_nb: Quaternion, settings: Settings) -> OwnView | None:
        """It now, and how far from our orientation ``q_nb``; None before it has begun."""
        if self._heading_rad is None:
            return None
        self._follow(settings.start_heading_rad)
        open_end = np.array(self._points) if self._points else np.empty((0, 3))
        ours, own = rotate(conjugate(q_nb), _DOWN), rotate(conjugate(self._q_nb), _DOWN)
        return OwnView(
            self._position,
            self._q_nb,
            self._builder.trail(open_end),
            self._distance_m,
            math.hypot(self._position[0], self._position[1]),
            math.acos(min(1.0, max(-1.0, sum(a * b for a, b in zip(ours, own, strict=True))))),
            math.remainder(yaw_of(self._q_nb) - yaw_of(q_nb), math.tau),
        )
