"""Our own message: what goes in comes out, in both forms, and nothing else does."""

from __future__ import annotations

import json
import math
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire import message as msg
from app.formats.wire.message import Malformed, Message, decode, encode_binary, encode_json
from app.motion.samples import Sample

numbers = st.floats(-1e6, 1e6, allow_nan=False)
vectors = st.tuples(numbers, numbers, numbers)
angles = st.floats(-math.pi, math.pi)


def turned(angle: float) -> tuple[float, float, float, float]:
    return (math.cos(angle), 0.6 * math.sin(angle), 0.0, 0.8 * math.sin(angle))


@st.composite
def batches(draw: st.DrawFn) -> list[Sample]:
    name = draw(st.from_regex(msg.NAME, fullmatch=True))
    first = draw(st.integers(0, msg.MOST_SEQ - 10))
    stamps = sorted(draw(st.sets(st.integers(0, msg.MOST_NS - 1), min_size=1, max_size=6)))
    return [
        Sample(
            name,
            first + i,
            stamp,
            77,
            draw(vectors),
            draw(vectors),
            draw(st.none() | vectors),
            draw(st.integers(0, 511)),
            draw(st.none() | angles.map(turned)),
        )
        for i, stamp in enumerate(stamps)
    ]


sessions = st.integers(0, 2**64 - 1)


def nearly(a: Sample, b: Sample, relative: float) -> None:
    assert a[:4] == b[:4]
    assert a.saturation == b.saturation
    for mine, yours in zip(a, b, strict=True):
        assert (mine is None) == (yours is None)
        if isinstance(mine, tuple) and isinstance(yours, tuple):
            np.testing.assert_allclose(mine, yours, rtol=relative, atol=1e-37 if relative else 0)


@given(sessions, batches())
def test_doubles_and_json_keep_every_bit_of_a_reading(session: int, sent: list[Sample]) -> None:
    for data in (encode_binary(session, sent, doubles=True), encode_json(session, sent)):
        got = decode(data, 77)
        assert isinstance(got, Message)
        assert (got.session, got.temperature_c) == (session, None)
        assert [s._replace(device_q_nb=None) for s in got.samples] == [
            s._replace(device_q_nb=None) for s in sent
        ]
        for a, b in zip(got.samples, sent, strict=True):
            nearly(a, b, 1e-9)


@given(sessions, batches(), st.floats(-50, 125, width=32))
def test_a_temperature_goes_with_its_samples(session: int, sent: list[Sample], celsius: float) -> None:
    for doubles in (False, True):
        data = encode_binary(session, sent, doubles, celsius)
        assert len(data) == len(encode_binary(session, sent, doubles)) + 4
        got, without = decode(data, 77), decode(encode_binary(session, sent, doubles), 77)
        assert got == without._replace(temperature_c=celsius)  # type: ignore[call-arg]
    assert decode(encode_json(session, sent, celsius), 7).temperature_c == celsius  # type: ignore[union-attr]


@pytest.mark.parametrize("celsius", [math.nan, math.inf, -60.0, 300.0])
def test_a_message_with_an_impossible_temperature_is_damaged(celsius: float) -> None:
    for data in (encode_binary(1, [SAMPLE], False, celsius), encode_json(1, [SAMPLE], celsius)):
        got = decode(data, 0)
        assert isinstance(got, Malformed)
        assert "temperature" in got.why


@given(sessions, batches())
def test_single_precision_keeps_seven_digits(session: int, sent: list[Sample]) -> None:
    got = decode(encode_binary(session, sent), 77)
    assert isinstance(got, Message)
    for a, b in zip(got.samples, sent, strict=True):
        nearly(a._replace(device_q_nb=None), b._replace(device_q_nb=None), 2.0**-23)
        if a.device_q_nb and b.device_q_nb:
            assert abs(np.dot(a.device_q_nb, b.device_q_nb)) > 1 - 1e-6


@given(st.binary(max_size=200) | st.text(max_size=100) | st.binary(max_size=200).map(lambda b: msg.MAGIC + b))
def test_any_bytes_are_refused_in_words(data: bytes | str) -> None:
    got = decode(data, 0)
    assert isinstance(got, Malformed)
    assert got.why


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=8,
)


@given(batches(), st.lists(st.tuples(st.integers(0, 100), st.text(max_size=5), json_values), max_size=3))
def test_any_edit_of_an_object_is_a_message_or_a_reason(sent: list[Sample], edits: Any) -> None:
    told = json.loads(encode_json(5, sent, 21.5))
    for place, key, value in edits:
        targets = [told, *told["samples"]] if isinstance(told["samples"], list) else [told]
        target = targets[place % len(targets)]
        if isinstance(target, dict):
            keys = [*target, key]
            target[keys[place % len(keys)]] = value
            told.setdefault("samples", [])
    check(decode(json.dumps(told), 3))


@given(
    batches(),
    st.lists(st.tuples(st.integers(0, 9999), st.integers(0, 255)), max_size=8),
    st.integers(0, 9),
    st.none() | st.floats(-50, 125),
)
def test_any_edit_of_bytes_is_a_message_or_a_reason(
    sent: list[Sample], edits: Any, cut: int, celsius: float | None
) -> None:
    data = bytearray(encode_binary(5, sent, temperature_c=celsius))
    for place, byte in edits:
        data[place % len(data)] = byte
    check(decode(bytes(data[: len(data) - cut]), 3))


def check(got: Message | Malformed) -> None:
    """All that is believed of a message holds."""
    if isinstance(got, Malformed):
        assert got.why
        return
    assert got.temperature_c is None or -50.0 <= got.temperature_c <= 125.0
    assert [s.seq for s in got.samples] == list(range(got.samples[0].seq, got.samples[-1].seq + 1))
    assert all(a.device_ns < b.device_ns for a, b in zip(got.samples, got.samples[1:], strict=False))
    for sample in got.samples:
        assert np.isfinite([*sample.specific_force_b, *sample.angular_rate_b, *(sample.field_b or ())]).all()
        assert 0 <= sample.saturation < 512
        assert sample.device_q_nb is None or abs(np.linalg.norm(sample.device_q_nb) - 1) < 1e-6


SAMPLE = Sample("left", 3, 10, 0, (0.0, 0.0, -9.8), (0.1, 0.2, 0.3))


def test_the_bytes_are_those_of_the_document() -> None:
    head = b"STRD\x01\x00\x01\x00" + struct.pack("<QQ", 0x1234, 3) + b"left" + bytes(12)
    assert encode_binary(0x1234, [SAMPLE]) == head + struct.pack("<q6f", 10, 0, 0, -9.8, 0.1, 0.2, 0.3)
    assert json.loads(encode_json(0x1234, [SAMPLE])) == {
        "v": 1,
        "session": "1234",
        "sensor": "left",
        "seq": 3,
        "samples": [{"t_ns": 10, "f": [0.0, 0.0, -9.8], "w": [0.1, 0.2, 0.3]}],
    }


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"v": 2}, "v:"),
        ({"v": True}, "v:"),
        ({"session": 7}, "session"),
        ({"session": "0x1"}, "session"),
        ({"sensor": "left foot"}, "sensor"),
        ({"seq": -1}, "seq"),
        ({"seq": 1.5}, "seq"),
        ({"samples": []}, "samples"),
        ({"samples": [{"t_ns": 1.0}]}, "t_ns"),
        ({"samples": [{"t_ns": 1, "f": [1, 2], "w": [1, 2, 3]}]}, "f: expected three"),
        ({"samples": [{"t_ns": 1, "f": [1, 2, 3], "w": [1, 2, True]}]}, "w: expected three"),
        ({"samples": [{"t_ns": 1, "f": [1, 2, 3], "w": [1, 2, 3], "m": 5}]}, "m, q"),
        ({"samples": [{"t_ns": 1, "f": [1, 2, 3], "w": [1, 2, 3], "sat": 512}]}, "sat"),
        ({"samples": [{"t_ns": 1, "f": [1, 2, 10**400], "w": [1, 2, 3]}]}, "f: expected three"),
        ({"temp_c": "warm"}, "temp_c"),
        ({"temp_c": True}, "temp_c"),
        ({"temp_c": 10**400}, "temperature"),
        ({"samples": [{"t_ns": -1, "f": [1, 2, 3], "w": [1, 2, 3]}]}, "t_ns"),
        ({"samples": 2 * [{"t_ns": 1, "f": [1, 2, 3], "w": [1, 2, 3]}]}, "increase"),
    ],
)
def test_a_refusal_names_what_is_wrong(change: dict[str, Any], named: str) -> None:
    got = decode(json.dumps(json.loads(encode_json(1, [SAMPLE])) | change), 0)
    assert isinstance(got, Malformed)
    assert named in got.why


@pytest.mark.parametrize("number", ["NaN", "Infinity", "1e999"])
def test_numbers_that_are_not_finite_are_refused(number: str) -> None:
    text = encode_json(1, [SAMPLE]).replace("-9.8", number)
    assert isinstance(decode(text, 0), Malformed)


def test_nesting_without_end_and_size_without_end_are_refused() -> None:
    assert isinstance(decode("[" * 60_000, 0), Malformed)
    assert isinstance(decode(b" " * (msg.MOST_BYTES + 1), 0), Malformed)


@pytest.mark.parametrize("doubles", [False, True])
def test_what_is_said_to_fit_fits(doubles: bool) -> None:
    full = SAMPLE._replace(field_b=(1.0, 2.0, 3.0), device_q_nb=(1.0, 0.0, 0.0, 0.0), saturation=1)
    count = msg.fitting(1400, doubles)
    sent = [full._replace(seq=i, device_ns=i) for i in range(count + 1)]
    assert len(encode_binary(1, sent[:-1], doubles, 20.0)) <= 1400 < len(encode_binary(1, sent, doubles))
