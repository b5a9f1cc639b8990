"""Heart: simulated feet that do what they are asked, now: the keyboard's and the stroller's feet.

The same actions as `sim:gestures`, planned one at a time; what the sensors read is a closed form of
the actions under way.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from app.motion.basics import G_MPS2, Floats, MotionId, Vector
from app.motion.samples import Sample
from app.simulate.gestures import FEET, PARTS, action_of, motion_of, other_foot
from app.simulate.gestures_actions import CHANNELS, Action, add_up, drawer, give
from app.simulate.gestures_options import GestureOptions
from app.simulate.gestures_steps import Course, sum_of
from app.simulate.sensors import TABLE_II_NOISE, ideal_readings

_TAIL_S = 0.1  # the sole may ring so long after an action; then all is back where it began
_PROMPT_S = 0.02


class Sampled(NamedTuple):
    """An action at the samples from number ``first`` on: [6 channels, 3, n]; at rest before and after."""

    first: int
    table: Floats

    @property
    def end(self) -> int:
        """One past its last sample."""
        return self.first + int(self.table.shape[2])


def _sum(actions: list[Sampled], first: int, count: int) -> list[Course]:
    """The six channels of all actions under way, for ``count`` samples from number ``first`` on."""
    total = np.zeros((len(CHANNELS), 3, count))
    for action in actions:
        low, high = max(first, action.first), min(first + count, action.end)
        if low < high:
            total[:, :, low - first : high - first] += action.table[
                :, :, low - action.first : high - action.first
            ]
    return [Course(*channel) for channel in total]


class LiveFeet:
    """Two feet and their sensors. Times are seconds on one clock that starts at 0."""

    def __init__(self, options: GestureOptions) -> None:
        self.options = options
        self._rng = np.random.default_rng([options.seed, 5])
        self._draw = drawer(self._rng, options.vary)
        self._wanted, self._turn_size = MotionId.NONE, 1.0
        self._doing = MotionId.NONE
        self._turn = 0  # which foot of the gesture is next
        self._next_s = 0.0
        self._busy_s = 0.0  # when the last action ends
        self._actions: dict[str, list[Sampled]] = {name: [] for name in FEET}
        self._sent = 0

    def ask(self, motion: MotionId, turn_size: float = 1.0) -> None:
        """What the feet are to do from now on; ``turn_size`` scales a twist: turning is graded by it."""
        self._wanted, self._turn_size = motion, turn_size

    def pace(self, cadence_hz: float, amplitude: float) -> None:
        """How fast and how lively, from the next action on."""
        if (cadence_hz, amplitude) != (self.options.cadence_hz, self.options.amplitude):
            self.options = replace(self.options, cadence_hz=cadence_hz, amplitude=amplitude)

    def advance(self, to_s: float, start_ns: int, host_ns: int) -> list[Sample]:
        """Both sensors' samples up to ``to_s``, in the order of time; stamps count from ``start_ns``."""
        end = max(self._sent, int(to_s * self.options.rate_hz) + 1)
        t_s = np.arange(self._sent, end) / self.options.rate_hz
        if len(t_s) == 0:
            return []
        for now_s in t_s.tolist():
            self._plan(now_s)
        readings = {name: self._readings(name, len(t_s)) for name in FEET}
        made = []
        for i, t in enumerate(t_s.tolist()):
            stamp = start_ns + round(t * 1e9)
            for name in FEET:
                made.append(Sample(name, self._sent + i, stamp, host_ns, *_split(readings[name][i])))
        self._sent = end
        self._forget(float(t_s[-1]))
        return made

    def _plan(self, now_s: float) -> None:
        """Begin the actions whose time has come: they start a moment after ``now_s``."""
        if self._wanted is not self._doing:
            self._doing, self._turn = self._wanted, int(self._rng.integers(2))
            self._next_s = max(self._busy_s + self._draw(0.02, 0.08), now_s + _PROMPT_S)
        parts = PARTS.get(self._doing)
        while parts is not None and self._next_s <= now_s + _PROMPT_S:
            self._act(parts, max(self._next_s, now_s))

    def _act(self, parts: tuple[str, str], start_s: float) -> None:
        o, draw = self.options, self._draw
        feet = [name for name, part in zip(FEET, parts, strict=True) if part]
        foot = feet[self._turn % len(feet)]
        part = parts[FEET.index(foot)]
        cycle = draw(0.95, 1.05) / o.cadence_hz
        duration = 0.48 * cycle * draw(0.95, 1.05)
        size = o.amplitude * draw(0.9, 1.1) * (self._turn_size if part == "twist" else 1.0)
        action = action_of(part, foot, start_s, duration, size, draw, o.transient)
        self._begin(foot, action, start_s, duration)
        sway = give(start_s, duration, o.transient * min(1.0, 0.5 + 0.5 * size), draw)
        self._begin(other_foot(foot), sway, start_s, duration)
        self._turn += 1
        self._busy_s = start_s + duration
        self._next_s = start_s + cycle / len(feet)

    def _begin(self, foot: str, action: Action, start_s: float, duration_s: float) -> None:
        """Work the whole action out at the samples that it will meet."""
        rate = self.options.rate_hz
        first, count = math.floor(start_s * rate), math.ceil((duration_s + _TAIL_S) * rate) + 2
        t_s = np.arange(first, first + count) / rate
        courses = [sum_of(steps).at(t_s) for steps in add_up([action]).values()]
        self._actions[foot].append(Sampled(first, np.array([list(course) for course in courses])))

    def _readings(self, name: str, count: int) -> Floats:
        """What the sensor reads at the next samples, [n, 6]."""
        courses = _sum(self._actions[name], self._sent, count)
        ideal = ideal_readings(motion_of(courses, 0.0), G_MPS2, None)[:, :6]
        noise = np.repeat(np.array(TABLE_II_NOISE[:2]) * self.options.noise, 3)
        return np.asarray(ideal + noise * self._rng.standard_normal(ideal.shape))

    def _forget(self, now_s: float) -> None:
        for name, actions in self._actions.items():
            self._actions[name] = [action for action in actions if action.end > now_s * self.options.rate_hz]


def _split(row: Floats) -> tuple[Vector, Vector]:
    fx, fy, fz, wx, wy, wz = row.tolist()
    return (fx, fy, fz), (wx, wy, wz)
