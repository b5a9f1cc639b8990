from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.ximu3 import Ximu3Decoder
from app.formats.wire.ximu3_talk import Ximu3Device, command, start_up
from tests.formats.wire.protocols import at_rest, converse, result


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("lost", [0, 1, 2])
def test_the_start_asks_who_and_chooses_the_rate(binary: bool, lost: int) -> None:
    device, samples = Ximu3Device(binary=binary), at_rest(400, step_ns=2_500_000)
    talk = converse(start_up(200.0), device, samples, lost)
    setup = result(talk)
    assert (setup.name, setup.serial, setup.rate_hz) == ("emulated", "0123-4567", 200.0)
    decoder = Ximu3Decoder("foot")
    got = decoder.feed(talk.left_over + b"".join(map(device.measure, samples[-100:])), 0)
    assert len(got) == pytest.approx(50, abs=1)
    assert sum(sample.field_b is not None for sample in got) == pytest.approx(5, abs=1)
    assert all(sample.device_q_nb is not None for sample in got)


def test_silence_fails_in_one_sentence() -> None:
    class Dead(Ximu3Device):
        def receive(self, data: bytes) -> bytes:
            return b""

    assert "no x-IMU3 answers" in converse(start_up(), Dead()).failed


def test_a_setting_is_read_written_and_answered_with_its_key() -> None:
    device = Ximu3Device()
    assert device.receive(b'{"deviceName":null}\r\n') == b'{"deviceName":"emulated"}\r\n'
    assert device.receive(b'{"deviceName":') == b""
    assert json.loads(device.receive(b'"left"}\n')) == {"deviceName": "left"}
    assert device.receive(command("strobe", None)) == command("strobe", None)
    assert device.receive(b'{"a":1,"b":2}\n[]\nnonsense\n') == b""


@given(st.lists(st.one_of(st.binary(max_size=40), st.just(command("ping", None))), max_size=6))
def test_any_commands_in_any_pieces_give_the_same_answers(pieces: list[bytes]) -> None:
    one, other = Ximu3Device(), Ximu3Device()
    assert b"".join(map(one.receive, pieces)) == other.receive(b"".join(pieces))
