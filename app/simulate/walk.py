"""Heart: `sim:walk`, a walk whose truth is known at any instant.

Footprints are laid along a course, a gait joins them, sensors read the motion and err. Nothing here
integrates: position, velocity, acceleration, orientation and rate are closed forms of one another,
so that an estimator can be held against them. The estimators' code is never used.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from app.motion.basics import Floats, InputError
from app.motion.recording import Recording
from app.motion.samples import Column, Samples
from app.motion.source import Truth
from app.simulate.course import TREAD_M, Course, Places, course_of
from app.simulate.foot import FootMotion, Swing, Timing, join_footprints
from app.simulate.gait import FLAT_SHARE, papers_gait, papers_reach, smooth_gait
from app.simulate.options import WalkOptions, parse, spec_of
from app.simulate.sensors import MICROTESLA_PER_GAUSS, Iron, errors_of, ideal_readings, read

#: Where a sensor walks, to the right of the path.
_BESIDE_M = {"foot": 0.0, "left": -0.1, "right": 0.1}
MOST_SAMPLES = 20_000_000


@dataclass(frozen=True)
class SimulatedWalk:
    """What the sensors delivered, and what really happened, for each sensor by name."""

    recording: Recording
    truth: Truth
    feet: Mapping[str, FootMotion]
    options: WalkOptions


@dataclass(frozen=True)
class Plan:
    """How far, in how many strides and for how long: the options made definite."""

    distance_m: float
    strides: int
    duration_s: float

    @property
    def stride_m(self) -> float:
        """The stride that divides the distance evenly."""
        return self.distance_m / self.strides


def make_walk(options: Mapping[str, str]) -> SimulatedWalk:
    """The walk that a SPEC's query asks for; ``InputError`` says what is wrong with it."""
    return simulate(parse(options))


def simulate(options: WalkOptions) -> SimulatedWalk:
    """Walk once. The same options give the same samples to the bit."""
    course = course_of(options)
    plan = plan_of(options, course)
    feet = {sensor: _foot(sensor, options, course, plan) for sensor in _sensors(options)}
    elapsed_ns = sample_times_ns(plan.duration_s, options.rate_hz)
    sensors = tuple(
        _read(sensor, foot, elapsed_ns, options, _iron(sensor, options, course, plan))
        for sensor, foot in feet.items()
    )
    recording = Recording("sim:walk", "simulator", sensors, spec=spec_of(options))
    return SimulatedWalk(recording, partial(_truth, feet), feet, options)


def plan_of(options: WalkOptions, course: Course) -> Plan:
    """Strides that fill the path: the nearest whole number, so that closed paths close."""
    stride = options.stride_m or (2 * TREAD_M if options.path == "stairs" else 1.2)
    around = options.still_s + options.end_s
    extra = options.feet - 1  # the second foot ends a cycle later: both begin and end side by side
    strides, distance = options.strides, options.distance_m
    if options.duration_s is not None:
        strides = math.floor((options.duration_s - around) / options.cycle_s) - extra
        if strides < 1:
            raise InputError(
                f"sim:walk: duration_s={options.duration_s:g}: expected at least"
                f" {around + (1 + extra) * options.cycle_s:g}, for standing still and one stride"
            )
    if strides is not None:
        distance = strides * stride
    elif distance is None:
        distance = 120.0 if options.path == "straight" else (options.laps or 1) * course.length_m
    strides = strides or max(1, round(distance / stride))
    duration = options.duration_s or around + (strides + extra) * options.cycle_s
    if duration * options.rate_hz * options.feet > MOST_SAMPLES:
        raise InputError(
            f"sim:walk: {duration:.0f} s at {options.rate_hz:g} Hz: expected at most {MOST_SAMPLES} samples:"
            " walk less far or sample more slowly"
        )
    return Plan(distance, strides, duration)


def sample_times_ns(duration_s: float, rate_hz: float) -> Floats:
    """Whole nanoseconds of every sample, from 0 to the duration."""
    count = math.floor(duration_s * rate_hz * (1.0 + 1e-12)) + 1
    stamps: Floats = np.rint(np.arange(count) * (1e9 / rate_hz))
    return stamps


def _sensors(options: WalkOptions) -> tuple[str, ...]:
    return ("foot",) if options.feet == 1 else ("left", "right")


def _foot(sensor: str, options: WalkOptions, course: Course, plan: Plan) -> FootMotion:
    """One foot's footprints and gait. The left of two begins with half a stride and ends with half of one."""
    along = plan.stride_m * np.arange(plan.strides + 1, dtype=np.float64)
    if sensor == "left":
        along = np.concatenate(([0.0], 0.5 * (along[1:] + along[:-1]), along[-1:]))
    late = 0.5 if sensor == "right" else 0.0
    heel_off = options.still_s + (FLAT_SHARE + late) * options.cycle_s
    places = _places(course, along, _BESIDE_M[sensor], options)
    return join_footprints(*places, Timing(heel_off, options.cycle_s), _swing(options))


def _swing(options: WalkOptions) -> Swing:
    if options.model == "papers":
        return Swing(papers_gait, 0.25 if options.lift_m is None else options.lift_m, papers_reach())
    return Swing(smooth_gait, 0.1 if options.lift_m is None else options.lift_m, 1.0)


def _places(course: Course, along_m: Floats, beside_m: float, options: WalkOptions) -> Places:
    """Points to the right of the course, turned to the start heading."""
    position, heading = course.places(along_m)
    turn = math.radians(options.heading_deg)
    c, s = math.cos(turn), math.sin(turn)
    north = position[:, 0] - beside_m * np.sin(heading)
    east = position[:, 1] + beside_m * np.cos(heading)
    turned = np.column_stack([c * north - s * east, s * north + c * east, position[:, 2]])
    return Places(turned, heading + turn)


def _iron(sensor: str, options: WalkOptions, course: Course, plan: Plan) -> Iron | None:
    """The magnet, from this foot's own start."""
    if options.iron_gauss_m3 == 0.0:
        return None
    along = np.array([options.iron_along * plan.distance_m])
    where = _places(course, along, options.iron_beside_m, options)
    start = _places(course, np.zeros(1), _BESIDE_M[sensor], options)
    return Iron((where.position_n - start.position_n)[0], options.iron_gauss_m3 * MICROTESLA_PER_GAUSS)


def _read(
    sensor: str, foot: FootMotion, elapsed_ns: Floats, options: WalkOptions, iron: Iron | None
) -> Samples:
    ideal = ideal_readings(foot.at(elapsed_ns * 1e-9), options.gravity_mps2, iron)
    samples = read(sensor, elapsed_ns, ideal, errors_of(options), options.seed)
    if not options.magnetometer:
        samples.matrix[:, Column.MX :] = np.nan
        samples.saturation[:] &= 0b111111
    return samples


def _truth(feet: Mapping[str, FootMotion], sensor: str, t_s: Floats) -> tuple[Floats, Floats]:
    """The ``Truth`` of the walk."""
    if sensor not in feet:
        raise ValueError(f"no sensor {sensor!r} in this walk: expected one of {', '.join(feet)}")
    motion = feet[sensor].at(t_s)
    return motion.position_n, motion.q_nb
