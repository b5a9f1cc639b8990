"""Every kind of sensor emulated on a real pseudo-terminal and read by the serial source."""

from __future__ import annotations

from itertools import pairwise

import pytest

from app.formats.wire.catalogue import KINDS
from app.motion.samples import GAP_NS
from tests.emulated import WALK, Served, expected, serve, values


def is_in_order(served: Served) -> bool:
    pairs = list(pairwise(served.samples))
    return all(a.seq + 1 == b.seq and a.device_ns < b.device_ns for a, b in pairs)


@pytest.mark.parametrize("device", KINDS)
def test_what_a_sensor_measures_arrives_whole(device: str) -> None:
    baud = {"witmotion": 115200, "csv": 230400, "ngimu": 230400}.get(device, KINDS[device].bauds[0])
    served = serve(device, f"device={device}&baud={baud}", baud, enough=80)
    told = [values(sample) for sample in served.samples]
    should = [values(sample) for sample in expected(device)]
    first = should.index(told[0])
    assert told == should[first : first + len(told)]
    assert len(told) >= 80
    assert is_in_order(served)
    counters = served.counters
    assert counters.bytes_skipped == counters.bad_checksum == counters.dropped == 0
    assert served.sent["not_fetched"] == served.sent["passed_over"] == 0


@pytest.mark.parametrize(("device", "baud"), [("gx1", 38400), ("mip", 460800)])
def test_a_sensor_nobody_named_is_found_with_its_baud_rate(device: str, baud: int) -> None:
    served = serve(device, "device=auto", baud, source=f"{WALK}&loop=1", enough=20)
    assert served.info.format == f"{KINDS[device].title} at {baud} baud"
    assert served.counters.bad_checksum == 0


def test_a_bad_line_gives_no_false_sample_and_adds_up() -> None:
    faults = ("lost=0.3%", "flip=0.3%", "garbage=0.4%")
    served = serve("gx1", "device=gx1&baud=38400&rate=76", 38400, faults, enough=150)
    should = {values(sample) for sample in expected("gx1")}
    assert served.samples
    assert {values(sample) for sample in served.samples} <= should
    counters = served.counters
    assert counters.bad_checksum > 0
    assert counters.bytes_fed == counters.bytes_good + counters.bytes_skipped + counters.bytes_pending
    assert is_in_order(served)


def test_every_byte_is_accounted_for() -> None:
    served = serve(
        "csv",
        "device=csv&baud=230400",
        230400,
        ("lost=1%", "garbage=1%"),
        source="sim:walk?strides=1&still_s=0.5",
    )
    sent = served.sent
    assert sent["lost"] > 0
    assert sent["strays"] > 0
    assert served.counters.bytes_fed == sent["bytes"] - sent["lost"] + sent["strays"]


def test_unplugged_for_five_seconds() -> None:
    source = "sim:walk?path=straight&strides=20&still_s=0.8&rate=100"
    served = serve("gx1", "device=gx1&baud=38400", 38400, ("unplug=5@2.5",), source, enough=180)
    assert is_in_order(served)
    gaps = [(a, b) for a, b in pairwise(served.samples) if b.device_ns - a.device_ns > GAP_NS]
    assert len(gaps) == 1, "one gap, so one new segment"
    away_s = (gaps[0][1].device_ns - gaps[0][0].device_ns) * 1e-9
    assert away_s >= 5.0  # how much more, make soak measures
    words = " | ".join(detail for _, detail in served.details)
    assert "is gone" in words or "is not there" in words
    assert "trying again" in words
    assert "1 time lost" in served.details[-2][1] + served.details[-1][1]


def test_a_brown_out_restarts_the_clock_and_nothing_breaks() -> None:
    source = "sim:walk?path=straight&strides=20&still_s=0.8&rate=100"
    served = serve("xsens", "device=xsens&baud=115200", 115200, ("brownout=3@2.5",), source, enough=350)
    assert is_in_order(served)
    gaps = [
        b.device_ns - a.device_ns for a, b in pairwise(served.samples) if b.device_ns - a.device_ns > GAP_NS
    ]
    assert len(gaps) == 1
    should = {values(sample)[:3] for sample in expected("xsens", source)}  # it sends no quaternion unasked
    assert {values(sample)[:3] for sample in served.samples} <= should


def test_drift_is_in_its_stamps_and_bursts_are_in_their_coming() -> None:
    served = serve("mip", "device=mip&baud=115200", 115200, ("drift=1000", "burst=64"), enough=100)
    step_ns = {b.device_ns - a.device_ns for a, b in pairwise(served.samples)}
    assert step_ns <= {10_009_999, 10_010_000, 10_010_001}
    together = sum(a.host_ns == b.host_ns for a, b in pairwise(served.samples))
    assert together > len(served.samples) // 3
