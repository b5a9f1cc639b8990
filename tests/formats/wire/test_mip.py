from __future__ import annotations

import struct

import numpy as np
import pytest

from app.formats.wire.mip import (
    ACCEL,
    GYRO,
    OLD_TICKS,
    SHARED_GPS_TIME,
    MipDecoder,
    MipEncoder,
    MipSetup,
    fields_of,
    fletcher,
    packet,
)
from app.motion.basics import G_MPS2
from app.motion.samples import Sample

COMMANDS = (
    "7565 01 02 02 01 E0C6",
    "7565 01 02 02 02 E1C7",
    "7565 01 04 04 F1 02 00 D66C",
    "7565 01 02 02 03 E2C8",
    "7565 01 02 02 06 E5CB",
    "7565 0C 02 02 06 F0F7",
    "7565 0C 03 03 0E 80 7A7E",
    "7565 0C 10 10 08 01 04 120005 040005 050005 060005 48DF",
    "7565 0C 11 11 0F 01 80 04 D50005 040005 050005 060005 94A5",
    "7565 0C 05 05 11 01 01 01 041A",
    "7565 0C 05 05 11 01 80 01 8318",
)
DATA = bytes.fromhex(
    "7565 80 26 0E04 00000000 00000000 BF800000 0E05 3DCCCCCD 3E4CCCCD 3E99999A 0AD5 000000003B9ACA00 3166"
)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_printed_commands(command: str) -> None:
    data = bytes.fromhex(command)
    assert fletcher(data[:-2]) == data[-2:]
    assert packet(data[2], *fields_of(data)) == data


def test_the_printed_data_packet() -> None:
    (sample,) = MipDecoder("foot").feed(DATA, 0)
    assert sample.device_ns == 1_000_000_000
    np.testing.assert_allclose(sample.specific_force_b, (0, 0, -G_MPS2))
    np.testing.assert_allclose(sample.angular_rate_b, (0.1, 0.2, 0.3), rtol=1e-7)
    assert sample.field_b is None
    sent = MipEncoder().message(sample, [ACCEL, GYRO, 0xD5])
    assert sent == DATA


def test_acknowledgements_inside_the_stream_are_no_samples() -> None:
    decoder = MipDecoder("foot")
    ack = bytes.fromhex(COMMANDS[2])
    assert len(decoder.feed(ack + DATA + ack, 0)) == 1
    assert (decoder.counters.packets, decoder.counters.unknown) == (3, 2)


@pytest.mark.parametrize(("kind", "step_ns"), [(SHARED_GPS_TIME, 10_000_000), (OLD_TICKS, 10_000_000)])
def test_other_clocks(kind: int, step_ns: int) -> None:
    encoder, decoder = MipEncoder(), MipDecoder("foot")
    start_ns = (2**32 - 30) * 16_000 // 1000 * 1000  # the old ticks wrap on the way
    got = []
    for i in range(200):
        sample = Sample("foot", 0, start_ns + i * step_ns, 0, (0.0, 0.0, -G_MPS2), (0.0, 0.0, 0.0))
        got += decoder.feed(encoder.message(sample, [kind, ACCEL, GYRO]), i * step_ns)
    assert len(got) == 200
    np.testing.assert_allclose(np.diff([sample.device_ns for sample in got]), step_ns, atol=16_000)


def test_the_best_clock_is_taken_and_none_is_mixed_in() -> None:
    sample = Sample("foot", 0, 7_000_000_000, 0, (0.0, 0.0, -G_MPS2), (0.0, 0.0, 0.0))
    encoder, decoder = MipEncoder(), MipDecoder("foot")
    (got,) = decoder.feed(encoder.message(sample, [OLD_TICKS, ACCEL, GYRO, 0xD5]), 0)
    assert got.device_ns == 7_000_000_000
    later = sample._replace(device_ns=7_010_000_000)
    assert decoder.feed(encoder.message(later, [OLD_TICKS, ACCEL, GYRO]), 0) == []
    assert decoder.counters.dropped == 1


def test_without_a_clock_arrivals_stamp_and_that_is_said() -> None:
    encoder, decoder = MipEncoder(), MipDecoder("foot", setup=MipSetup(rate_hz=100.0))
    sample = Sample("foot", 0, 0, 0, (0.0, 0.0, -G_MPS2), (0.0, 0.0, 0.0))
    data = encoder.message(sample, [ACCEL, GYRO])
    stamps = [s.device_ns for i in range(10) for s in decoder.feed(data, 5 + i * 10_000_000)]
    assert stamps == [5 + i * 10_000_000 for i in range(10)]
    assert decoder.notes == ["its messages carry no time: samples are stamped by their arrival"]


def test_over_range_flags_become_saturation() -> None:
    data = packet(
        0x80,
        (ACCEL, struct.pack(">3f", 0, 0, -1)),
        (GYRO, bytes(12)),
        (0x18, (0x1 | 0x40 | 0x200 | 0x1000).to_bytes(2)),
    )
    (sample,) = MipDecoder("foot").feed(data, 0)
    assert sample.saturation == 1 << 0 | 1 << 5 | 1 << 7


def test_fields_that_do_not_fit_are_left_out() -> None:
    assert fields_of(packet(0x80, (1, b"ab"))[:4] + b"\x09\x01ab" + b"??") == []
    assert fields_of(b"\x75\x65\x80\x02\x00\x00??") == []
