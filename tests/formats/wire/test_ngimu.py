from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.ngimu import (
    NgimuDecoder,
    NgimuEncoder,
    bundle,
    framed,
    message,
    nanoseconds,
    parse,
    time_tag,
    unframed,
)
from app.motion.basics import G_MPS2
from app.motion.samples import GAP_NS
from tests.formats.wire.protocols import at_rest

READING = (1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 20.0, 0.0, -40.0, 1013.0)
SENSORS = message(b"/sensors", READING)
NTP_2026 = 3_976_214_400  # seconds since 1900


def test_an_osc_message_by_hand() -> None:
    assert message(b"/linear", (1.0,)) == b"/linear\0,f\0\0\x3f\x80\0\0"
    assert message(b"/euler", ()) == b"/euler\0\0,\0\0\0"
    assert parse(b"/identify\0\0\0,\0\0\0") == (1, {b"/identify": ()})


def test_a_bundle_is_a_sample_at_its_time_tag() -> None:
    tag = NTP_2026 << 32 | 1 << 31
    (sample,) = NgimuDecoder("foot").feed(bundle(tag, SENSORS), 9)
    assert (sample.device_ns, sample.host_ns) == (NTP_2026 * 10**9 + 500_000_000, 9)
    np.testing.assert_allclose(sample.specific_force_b, (0, 0, -G_MPS2))
    np.testing.assert_allclose(sample.angular_rate_b, np.radians([1, -2, -3]))
    assert sample.field_b == (20.0, 0.0, 40.0)


@given(st.integers(0, 2**32 * 10**9 - 1))
def test_time_tags_are_whole_nanoseconds_both_ways(ns: int) -> None:
    assert nanoseconds(time_tag(ns)) == ns


@given(st.binary(max_size=60))
def test_slip_holds_anything(packet: bytes) -> None:
    frame = framed(packet)
    assert frame[1:-1].count(b"\xc0") == 0
    assert unframed(frame) == packet


@pytest.mark.parametrize("slip", [True, False])
def test_immediately_means_stamped_by_arrival(slip: bool) -> None:
    packet = bundle(1, SENSORS)
    decoder = NgimuDecoder("foot", slip=slip)
    (sample,) = decoder.feed(framed(packet) if slip else packet, 77)
    assert sample.device_ns == 77


def test_a_quaternion_of_its_own_goes_with_the_next_sample_only() -> None:
    decoder = NgimuDecoder("foot")
    assert decoder.feed(bundle(5 << 32, message(b"/quaternion", (1.0, 0.0, 0.0, 0.0))), 0) == []
    got = [decoder.feed(bundle(tag << 32, SENSORS), 0)[0].device_q_nb is not None for tag in (6, 7)]
    assert got == [True, False]


@pytest.mark.parametrize("separate_ends", [True, False])
def test_one_end_or_two_between_packets(separate_ends: bool) -> None:
    stream = b"".join(framed(bundle(tag << 32, SENSORS)) for tag in range(1, 6))
    stream = stream if separate_ends else stream.replace(b"\xc0\xc0", b"\xc0")
    decoder = NgimuDecoder("foot", slip=True)
    assert len(decoder.feed(stream, 0)) == 5
    assert (decoder.counters.bytes_skipped, decoder.counters.bytes_pending) == (0, 0)


def test_nested_bundles_and_other_arguments() -> None:
    text = b"/name\0\0\0,sib\0\0\0\0foot\0\0\0\0" + (7).to_bytes(4) + (3).to_bytes(4) + b"abc\0"
    inner = bundle(9 << 32, SENSORS, text)
    (sample,) = NgimuDecoder("foot").feed(bundle(9 << 32, inner), 0)
    assert sample.device_ns == 9_000_000_000
    assert parse(text) == (1, {b"/name": ()})


@pytest.mark.parametrize("cut", [1, 4, 17, 30])
def test_a_datagram_cut_short_is_no_packet(cut: int) -> None:
    decoder = NgimuDecoder("foot")
    data = bundle(1 << 32, SENSORS)[:-cut]
    assert decoder.feed(data, 0) == []
    assert (decoder.counters.bad_checksum, decoder.counters.bytes_skipped) == (1, len(data))


@pytest.mark.parametrize(
    "packet", [b"", b"/", b"/a\0\0", b"/a\0\0;f\0\0", b"/a\0\0,q\0\0", b"#bundle\0", b"/a\0\0,b\0\0"]
)
def test_what_is_no_osc(packet: bytes) -> None:
    assert parse(packet) is None


@pytest.mark.parametrize("first", [1, 0, 5 << 32])
def test_the_first_packet_says_for_all_whether_they_tell_their_time(first: int) -> None:
    """Found by fuzzing: a time after packets without one went backward."""
    decoder = NgimuDecoder("foot")
    stamps = [
        sample.device_ns
        for number, tag in enumerate((first, 1, 0, 2 << 32, 1, 9 << 32))
        for sample in decoder.feed(bundle(tag, SENSORS), number * 10_000_000)
    ]
    assert stamps == sorted(set(stamps))
    assert decoder.counters.dropped == 6 - len(stamps) > 0


@pytest.mark.parametrize("began_s", [0, 1000, 3_990_000_000])  # since 1900: a clock not set, or set
def test_time_told_later_goes_on_behind_a_gap(began_s: int) -> None:
    decoder, encoder = NgimuDecoder("foot"), NgimuEncoder()
    got = []
    for i, sample in enumerate(at_rest(20)):
        packet = encoder.encode(sample._replace(device_ns=began_s * 10**9 + sample.device_ns))
        if i < 5:
            packet = packet[:8] + (1).to_bytes(8) + packet[16:]  # immediately
        got += decoder.feed(packet, 7 * 10**12 + sample.device_ns)
    steps = np.diff([sample.device_ns for sample in got])
    assert len(got) == 20
    assert GAP_NS < steps[4] < 2 * GAP_NS
    np.testing.assert_allclose(np.delete(steps, 4), 10_000_000, atol=1)
