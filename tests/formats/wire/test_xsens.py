from __future__ import annotations

import math
import struct

import numpy as np
import pytest

from app.formats.wire.xsens import MTDATA2, QUATERNION, XsensDecoder, XsensEncoder, data_of, holds, message
from app.motion.samples import Sample
from tests.formats.wire.protocols import at_rest

PRINTED = (
    "FA FF 30 00 D1",
    "FA FF 10 00 F1",
    "FA FF C0 14 1020FFFF 1060FFFF 40200064 80200064 C0200064 85",
    "FA FF 36 14 102002 0007 40200C 00000000 00000000 411CF5C3 FD",
)
ACC, GYR = struct.pack(">3f", 0, 0, 9.81), struct.pack(">3f", 0.1, 0.2, 0.3)


def item(kind: int, data: bytes) -> bytes:
    return kind.to_bytes(2) + bytes([len(data)]) + data


@pytest.mark.parametrize("printed", PRINTED)
def test_the_printed_messages(printed: str) -> None:
    data = bytes.fromhex(printed)
    assert holds(data)
    assert message(data[2], data_of(data)) == data


def test_the_printed_data_has_no_rate_so_is_no_sample() -> None:
    decoder = XsensDecoder("foot")
    assert decoder.feed(bytes.fromhex(PRINTED[3]), 0) == []
    assert decoder.counters.unknown == 1


def test_z_up_is_turned_down() -> None:
    (sample,) = XsensDecoder("foot").feed(message(MTDATA2, item(0x4020, ACC) + item(0x8020, GYR)), 0)
    np.testing.assert_allclose(sample.specific_force_b, (0, 0, -9.81), rtol=1e-6)
    np.testing.assert_allclose(sample.angular_rate_b, (0.1, -0.2, -0.3), rtol=1e-6)


@pytest.mark.parametrize(
    ("form", "pack", "bound"),
    [
        (0, lambda v: struct.pack(">f", v), 1e-6),
        (1, lambda v: struct.pack(">i", round(v * 2**20)), 1e-6),
        (2, lambda v: (lambda b: b[2:] + b[:2])(struct.pack(">q", round(v * 2**32))[2:]), 1e-9),
        (3, lambda v: struct.pack(">d", v), 0.0),
    ],
)
def test_every_number_format(form: int, pack, bound: float) -> None:
    numbers = (1.25, -9.81, 100.5)
    data = item(0x4020 | form, b"".join(map(pack, numbers))) + item(0x8020, GYR)
    (sample,) = XsensDecoder("foot").feed(message(MTDATA2, data), 0)
    x, y, z = sample.specific_force_b
    np.testing.assert_allclose((x, -y, -z), numbers, atol=bound, rtol=bound)


@pytest.mark.parametrize(("nibble", "heading_deg"), [(0x0, 90.0), (0x4, 0.0), (0x8, 0.0)])
def test_every_earth_frame(nibble: int, heading_deg: float) -> None:
    """The sensor's x points along the frame's first axis: east, north or north."""
    level = (1.0, 0, 0, 0) if nibble != 4 else (0.0, 1.0, 0, 0)  # z up, also where the frame's z is down
    data = item(0x4020, ACC) + item(0x8020, GYR) + item(QUATERNION | nibble, struct.pack(">4f", *level))
    (sample,) = XsensDecoder("foot").feed(message(MTDATA2, data), 0)
    assert sample.device_q_nb is not None
    w, x, y, z = sample.device_q_nb
    assert math.degrees(2 * math.atan2(z, w)) % 360 == pytest.approx(heading_deg, abs=1e-4)
    assert math.hypot(x, y) < 1e-6


def test_the_counter_counts_what_is_lost_and_wraps() -> None:
    encoder, decoder = XsensEncoder(), XsensDecoder("foot")
    for i, count in enumerate((65_533, 65_534, 1, 2, 9)):
        (sample,) = at_rest(1)
        sample = sample._replace(seq=count, device_ns=i * 10_000_000)
        assert len(decoder.feed(encoder.encode(sample), i * 10_000_000)) == 1
    assert decoder.counters.lost == 2 + 6


def test_long_messages_and_clip_flags() -> None:
    filler = item(0xFF10, bytes(200)) + item(0xFF20, bytes(100))
    whole = message(
        MTDATA2, filler + item(0xE020, (0b100001 << 8).to_bytes(4)) + item(0x4020, ACC) + item(0x8020, GYR)
    )
    assert whole[3] == 0xFF
    (sample,) = XsensDecoder("foot").feed(whole, 0)
    assert sample.saturation == 0b100001


def test_the_fine_time_wraps() -> None:
    encoder, decoder = XsensEncoder(), XsensDecoder("foot")
    start_ns = (2**32 - 500) * 100_000
    got = []
    for i in range(20):
        sample = Sample("foot", i, start_ns + i * 10_000_000, 0, (0.0, 0.0, -9.8), (0.0, 0.0, 0.0))
        got += decoder.feed(encoder.encode(sample), i * 10_000_000)
    assert set(np.diff([sample.device_ns for sample in got])) == {10_000_000}
