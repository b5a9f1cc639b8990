from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.mounting import AS_GIVEN
from app.formats.wire.gx1 import EULER, LENGTHS, QUATERNION, VECTORS, Gx1Decoder, Gx1Setup, frames, holds
from app.formats.wire.gx1_talk import FACTORY, FASTEST, Gx1Device, start_up, version
from app.motion.basics import G_MPS2
from app.rotation import from_yaw_pitch_roll
from tests.formats.wire.protocols import at_rest, converse, result

TILTED = from_yaw_pitch_roll(1.0, 0.3, 0.2)


def tilted(count: int):
    """A still shoe, tilted, so that a quaternion and its inverse differ."""
    w, x, y, z = TILTED
    down = (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z)
    force = (-G_MPS2 * down[0], -G_MPS2 * down[1], -G_MPS2 * down[2])
    return at_rest(count, force, TILTED, 20_000_000)


@pytest.mark.parametrize("reports_gravity", [False, True])
@pytest.mark.parametrize("earth_to_body", [False, True])
@pytest.mark.parametrize("lost", [0, 1, 2])
def test_the_start_finds_calibration_and_settles_the_signs(
    reports_gravity: bool, earth_to_body: bool, lost: int
) -> None:
    device = Gx1Device(AS_GIVEN, FACTORY | {130: 9876, 230: 7654, 232: 1987}, reports_gravity, earth_to_body)
    device.receive(b"\x10\x00\x0c")  # left streaming by someone
    samples = tilted(200)
    talk = converse(start_up(), device, samples, lost)
    assert talk.failed == ""
    assert isinstance(talk.result, Gx1Setup)
    setup = talk.result
    assert (setup.gyro_gain, setup.accel_gain, setup.mag_gain) == (9876, 7654, 1987)
    assert (setup.serial, setup.firmware, setup.tick_ns) == ("1234", "3.1.02", 6_553_600)
    assert (setup.reports_gravity, setup.earth_to_body) == (reports_gravity, earth_to_body)
    decoder = Gx1Decoder("foot", setup=setup)
    got = decoder.feed(talk.left_over + b"".join(map(device.measure, samples[-50:])), 0)
    assert len(got) == 50
    np.testing.assert_allclose(got[-1].specific_force_b, samples[-1].specific_force_b, atol=0.003)
    np.testing.assert_allclose(got[-1].device_q_nb or (), TILTED, atol=3e-4)
    assert decoder.counters.bytes_skipped == 0


def test_a_sped_up_clock_is_left_to_be_measured() -> None:
    talk = converse(start_up(), Gx1Device(eeprom=FASTEST))
    assert result(talk).tick_ns is None
    talk = converse(start_up(), Gx1Device(eeprom=FASTEST | {246: 1}))
    assert result(talk).tick_ns == 1_000_000


def test_what_could_not_be_read_or_seen_is_said() -> None:
    class Forgetful(Gx1Device):
        def receive(self, data: bytes) -> bytes:
            return b"" if data[:1] in (b"\x28", b"\x0b") else super().receive(data)

    talk = converse(start_up(), Forgetful())
    assert (result(talk).accel_gain, result(talk).gyro_gain, result(talk).mag_gain) == (7000, 8500, 2000)
    assert sum("assumed: EEPROM" in note for note in result(talk).notes) == 3
    assert any("sign could not be seen" in note for note in result(talk).notes)
    assert result(talk).tick_ns is None


def test_silence_fails_in_one_sentence() -> None:
    class Dead(Gx1Device):
        def receive(self, data: bytes) -> bytes:
            return b""

    talk = converse(start_up(), Dead())
    assert talk.result is None
    assert "no 3DM-GX1 answers" in talk.failed


def test_every_command_is_answered_at_its_length() -> None:
    device = Gx1Device()
    arguments = {
        0x0F: b"\xc1\xc3\xc5",
        0x10: b"\0\x0c",
        0x11: b"\xc1\xc3\xc5",
        0x28: b"\0\x82",
        0x40: b"\x71\x3e",
    }
    arguments |= {0x29: b"\x71\x00\x2c\x00\x15\xaa"}
    # arguments or meaning of these nobody knows, or they need the iron collected before
    for code in LENGTHS.keys() - {0x24, 0x25, 0x41, 0x42}:
        reply = device.receive(bytes([code]) + arguments.get(code, b""))
        assert len(reply) == LENGTHS[code], hex(code)
        assert reply[0] == code
        assert holds(reply)
    assert device.receive(b"\x00\x55\xff") == b""


def test_old_and_new_eeprom_commands() -> None:
    device = Gx1Device()
    assert device.receive(b"\x08\x82") == (10000).to_bytes(2)
    assert device.receive(b"\x09\x71\x82\x21\x34\xaa") == bytes.fromhex("2134")
    assert device.receive(b"\x28\x00\x82")[1:3] == bytes.fromhex("2134")
    assert device.receive(b"\x29\x70\x00\x82\x00\x00\xaa") == b"", "without its key nothing is written"
    assert device.eeprom[130] == 8500


def test_continuous_mode_streams_until_stopped_and_answers_polls_between() -> None:
    device = Gx1Device()
    samples = at_rest(20, step_ns=20_000_000)
    assert device.measure(samples[0]) == b""
    assert device.receive(b"\x10\x00\x31")[:3] == b"\x10\x00\x31"
    stream = device.measure(samples[1]) + device.receive(b"\x02") + device.measure(samples[2])
    assert [message[0] for message in frames().feed(stream)] == [EULER, 0x02, EULER]
    device.receive(b"\x10\x00\x03")
    assert device.measure(samples[3])[0] == VECTORS
    assert device.receive(b"\x10\x00\x99") == b""
    device.receive(b"\x10\x00\x00")
    assert device.measure(samples[4]) == b""


def test_auto_start_and_the_rate_that_its_ticks_allow() -> None:
    device = Gx1Device(eeprom=FACTORY | {132: QUATERNION})
    fast = [sample._replace(device_ns=i * 1_000_000) for i, sample in enumerate(at_rest(1000))]
    sent = [message for sample in fast if (message := device.measure(sample))]
    assert len(sent) == pytest.approx(50.9, abs=1.5)  # three ticks of 6.5536 ms
    device.receive(b"\x10\x00\x03")
    assert device.rate_hz == pytest.approx(76.3, abs=0.01)
    assert Gx1Device(eeprom=FASTEST).rate_hz == pytest.approx(1000 / 3)


@given(st.lists(st.binary(max_size=30)))
def test_any_commands_in_any_pieces_give_the_same_answers(pieces: list[bytes]) -> None:
    one, other = Gx1Device(), Gx1Device()
    assert b"".join(map(one.receive, pieces)) == other.receive(b"".join(pieces))


def test_versions_read_as_printed() -> None:
    assert version(3102) == "3.1.02"
    assert math.isclose(Gx1Device.FIRMWARE, 3102)
