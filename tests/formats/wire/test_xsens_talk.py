from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.xsens import QUATERNION, XsensDecoder, XsensSetup, message
from app.formats.wire.xsens_talk import GO_TO_CONFIG, GO_TO_MEASUREMENT, XsensDevice, start_up
from tests.formats.wire.protocols import at_rest, converse, result


@pytest.mark.parametrize("lost", [0, 1, 2])
@pytest.mark.parametrize(("wanted_hz", "got_hz"), [(100, 100), (800, 400)])
def test_the_start_configures_and_measures(lost: int, wanted_hz: int, got_hz: int) -> None:
    device, samples = XsensDevice(), at_rest(200)
    talk = converse(start_up(wanted_hz), device, samples, lost)
    setup = result(talk)
    assert isinstance(setup, XsensSetup)
    assert (setup.rate_hz, setup.serial, setup.firmware) == (got_hz, "03800123", "1.8.2")
    assert setup.product == "MTi-300-emulated"
    assert len(setup.notes) == (wanted_hz != got_hz)
    decoder = XsensDecoder("foot", setup=setup)
    got = decoder.feed(talk.left_over + b"".join(map(device.measure, samples[-50:])), 0)
    assert len(got) == 50
    assert got[-1].device_q_nb is not None
    assert (decoder.counters.lost, decoder.counters.bytes_skipped) == (0, 0)


def test_a_model_without_orientation() -> None:
    class Plain(XsensDevice):
        _able = XsensDevice._able - {QUATERNION}

    device = Plain()
    assert result(converse(start_up(), device)).rate_hz == 100
    assert QUATERNION not in device.wanted


@pytest.mark.parametrize(
    ("deaf_to", "sentence"),
    [(GO_TO_CONFIG, "no Xsens MTi answers"), (0xC0, "does not offer"), (GO_TO_MEASUREMENT, "does not start")],
)
def test_what_fails_is_said(deaf_to: int, sentence: str) -> None:
    class Deaf(XsensDevice):
        def receive(self, data: bytes) -> bytes:
            return b"" if data[2] == deaf_to else super().receive(data)

    talk = converse(start_up(), Deaf())
    assert talk.result is None
    assert sentence in talk.failed


def test_config_mode_is_silent_and_only_there_is_it_configured() -> None:
    device, (sample, later) = XsensDevice(), at_rest(2)
    assert device.receive(message(0x12))[2] == 0x42
    assert device.measure(sample)
    assert device.receive(message(GO_TO_CONFIG)) == message(GO_TO_CONFIG + 1)
    assert device.measure(later) == b""
    assert device.receive(message(0x40)) == message(0x41) + message(0x3E)


@given(st.lists(st.one_of(st.binary(max_size=30), st.just(message(GO_TO_CONFIG))), max_size=8))
def test_any_commands_in_any_pieces_give_the_same_answers(pieces: list[bytes]) -> None:
    one, other = XsensDevice(), XsensDevice()
    assert b"".join(map(one.receive, pieces)) == other.receive(b"".join(pieces))
