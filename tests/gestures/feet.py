"""Simulated feet for the decoders' tests, and a reading of one's own."""

from __future__ import annotations

from functools import cache

from app.gestures.words import FootReading
from app.motion.basics import Role, Vector
from app.motion.samples import Samples
from app.simulate.gestures import SimulatedGestures, make_gestures

LEVEL: Vector = (0.0, 0.0, -9.80665)


@cache
def performed(script: str, **options: str) -> SimulatedGestures:
    return make_gestures({"script": script, **options})


def feet_of(made: SimulatedGestures) -> dict[Role, Samples]:
    return {samples.role: samples for samples in made.recording.sensors}


def still(foot: Role, t_s: float, rate: Vector = (0.0, 0.0, 0.0)) -> FootReading:
    return FootReading(foot, round(t_s * 1e9), LEVEL, rate)
