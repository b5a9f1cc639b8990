from __future__ import annotations

import math

import numpy as np
import pytest

from app.formats.wire.witmotion import (
    ACCEL,
    ANGLES,
    GYRO,
    MAG,
    SAVE,
    TIME,
    UNLOCK,
    WitmotionDecoder,
    WitmotionDevice,
    WitmotionEncoder,
    framed,
    holds,
    start_up,
)
from app.motion.basics import G_MPS2
from app.motion.samples import GAP_NS, Sample
from tests.formats.wire.protocols import at_rest, converse, result

ONE_G = bytes.fromhex("55 51 0000 0000 0008 C409 7B")
SPIN = bytes.fromhex("55 52 0000 0000 0020 C409 94")
FIELD, LEAN = framed(MAG, bytes(8)), framed(ANGLES, bytes(8))
DAY_NS = 86_400 * 10**9


def test_the_printed_frames() -> None:
    assert holds(ONE_G)
    assert holds(SPIN)
    decoder = WitmotionDecoder("foot")
    (sample,) = decoder.feed(ONE_G + SPIN + ONE_G, 0)
    np.testing.assert_allclose(sample.specific_force_b, (0, 0, -G_MPS2), atol=1e-12)
    np.testing.assert_allclose(sample.angular_rate_b, (0, 0, -math.radians(500)), atol=1e-12)


def test_a_burst_waits_for_no_other_once_its_end_is_known() -> None:
    decoder = WitmotionDecoder("foot")
    burst = ONE_G + SPIN + LEAN + FIELD
    assert [len(decoder.feed(burst, i)) for i in range(4)] == [0, 2, 1, 1]


def test_a_stream_joined_in_the_middle_gives_the_next_whole_burst() -> None:
    decoder = WitmotionDecoder("foot")
    assert [len(decoder.feed(data, 0)) for data in (LEAN + FIELD, ONE_G + SPIN, LEAN, FIELD)] == [0, 0, 0, 1]


@pytest.mark.parametrize(
    ("broken", "samples", "with_field"), [(0, 0, 0), (1, 0, 0), (2, 1, 0), (3, 1, 0), (None, 1, 1)]
)
def test_frames_parted_by_damage_are_never_put_together(
    broken: int | None, samples: int, with_field: int
) -> None:
    burst = [ONE_G, SPIN, LEAN, FIELD]
    decoder = WitmotionDecoder("foot")
    whole = b"".join(burst)
    assert len(decoder.feed(whole + whole, 0)) == 2
    if broken is not None:
        burst[broken] = burst[broken][:-1] + b"?"
    got = decoder.feed(b"".join(burst) + whole, 0)
    assert len(got) == samples + 1
    assert sum(sample.field_b is not None for sample in got) == with_field + 1


def test_an_accelerometer_without_its_gyroscope_is_dropped_and_counted() -> None:
    decoder = WitmotionDecoder("foot")
    assert decoder.feed(ONE_G + LEAN + ONE_G + LEAN + ONE_G, 0) == []
    assert decoder.counters.dropped == 2


def test_a_lost_gyroscope_frame_does_not_marry_two_samples() -> None:
    decoder = WitmotionDecoder("foot")
    decoder.feed((ONE_G + SPIN) * 3, 0)
    other = framed(ACCEL, bytes(8))
    got = decoder.feed(ONE_G + SPIN[:5] + other[3:] + SPIN, 0)
    assert got == []


@pytest.mark.parametrize("start_ns", [0, 30 * DAY_NS, 366 * DAY_NS - 10**9, 8_000 * DAY_NS])
def test_its_calendar_runs_through_midnights_and_months(start_ns: int) -> None:
    encoder, decoder = WitmotionEncoder(timed=True), WitmotionDecoder("foot")
    got = []
    for i in range(200):
        ns = start_ns + i * 10_000_000
        sample = Sample("foot", 0, ns, 0, (0.0, 0.0, -9.8), (0.0, 0.0, 0.0))
        got += decoder.feed(encoder.encode(sample), ns)
    assert [sample.device_ns for sample in got] == [start_ns + i * 10_000_000 for i in range(200)]


def test_a_clock_that_was_never_set_runs_all_the_same() -> None:
    decoder = WitmotionDecoder("foot")
    bursts = [framed(TIME, bytes([0, 0, 0, 0, 0, i]) + b"\0\0") + ONE_G + SPIN for i in range(6)]
    stamps = [s.device_ns for i, burst in enumerate(bursts) for s in decoder.feed(burst, i * 10**9)]
    assert np.diff(stamps).tolist() == [10**9] * (len(stamps) - 1)
    assert len(stamps) == 6


@pytest.mark.parametrize("start_ns", [0, 9_800 * DAY_NS])
@pytest.mark.parametrize("before", [1, 2, 30])
def test_time_that_is_switched_on_is_believed_from_then_on(start_ns: int, before: int) -> None:
    without, encoder, decoder = (
        WitmotionEncoder(),
        WitmotionEncoder(timed=True),
        WitmotionDecoder("foot", rate_hz=100),
    )
    got, host_ns = [], 5 * 10**13
    for i, sample in enumerate(at_rest(200)):
        host_ns += 10_000_000 if i % 2 else 30_000_000  # its arrivals would tell another rate
        sent = (without if i < before else encoder).encode(
            sample._replace(device_ns=start_ns + sample.device_ns)
        )
        got += decoder.feed(sent, host_ns)
    steps = np.diff([sample.device_ns for sample in got])
    assert len(got) >= 199
    assert (steps > 0).all()
    assert (steps > GAP_NS).sum() == 1
    assert steps.max() < 2 * GAP_NS
    assert (steps[before + 2 :] == 10_000_000).all()


def test_one_frame_that_passes_for_a_time_changes_nothing() -> None:
    decoder = WitmotionDecoder("foot")
    odd = framed(TIME, bytes([26, 1, 1, 0, 0, 0, 0, 0]))
    got = [
        s for i in range(60) for s in decoder.feed((odd if i == 30 else b"") + ONE_G + SPIN, i * 10_000_000)
    ]
    assert len(got) >= 59
    assert np.diff([sample.device_ns for sample in got]).max() < GAP_NS


def test_setting_it_up() -> None:
    device = WitmotionDevice()
    assert result(converse(start_up(90.0), device)) == 100.0
    assert (device.outputs, device.rate_code) == (0x17, 0x09)
    (sample,) = at_rest(1)
    assert list(device.measure(sample)[1::11]) == [TIME, ACCEL, GYRO, MAG]


def test_locked_it_obeys_nothing_and_rubbish_neither() -> None:
    device = WitmotionDevice()
    device.receive(b"\xff\xaa\x02\x01\x00")
    assert device.outputs == 0x1E
    for piece in (b"??", UNLOCK[:3], UNLOCK[3:], b"\xff\xaa\x02\x06", b"\x00", SAVE):
        assert device.receive(piece) == b""
    assert device.outputs == 0x06
