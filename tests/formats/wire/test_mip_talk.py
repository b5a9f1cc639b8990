from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.mip import FASTEST_HZ, ORIENTATION, OVER_RANGE, MipDecoder, MipSetup, packet
from app.formats.wire.mip_talk import PING, MipDevice, start_up
from tests.formats.wire.protocols import at_rest, converse, result


@pytest.mark.parametrize("generation", [5, 7])
@pytest.mark.parametrize("lost", [0, 1, 2])
@pytest.mark.parametrize(
    ("wanted_hz", "base_hz", "got_hz"), [(100, 1000, 100.0), (400, 500, 500.0), (300, 1000, 1000 / 3)]
)
def test_the_start_chooses_rate_and_messages(
    generation: int, lost: int, wanted_hz: int, base_hz: int, got_hz
) -> None:
    device = MipDevice(generation=generation, base_hz=base_hz)
    samples = at_rest(400, step_ns=10**9 // base_hz)
    talk = converse(start_up(wanted_hz), device, samples, lost)
    setup = result(talk)
    assert isinstance(setup, MipSetup)
    assert setup.generation == generation
    assert setup.rate_hz == pytest.approx(got_hz)
    assert (setup.model, setup.serial, setup.firmware) == ("Emulated MIP", "0000.00001", "1001")
    assert {ORIENTATION, OVER_RANGE} < set(device.wanted)
    decoder = MipDecoder("foot", setup=setup)
    got = decoder.feed(talk.left_over + b"".join(map(device.measure, samples[-60:])), 0)
    assert len(got) == pytest.approx(60 * got_hz / base_hz, abs=1)
    assert got[-1].device_q_nb is not None
    assert decoder.counters.bytes_skipped == 0
    assert FASTEST_HZ >= got_hz


def test_a_sensor_that_refuses_the_extras_is_taken_without_them() -> None:
    class Plain(MipDevice):
        def _set_format(self, data: bytes) -> int:
            return 3 if OVER_RANGE in data[1::3] or ORIENTATION in data[1::3] else super()._set_format(data)

    device = Plain()
    assert result(converse(start_up(), device)).notes == ("this model sends no orientation of its own",)
    assert not {ORIENTATION, OVER_RANGE} & set(device.wanted)


@pytest.mark.parametrize(
    ("deaf_to", "sentence"),
    [
        (0x01, "no MIP sensor answers"),
        (0x0F, "refuses its message format: no answer"),
        (0x11, "does not stream: no answer"),
    ],
)
def test_what_fails_is_said(deaf_to: int, sentence: str) -> None:
    class Deaf(MipDevice):
        def receive(self, data: bytes) -> bytes:
            return b"" if data[5] == deaf_to else super().receive(data)

    talk = converse(start_up(), Deaf())
    assert talk.result is None
    assert sentence in talk.failed


def test_idle_stops_and_resume_streams() -> None:
    device, samples = MipDevice(base_hz=100), at_rest(4)
    assert device.measure(samples[0])
    assert device.receive(packet(1, (2, b""))) == bytes.fromhex("7565010404F10200D66C")
    assert device.measure(samples[1]) == b""
    device.receive(packet(1, (6, b"")))
    assert device.measure(samples[2])


def test_what_it_does_not_know_is_refused_and_a_bad_packet_not_answered() -> None:
    device = MipDevice()
    assert device.receive(packet(0x0C, (0x77, b"x"))) == packet(0x0C, (0xF1, b"\x77\x01"))
    assert device.receive(PING[:-1] + b"?") == b""


@given(st.lists(st.one_of(st.binary(max_size=30), st.just(PING)), max_size=8))
def test_any_commands_in_any_pieces_give_the_same_answers(pieces: list[bytes]) -> None:
    one, other = MipDevice(), MipDevice()
    assert b"".join(map(one.receive, pieces)) == other.receive(b"".join(pieces))
