from __future__ import annotations

import math

import numpy as np
import pytest

from app.formats.wire.gx1 import (
    EULER,
    FACTORY_TICK_NS,
    QUATERNION,
    VECTORS,
    Gx1Decoder,
    Gx1Encoder,
    Gx1Setup,
    framed,
)
from app.motion.basics import G_MPS2
from app.motion.samples import Sample
from tests.formats.wire.protocols import FLOAT32, GX1_SETUP, at_rest

RATE = (0.5, -1.0, 2.0)
FORCE = (0.1 * G_MPS2, -0.2 * G_MPS2, 1.0 * G_MPS2)
VECTORS_1000 = bytes.fromhex("03 0CCD 0000 199A 0182 FCFD 0F0F 0666 F333 199A 03E8 4B13")
EULER_1001 = bytes.fromhex("31 071C F1C7 4000 0182 FCFD 0F0F 0666 F333 199A 03E9 5DBE")


def sample_at(ticks: int, q=None) -> Sample:
    return Sample("foot", 0, ticks * FACTORY_TICK_NS, 0, FORCE, RATE, (20.0, 0.0, 40.0), 0, q)


def test_the_vectors_message() -> None:
    (sample,) = Gx1Decoder("foot", setup=GX1_SETUP).feed(VECTORS_1000, 5)
    np.testing.assert_allclose(sample.specific_force_b, FORCE, atol=0.0014)
    np.testing.assert_allclose(sample.angular_rate_b, RATE, atol=0.0002)
    np.testing.assert_allclose(sample.field_b or (), (20.0, 0.0, 40.0), atol=0.004)
    assert (sample.device_ns, sample.host_ns) == (1000 * FACTORY_TICK_NS, 5)
    assert Gx1Encoder(setup=GX1_SETUP).message(VECTORS, sample_at(1000)) == VECTORS_1000


def test_the_euler_message() -> None:
    (sample,) = Gx1Decoder("foot", setup=GX1_SETUP).feed(EULER_1001, 5)
    roll, pitch, yaw = (0.5 * math.radians(angle) for angle in (10, -20, 90))
    assert sample.field_b is None
    assert sample.device_q_nb is not None
    w = math.cos(roll) * math.cos(pitch) * math.cos(yaw) + math.sin(roll) * math.sin(pitch) * math.sin(yaw)
    assert sample.device_q_nb[0] == pytest.approx(w, abs=1e-4)
    assert Gx1Encoder(setup=GX1_SETUP).message(EULER, sample_at(1001, sample.device_q_nb)) == EULER_1001


@pytest.mark.parametrize(
    "reply",
    ["05 2000 0000 0000 0000 03EA 23EF", "28 2134 03EB 2547", "F1 04D2 05C3", "F0 0C1E 0D0E"],
)
def test_replies_that_carry_no_sample_are_sound_and_known(reply: str) -> None:
    data = bytes.fromhex(reply)
    words = [int.from_bytes(data[i : i + 2]) for i in range(1, len(data) - 2, 2)]
    assert framed(data[0], *words) == data
    decoder = Gx1Decoder("foot", setup=GX1_SETUP)
    assert decoder.feed(data, 0) == []
    assert (decoder.counters.packets, decoder.counters.unknown) == (1, 1)


def test_the_checksum_sums_words_not_bytes() -> None:
    wrong = VECTORS_1000[:-2] + (sum(VECTORS_1000[:-2]) & 0xFFFF).to_bytes(2)
    decoder = Gx1Decoder("foot", setup=GX1_SETUP)
    assert decoder.feed(wrong, 0) == []
    assert decoder.counters.bad_checksum >= 1


def test_gains_scale_and_the_ancestor_has_its_own() -> None:
    one, two = Gx1Setup(7000, 8500, 2000).scales(), Gx1Setup(3500, 4250, 1000).scales()
    np.testing.assert_allclose(one, 2 * np.array(two))
    assert one[0] * 32768 == pytest.approx(7.0 * G_MPS2, rel=0.001)
    assert one[1] * 32768 == pytest.approx(8.5, rel=0.001)
    old = Gx1Setup(gyro_gain=64)
    assert old.is_3dm_g
    np.testing.assert_allclose(old.scales(), (G_MPS2 / 8192, 1 / (64 * 8192 * 0.0065536), 1 / 8192))


def test_a_unit_that_reports_gravity_is_turned_about() -> None:
    (sample,) = Gx1Decoder("foot", setup=Gx1Setup(8500, 10000, 2000, 1, reports_gravity=True)).feed(
        VECTORS_1000, 0
    )
    assert sample.specific_force_b[2] == pytest.approx(-G_MPS2, abs=0.002)


def test_both_directions_of_the_quaternion() -> None:
    q = (math.cos(0.3), 0.0, 0.0, math.sin(0.3))
    for earth_to_body in (True, False):
        setup = Gx1Setup(tick_ns=FACTORY_TICK_NS, earth_to_body=earth_to_body)
        data = Gx1Encoder(setup=setup).encode(sample_at(3, q))
        codes = [int.from_bytes(data[i : i + 2], signed=True) for i in range(1, 9, 2)]
        assert codes[3] == round((-1 if earth_to_body else 1) * 8192 * math.sin(0.3))
        (sample,) = Gx1Decoder("foot", setup=setup).feed(data, 0)
        np.testing.assert_allclose(sample.device_q_nb or (), q, atol=1e-4)


def test_sensors_clip_before_the_wire_and_are_flagged() -> None:
    hard = Sample("foot", 0, 0, 0, (80.0, 0.0, -9.8), (0.0, -9.0, 0.0), (20.0, 0.0, 40.0))
    (sample,) = Gx1Decoder("foot", setup=GX1_SETUP).feed(Gx1Encoder(setup=GX1_SETUP).encode(hard), 0)
    assert sample.specific_force_b[0] == pytest.approx(5 * G_MPS2, abs=0.002)
    assert sample.angular_rate_b[1] == pytest.approx(-math.radians(300), abs=0.001)
    assert sample.saturation == 1 | 1 << 4


@pytest.mark.parametrize("tick_ms", [1.0, 3.0, 6.5536, 10.0])
def test_an_unknown_tick_is_measured_before_any_sample_is_given(tick_ms: float) -> None:
    tick_ns = round(tick_ms * 1e6)
    encoder = Gx1Encoder(setup=Gx1Setup(8500, 10000, 2000, tick_ns))
    decoder = Gx1Decoder("foot", setup=Gx1Setup(8500, 10000, 2000))
    # the tick runs 100 ppm slow, and the samples come in bursts
    sent = [sample._replace(device_ns=sample.device_ns) for sample in at_rest(700)]
    got: list[Sample] = []
    for sample in sent:
        data = encoder.message(QUATERNION, sample)
        host_ns = int(sample.device_ns * 1.0001) // 16_000_000 * 16_000_000
        got += decoder.feed(data, host_ns)
        assert not got or host_ns >= 5_000_000_000
    assert len(got) == 700
    stamps = np.array([sample.device_ns for sample in got])
    assert np.abs(stamps - [sample.device_ns for sample in sent]).max() <= tick_ns / 2 + FLOAT32
    assert [note for note in decoder.notes if "measured and known" in note]


def test_the_clock_wraps_after_seven_minutes() -> None:
    encoder, decoder = Gx1Encoder(setup=GX1_SETUP), Gx1Decoder("foot", setup=GX1_SETUP)
    start_ns = 65_500 * FACTORY_TICK_NS
    got = []
    for i in range(100):
        sample = sample_at(0)._replace(device_ns=start_ns + i * 10_000_000)
        got += decoder.feed(encoder.encode(sample), i * 10_000_000)
    assert len(got) == 100
    np.testing.assert_allclose(np.diff([s.device_ns for s in got]), 1e7, atol=FACTORY_TICK_NS)
    assert got[-1].device_ns - got[0].device_ns == pytest.approx(990e6, abs=FACTORY_TICK_NS)
