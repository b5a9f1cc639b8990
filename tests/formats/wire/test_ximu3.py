from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.faults import Faults, Line
from app.formats.wire.making import Z_UP
from app.formats.wire.ximu3 import (
    Ximu3Decoder,
    Ximu3Encoder,
    ascii_message,
    binary_message,
    frames,
    holds,
    parse,
)
from app.motion.basics import G_MPS2
from app.motion.samples import Sample
from tests.formats.wire.protocols import at_rest

BINARY = bytes.fromhex("C9 DBDD DBDC 000000000000 0000803F 00000040 00004040 00000000 00000000 0000803F 0A")
ASCII = b"I,2779,1.0000,2.0000,3.0000,0.0000,0.0000,1.0000\r\n"


@pytest.mark.parametrize("message", [BINARY, ASCII, ASCII.replace(b"\r", b"")], ids=["binary", "CR LF", "LF"])
def test_the_printed_message_and_its_ascii_twins(message: bytes) -> None:
    assert parse(message) == ("I", 0x0ADB, (1.0, 2.0, 3.0, 0.0, 0.0, 1.0))
    (sample,) = Ximu3Decoder("foot").feed(message, 0)
    assert sample.device_ns == 0x0ADB * 1000
    np.testing.assert_allclose(sample.specific_force_b, (0, 0, -G_MPS2))
    np.testing.assert_allclose(sample.angular_rate_b, np.radians([1, -2, -3]))


def test_the_printed_message_is_what_is_sent() -> None:
    assert binary_message("I", 0x0ADB, (1, 2, 3, 0, 0, 1)) == BINARY
    assert ascii_message("I", 0x0ADB, (1, 2, 3, 0, 0, 1)) == ASCII


@given(
    st.sampled_from("IMHQRATBWYOLE"),
    st.integers(0, 2**64 - 1),
    st.lists(st.floats(width=32, allow_nan=False), min_size=9, max_size=9),
)
def test_any_numbers_survive_the_stuffing(kind: str, micros: int, numbers: list[float]) -> None:
    count = {"I": 6, "Q": 4, "R": 9, "T": 1, "W": 2, "Y": 1, "O": 1, "L": 7, "E": 3}.get(kind, 3)
    message = binary_message(kind, micros, tuple(numbers[:count]))
    assert message.count(b"\n") == 1
    assert parse(message) == (kind, micros, tuple(numbers[:count]))


@pytest.mark.parametrize(
    "message",
    [
        b"I,1,1,2,3,4,5\n",  # a number short
        b"I,x,1,2,3,4,5,6\n",
        b"I,1,1,2,3,4,5,1_0\n",
        b"Z,1,1\n",
        BINARY[:-2] + b"\n",
        b"\xc9\xdb\x00" + bytes(31) + b"\n",  # no such escape
        b"{nonsense\n",
        b"[1]\n",
        b"^\n",
    ],
)
def test_what_is_no_message(message: bytes) -> None:
    assert not holds(message)


@pytest.mark.parametrize(
    "message", [b'{"ping":null}\r\n', b"N,5,Hello, foot\r\n", b"^A" + ASCII, b"B,1,80.0,3.9,2\n"]
)
def test_what_is_a_message_and_no_sample(message: bytes) -> None:
    decoder = Ximu3Decoder("foot")
    assert decoder.feed(message + ASCII, 0) != []
    assert (decoder.counters.unknown, decoder.counters.bytes_skipped) == (1, 0)


def test_field_and_quaternion_go_with_the_next_sample_and_no_other() -> None:
    decoder, encoder = Ximu3Decoder("foot"), Ximu3Encoder()
    first, second = at_rest(2)
    (one,) = decoder.feed(encoder.encode(first), 0)
    (two,) = decoder.feed(encoder.inertial(second), 0)
    assert one.field_b is not None
    assert one.device_q_nb is not None
    assert (two.field_b, two.device_q_nb) == (None, None)


@pytest.mark.parametrize("numbers", [(9e9, 0, 0, 0, 0, 1), (0, 0, 0, 0, 0, 60), (math.nan, 0, 0, 0, 0, 1)])
def test_the_impossible_is_dropped(numbers: tuple[float, ...]) -> None:
    decoder = Ximu3Decoder("foot")
    assert decoder.feed(binary_message("I", 5, numbers), 0) == []
    assert decoder.counters.dropped == 1


def test_deep_json_is_only_rubbish() -> None:
    stream = frames()
    stream.feed(b'{"a":' + b"[" * 1000 + b"\n" + ASCII)
    assert stream.counters.packets == 1


def test_a_lost_byte_of_an_ascii_message_is_told_by_its_decimals() -> None:
    """They have no checksum: of one hundred bytes one is lost, and most often it is a decimal."""
    rng = np.random.default_rng(5)
    encoder, decoder = Ximu3Encoder(Z_UP, binary=False), Ximu3Decoder("foot")
    line, sent, got = Line(Faults(lost=0.01), 3), [], []
    for i in range(4000):
        force, turn = rng.normal(0.0, 8.0, 3), rng.normal(0.0, 2.0, 3)
        sample = Sample("foot", i, i * 10_000_000, 0, tuple(force), tuple(turn))
        message = encoder.inertial(sample)
        sent += Ximu3Decoder("foot").feed(message, 0)
        samples = decoder.feed(message if i < 500 else line.carry(message), i * 10_000_000)
        got += samples
    true = {(s.specific_force_b, s.angular_rate_b) for s in sent}
    false = sum((s.specific_force_b, s.angular_rate_b) not in true for s in got)
    assert len(got) > 2500
    assert false <= 0.15 * (len(got) - 500)
    assert decoder.counters.bad_checksum > 500
