"""Heart: `sim:gestures`, two feet that perform a script of gestures, and the truth about them.

Every bout has its own cadence, size, swing share and leading foot, and every action in it its own
again. The feet's motion is a sum of minimum-jerk steps: position, orientation, rates and
accelerations are closed forms of one another. No decoder's code is used.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from app.motion.basics import G_MPS2, Floats, InputError, MotionId
from app.motion.recording import Recording
from app.motion.samples import Samples
from app.motion.source import Truth
from app.simulate.foot import Motion, rotate_to_body
from app.simulate.gestures_actions import (
    Action,
    Draw,
    add_up,
    drawer,
    give,
    march,
    shift,
    step_back,
    tap,
    twist,
)
from app.simulate.gestures_options import GESTURES, Bar, GestureOptions, bars_of, parse, spec_of
from app.simulate.gestures_steps import Course, Steps, sum_of
from app.simulate.sensors import TABLE_II_NOISE, SensorErrors, ideal_readings, read
from app.simulate.walk import MOST_SAMPLES, sample_times_ns

FEET = ("left", "right")
#: What each foot does in each motion: left, right.
PARTS: Mapping[MotionId, tuple[str, str]] = {
    MotionId.FORWARD: ("march", "march"),
    MotionId.FORWARD_RIGHT: ("march", "twist"),
    MotionId.FORWARD_LEFT: ("twist", "march"),
    MotionId.SIDE_RIGHT: ("", "aside"),
    MotionId.SIDE_LEFT: ("aside", ""),
    MotionId.TURN_CW: ("", "twist"),
    MotionId.TURN_CCW: ("twist", ""),
    MotionId.BACKWARD: ("back", "back"),
}


@dataclass(frozen=True)
class Bout:
    """One gesture as performed: from the first foot's motion to the end of the last foot's."""

    motion: MotionId
    onset_s: float
    end_s: float
    cycle_s: float  # mean time from one action of a foot to its next
    cycles: float  # whole and half ones
    after_rest: bool  # False: another gesture ran straight into this one


@dataclass(frozen=True)
class GestureFoot:
    """One foot's six channels (``gestures_actions.CHANNELS``), and where its toe points at rest."""

    channels: Mapping[str, Steps]
    heading_rad: float

    def at(self, t_s: Floats) -> Motion:
        """The motion at these seconds [n]; position is from the foot's own start."""
        return motion_of([steps.at(t_s) for steps in self.channels.values()], self.heading_rad)


def motion_of(courses: Sequence[Course], heading_rad: float) -> Motion:
    """The motion of a foot from its six channels at n instants; its toe rests at this heading."""
    forward, right, up, yaw, pitch, roll = courses
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    place, velocity, acceleration = (
        np.column_stack([c * f - s * r, s * f + c * r, -u])
        for f, r, u in zip(forward, right, up, strict=True)
    )
    sr, cr = np.sin(roll.value), np.cos(roll.value)
    sp, cp = np.sin(pitch.value), np.cos(pitch.value)
    rate = np.column_stack(
        [
            roll.rate - yaw.rate * sp,
            pitch.rate * cr + yaw.rate * cp * sr,
            -pitch.rate * sr + yaw.rate * cp * cr,
        ]
    )
    q = _orientation(heading_rad + yaw.value, pitch.value, roll.value)
    return Motion(place, velocity, acceleration, q, rate)


@dataclass(frozen=True)
class SimulatedGestures:
    """What the sensors delivered, and what the feet really did."""

    recording: Recording
    truth: Truth
    feet: Mapping[str, GestureFoot]
    bouts: tuple[Bout, ...]
    options: GestureOptions


def make_gestures(options: Mapping[str, str]) -> SimulatedGestures:
    """The gestures that a SPEC's query asks for; ``InputError`` says what is wrong with it."""
    return simulate(parse(options))


def simulate(options: GestureOptions) -> SimulatedGestures:
    """Perform once. The same options give the same samples to the bit."""
    performer = Performer(options, np.random.default_rng([options.seed, 1]))
    for bar in _script(options, np.random.default_rng([options.seed, 2])):
        performer.perform(bar)
    if performer.now_s * options.rate_hz * 2 > MOST_SAMPLES:
        raise InputError(
            f"sim:gestures: {performer.now_s:.0f} s at {options.rate_hz:g} Hz: expected a shorter script"
        )
    elapsed_ns = sample_times_ns(performer.now_s, options.rate_hz)
    headings = {"left": -0.1, "right": 0.1}
    feet = {
        name: GestureFoot({c: sum_of(s) for c, s in add_up(performer.actions[name]).items()}, headings[name])
        for name in FEET
    }
    sensors = tuple(_sensor(name, foot, elapsed_ns, options) for name, foot in feet.items())
    recording = Recording("sim:gestures", "simulator", sensors, spec=spec_of(options))
    return SimulatedGestures(recording, partial(_truth, feet), feet, tuple(performer.bouts), options)


def _script(options: GestureOptions, rng: np.random.Generator) -> tuple[Bar, ...]:
    """The script's bars; ``random`` made definite: all gestures equally often, one in five without a rest."""
    bars = bars_of(options.script)
    if bars[0].what != "random":
        return bars
    count = max(1, round(bars[0].seconds))
    names = [name for _ in range(-(-count // len(GESTURES))) for name in rng.permutation(GESTURES)][:count]
    made = [Bar("none", 3.0)]
    for name in names:
        made.append(Bar(str(name), float(rng.uniform(4.0, 8.0)) / options.cadence_hz))
        if rng.random() > 0.2:
            made.append(Bar("none", float(rng.uniform(1.6, 3.0)) / min(options.cadence_hz, 1.0)))
    return (*made, Bar("none", 3.0))


class Performer:
    """Turns the script into actions of both feet, one bar after the other."""

    def __init__(self, options: GestureOptions, rng: np.random.Generator) -> None:
        self.options = options
        self.rng = rng
        self.draw: Draw = drawer(rng, options.vary)
        self.now_s = 0.0
        self.moved_s = 0.0  # when the last action ended
        self.rested = True
        self.actions: dict[str, list[Action]] = {name: [] for name in FEET}
        self.bouts: list[Bout] = []
        uneven = options.asymmetry * self.draw(-1.0, 1.0)
        self.size = {"left": 1.0 + 0.5 * uneven, "right": 1.0 - 0.5 * uneven}

    def perform(self, bar: Bar) -> None:
        """One entry of the script."""
        end = self.now_s + bar.seconds
        if bar.what in GESTURES:
            self._bout(MotionId[bar.what.upper()], end)
            self.rested = False
        elif bar.what == "none":
            self.rested = True
        else:
            self._pastime(bar.what, end)
            self.rested = True
        self.now_s = max(end, self.moved_s)

    def _bout(self, motion: MotionId, end_s: float) -> None:
        o, draw, t = self.options, self.draw, self.now_s
        if self.moved_s > t - 0.02:
            t = self.moved_s + draw(0.02, 0.2)
        cycle = draw(0.92, 1.08) / o.cadence_hz
        size = o.amplitude * draw(0.85, 1.15)
        share = draw(0.42, 0.56)
        feet = [FEET[i] for i in (0, 1) if PARTS[motion][i]]
        if len(feet) == 2 and self.rng.random() < 0.5:
            feet.reverse()
        between = 0.5 * cycle * (1.0 + 0.3 * o.asymmetry * draw(-1.0, 1.0))
        intervals = [between, cycle - between] if len(feet) == 2 else [cycle]
        starts: list[float] = []
        while len(starts) < 2 * len(feet) or t + share * cycle <= end_s:
            if starts and self.rng.random() < o.hesitation:
                t += cycle * draw(0.05, 0.25)
            foot = feet[len(starts) % len(feet)]
            duration = share * cycle * draw(0.95, 1.05)
            part = PARTS[motion][FEET.index(foot)]
            self.actions[foot].append(self._action(part, foot, t, duration, size * draw(0.75, 1.25)))
            self.actions[other_foot(foot)].append(
                give(t, duration, o.transient * min(1.0, 0.5 + 0.5 * size), draw)
            )
            starts.append(t)
            self.moved_s = t + duration
            t += intervals[(len(starts) - 1) % len(feet)] * draw(0.95, 1.05)
        cycles = (len(starts) - 1) / len(feet)
        mean = (starts[-1] - starts[0]) / cycles
        after_rest = self.rested or not self.bouts
        self.bouts.append(Bout(motion, starts[0], self.moved_s, mean, len(starts) / len(feet), after_rest))

    def _action(self, part: str, foot: str, t_s: float, duration_s: float, size: float) -> Action:
        amplitude = size * self.size[foot]
        return action_of(part, foot, t_s, duration_s, amplitude, self.draw, self.options.transient)

    def _pastime(self, what: str, end_s: float) -> None:
        """Taps of one foot, or the body's weight going to and fro."""
        draw, t = self.draw, max(self.now_s, self.moved_s)
        foot = FEET[int(self.rng.integers(2))]
        while True:
            duration = draw(0.2, 0.4) if what == "tap" else draw(0.8, 2.5)
            if t + duration > end_s:
                return
            if what == "tap":
                self.actions[foot].append(tap(t, duration, draw, self.options.transient))
            else:
                for each in FEET:
                    self.actions[each].append(shift(t, duration, draw))
            self.moved_s = t + duration
            t = self.moved_s + draw(0.05, 0.6)


def action_of(
    part: str, foot: str, t_s: float, duration_s: float, amplitude: float, draw: Draw, hard: float
) -> Action:
    """One action of a foot: its part in a gesture (``PARTS``)."""
    out = 1.0 if foot == "right" else -1.0
    if part == "twist":
        return twist(t_s, duration_s, amplitude, out, draw, hard)
    if part == "back":
        return step_back(t_s, duration_s, amplitude, draw, hard)
    aside = out * amplitude * draw(0.03, 0.2) if part == "aside" else 0.0
    return march(t_s, duration_s, amplitude, aside, draw, hard)


def other_foot(foot: str) -> str:
    """Left for right, right for left."""
    return FEET[1 - FEET.index(foot)]


def _sensor(name: str, foot: GestureFoot, elapsed_ns: Floats, options: GestureOptions) -> Samples:
    rng = np.random.default_rng([options.seed, 3, *name.encode()])
    t_s = elapsed_ns * 1e-9
    ideal = ideal_readings(foot.at(t_s), G_MPS2, None)
    turn = np.radians(options.mounting_deg) * rng.uniform(-1.0, 1.0, 3)
    mounted = np.repeat(_orientation(*(np.array([x]) for x in turn)), len(ideal), axis=0)
    ideal = np.hstack([rotate_to_body(mounted, ideal[:, i : i + 3]) for i in (0, 3, 6)])
    phase, slow = rng.uniform(0.0, 2.0 * np.pi, 3), rng.uniform(0.02, 0.1, 3)
    ideal[:, 3:6] += options.drift_radps * (
        rng.uniform(-1.0, 1.0, 3) + 0.3 * np.sin(slow * t_s[:, None] + phase)
    )
    noise = tuple(options.noise * usual for usual in TABLE_II_NOISE)
    errors = SensorErrors((noise[0], noise[1], noise[2]), ((0.0,) * 3,) * 3, (math.inf,) * 3, None, 0.0)
    return read(name, elapsed_ns, ideal, errors, options.seed)


def _truth(feet: Mapping[str, GestureFoot], sensor: str, t_s: Floats) -> tuple[Floats, Floats]:
    """The ``Truth`` of the gestures."""
    if sensor not in feet:
        raise ValueError(f"no sensor {sensor!r} in these gestures: expected one of {', '.join(feet)}")
    motion = feet[sensor].at(t_s)
    return motion.position_n, motion.q_nb


def _orientation(yaw: Floats, pitch: Floats, roll: Floats) -> Floats:
    """Yaw about down, then pitch about the new y, then roll about the new x: wxyz [n, 4]."""
    (cy, cp, cr), (sy, sp, sr) = (
        tuple(f(0.5 * np.asarray(angle)) for angle in (yaw, pitch, roll)) for f in (np.cos, np.sin)
    )
    return np.column_stack(
        [
            cy * cp * cr + sy * sp * sr,
            cy * cp * sr - sy * sp * cr,
            cy * sp * cr + sy * cp * sr,
            sy * cp * cr - cy * sp * sr,
        ]
    )
