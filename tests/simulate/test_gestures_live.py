"""Feet that do what they are asked: heard as that by the decoder, and still when nothing is asked."""

from __future__ import annotations

import numpy as np
import pytest

from app.gestures.default import DefaultDecoder
from app.gestures.words import Decision, FootReading
from app.motion.basics import MotionId, Role
from app.motion.samples import Sample
from app.simulate.gestures_live import LiveFeet
from app.simulate.gestures_options import GestureOptions


def performed(feet: LiveFeet, seconds: float, start_s: float = 0.0, frame_s: float = 1 / 60) -> list[Sample]:
    made = []
    for k in range(round(seconds / frame_s)):
        made += feet.advance(start_s + (k + 1) * frame_s, 0, 0)
    return made


def heard(samples: list[Sample], decoder: DefaultDecoder) -> list[Decision]:
    found = (
        decoder.take(FootReading(Role(s.sensor), s.device_ns, s.specific_force_b, s.angular_rate_b))
        for s in samples
    )
    return [decision for decision in found if decision is not None]


@pytest.mark.parametrize("motion", [motion for motion in MotionId if motion])
def test_every_gesture_is_understood_and_ends(motion: MotionId) -> None:
    feet, decoder = LiveFeet(GestureOptions(seed=3)), DefaultDecoder()
    heard(performed(feet, 1.5), decoder)
    feet.ask(motion)
    heard(performed(feet, 4.0, 1.5), decoder)
    assert decoder.now.motion is motion
    assert decoder.now.certain
    feet.ask(MotionId.NONE)
    heard(performed(feet, 3.0, 5.5), decoder)
    assert decoder.now.motion is MotionId.NONE


def test_turning_is_graded_by_the_twist() -> None:
    turns = []
    for size in (0.4, 0.7, 1.0):
        feet, decoder = LiveFeet(GestureOptions(seed=1, vary=0.3)), DefaultDecoder()
        heard(performed(feet, 1.0), decoder)
        feet.ask(MotionId.TURN_CW, size)
        said = heard(performed(feet, 6.0, 1.0), decoder)
        turns.append(np.median([d.turn_radps for d in said if d.certain and d.motion is MotionId.TURN_CW]))
    assert turns[0] < turns[1] < turns[2]


def test_samples_come_at_their_rate_whatever_the_frames() -> None:
    feet = LiveFeet(GestureOptions(rate_hz=100.0))
    made = [*performed(feet, 1.0, frame_s=0.05), *performed(feet, 1.0, 1.0, frame_s=1 / 144)]
    left = [s.device_ns for s in made if s.sensor == "left"]
    assert len(left) == pytest.approx(200, abs=2)
    np.testing.assert_allclose(np.diff(left), 10_000_000, atol=1)
    assert [s.seq for s in made if s.sensor == "right"] == list(range(len(left)))


def test_a_foot_that_is_asked_nothing_reads_gravity() -> None:
    made = performed(LiveFeet(GestureOptions(noise=0.0)), 1.0)
    force = np.array([s.specific_force_b for s in made])
    np.testing.assert_allclose(force, np.tile([0.0, 0.0, -9.80665], (len(made), 1)), atol=1e-9)
