"""MOVESMover's four bytes."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.gestures.packet import decode, encode, packet_of
from app.gestures.words import Decision, standing
from app.motion.basics import MotionId


@given(st.sampled_from(MotionId), st.floats(-30.0, 30.0))
def test_a_packet_reads_back_to_the_millimetre(motion: MotionId, speed: float) -> None:
    read, mps = decode(encode(motion, speed))
    assert read == motion
    assert mps == pytest.approx(speed, abs=0.5e-3 + 1e-12)


def test_it_is_big_endian_motion_first() -> None:
    assert encode(MotionId.TURN_CW, 1.2) == bytes([0, 6, 4, 176])
    assert packet_of(Decision(0, MotionId.FORWARD, 0.258, 0.0, 1.0, True, 1.0, "")) == bytes([0, 1, 1, 2])
    assert packet_of(standing(0, "")) == bytes(4)


@pytest.mark.parametrize(
    ("speed", "said"), [(1e5, 32.767), (-1e5, -32.767), (math.nan, 0.0), (math.inf, 0.0)]
)
def test_what_does_not_fit_is_kept_within(speed: float, said: float) -> None:
    assert decode(encode(MotionId.FORWARD, speed))[1] == said


@given(st.binary(max_size=8))
def test_any_bytes_are_a_packet_or_refused(data: bytes) -> None:
    try:
        motion, speed = decode(data)
    except ValueError:
        return
    assert encode(motion, speed)[:2] == data[:2]
