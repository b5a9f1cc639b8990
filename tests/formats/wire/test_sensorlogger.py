"""Pushes of the Sensor Logger app: joined by their times, in any order, of either system's signs."""

from __future__ import annotations

import itertools
import json
import math
import random
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.formats.mounting import parse_axes
from app.formats.wire.message import Malformed, Message
from app.formats.wire.sensorlogger import ON_TOP, Phone, Push, parse
from app.motion.basics import G_MPS2
from app.motion.samples import Sample

START = 1_700_000_000_000_000_000
STEP = 10_000_000


def rate_at(t: float) -> tuple[float, float, float]:
    return (0.2 * t, -0.1 * t, 0.05)


def entry(name: str, stamp: int, x: float, y: float, z: float) -> dict[str, Any]:
    return {"name": name, "time": stamp, "values": {"x": x, "y": y, "z": z}, "accuracy": 3}


def pushes(
    count: int, sign: float = 1.0, unit: float = 1.0, split: bool = True, session: str = "s"
) -> list[dict[str, Any]]:
    """A phone flat on a shoe, 100 readings a second, ten a message; the gyroscope measures 3 ms later."""
    made = []
    for number in range(count):
        payload = []
        for i in range(10 * number, 10 * number + 10):
            t = START + i * STEP
            force = (0.01 * i, 0.5, G_MPS2)
            x, y, z = (sign * v / unit for v in force)
            if split:
                payload += [entry("accelerometer", t, x, y, 0.0), entry("gravity", t, 0.0, 0.0, z)]
            else:
                payload.append(entry("accelerometeruncalibrated", t, x, y, z))
            payload.append(entry("gyroscope", t + 3_000_000, *rate_at((t + 3_000_000 - START) * 1e-9)))
            payload.append(entry("barometer", t, 1.0, 2.0, 3.0))
        payload.append(entry("magnetometer", START + 10 * number * STEP, 1.0, 20.0, -40.0))
        made.append({"messageId": number, "sessionId": session, "deviceId": "d", "payload": payload})
    return made


def joined(phone: Phone, bodies: list[dict[str, Any]]) -> list[Sample]:
    got: list[Sample] = []
    for body in bodies:
        pushed = parse(json.dumps(body))
        assert isinstance(pushed, Push)
        message = phone.push(pushed, 0)
        got += message.samples if message else []
    return got


def check(got: list[Sample]) -> None:
    assert [s.seq for s in got] == list(range(len(got)))
    for s in got:
        t = (s.device_ns - START) * 1e-9
        wx, wy, wz = rate_at(t)
        np.testing.assert_allclose(s.specific_force_b, (0.5, t, -G_MPS2), atol=1e-6)
        np.testing.assert_allclose(s.angular_rate_b, (wy, wx, -wz), atol=1e-9)
        assert s.field_b == (20.0, 1.0, 40.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_gravity_and_motion_are_added_and_the_sign_is_told_by_standing(sign: float) -> None:
    phone = Phone("left")
    got = joined(phone, pushes(20, sign))
    check(got)
    assert len(got) >= 197
    assert any("iOS" in note for note in phone.notes) == (sign < 0)


@pytest.mark.parametrize(("sign", "unit"), [(-1.0, G_MPS2), (1.0, 1.0)])
def test_the_uncalibrated_ones_unit_is_told_by_its_size(sign: float, unit: float) -> None:
    phone = Phone("left")
    got = joined(phone, pushes(20, sign, unit, split=False))
    check(got)
    assert any("in g" in note for note in phone.notes) == (unit != 1.0)


@settings(max_examples=20)
@given(st.integers(0, 10**6))
def test_messages_out_of_order_and_twice_give_the_same(seed: int) -> None:
    bodies = pushes(15)
    dice = random.Random(seed)
    for i in range(1, len(bodies) - 1):
        if dice.random() < 0.4:
            bodies[i], bodies[i + 1] = bodies[i + 1], bodies[i]
    bodies = [body for body in bodies for _ in range(dice.choice([1, 1, 2]))]
    phone = Phone("left")
    got = joined(phone, bodies)
    check(got)
    assert all(a.device_ns < b.device_ns for a, b in itertools.pairwise(got))
    assert len(got) >= 100


def test_a_missing_message_is_waited_for_and_then_counted() -> None:
    bodies = pushes(20)
    del bodies[8]
    phone = Phone("left")
    got = joined(phone, bodies)
    check(got)
    assert phone.missing == 1
    gaps = [b.device_ns - a.device_ns for a, b in itertools.pairwise(got)]
    assert max(gaps) >= 9 * STEP
    assert len(got) >= 185


def test_a_new_session_begins_anew() -> None:
    phone = Phone("left")
    first, second = joined(phone, pushes(10)), joined(phone, pushes(10, session="again"))
    assert first[0].seq == second[0].seq == 0


def test_a_phone_that_does_not_sit_as_was_said_is_told_of() -> None:
    phone = Phone("left", parse_axes("z,x,y"))
    joined(phone, pushes(10))
    assert any("axes=" in note for note in phone.notes)


def test_the_usual_seat_is_screen_up_top_edge_to_the_toe() -> None:
    assert parse_axes("y,x,-z") == ON_TOP


values = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4)
entries = st.fixed_dictionaries(
    {},
    optional={
        "name": st.sampled_from(["accelerometer", "gravity", "gyroscope", "Magnetometer", "x"]) | values,
        "time": st.integers(0, 2**64) | values,
        "values": st.dictionaries(st.sampled_from("xyz"), values | st.floats(-9, 9), max_size=3) | values,
    },
)


@given(st.lists(st.tuples(st.integers(0, 9) | values, st.lists(entries | values, max_size=12)), max_size=8))
def test_any_pushes_give_finite_samples_or_none(told: list[tuple[Any, list[Any]]]) -> None:
    phone = Phone("left")
    for number, payload in told:
        pushed = parse(json.dumps({"messageId": number, "payload": payload}))
        if isinstance(pushed, Malformed):
            continue
        message = phone.push(pushed, 0)
        if isinstance(message, Message):
            assert all(math.isfinite(sum(s.specific_force_b + s.angular_rate_b)) for s in message.samples)


@given(
    st.binary(max_size=100)
    | st.text(max_size=100)
    | st.sampled_from(["[1]", "{}", '{"payload":1}', "[" * 9999])
)
def test_anything_else_is_refused_in_words(data: bytes | str) -> None:
    assert isinstance(parse(data), Malformed)
