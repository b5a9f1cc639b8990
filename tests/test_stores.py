"""Intake keeps what is later and finite, to the nanosecond, and counts the rest."""

from __future__ import annotations

import math

import pytest

from app.blocks import BLOCK
from app.motion.basics import Role, Vector
from app.stores import SensorStore
from tests.sessions import sample


def test_intake_keeps_what_is_later_and_counts_the_rest() -> None:
    store = SensorStore("foot", Role.FOOT)
    taken = [store.take(sample(ns)) for ns in (100, 200, 200, 150, 300)]
    assert taken == [True, True, False, False, True]
    assert store.dropped == {"repeated time": 1, "time went backward": 1}
    assert [store.time_ns(i) for i in range(store.samples.end)] == [0.0, 100.0, 200.0]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e6, -1e200])
@pytest.mark.parametrize("place", [0, 1, 2])
def test_what_no_sensor_reads_is_dropped(bad: float, place: int) -> None:
    store = SensorStore("foot", Role.FOOT)
    broken: Vector = (bad if place == 0 else 1.0, bad if place == 1 else 1.0, bad if place == 2 else 1.0)
    assert not store.take(sample(1, force=broken))
    assert not store.take(sample(1, rate=broken))
    assert store.dropped == {"not a finite number": 2}
    assert store.take(sample(1, field=broken))
    block, at = store.samples.block(0)
    assert all(math.isnan(x) for x in block[at, 7:10])


def test_stamps_are_exact_however_far_from_zero() -> None:
    store = SensorStore("foot", Role.FOOT)
    start = 1_763_769_600_000_000_001
    for i in range(3):
        store.take(sample(start + i * 5_000_001))
    assert store.time_ns(2) == 10_000_002.0


def test_rate_and_the_row_at_a_time() -> None:
    store = SensorStore("foot", Role.FOOT)
    assert store.rate_hz() == 0.0
    for i in range(BLOCK + 100):
        store.take(sample(i * 10_000_000))
    assert store.rate_hz() == pytest.approx(100.0)
    assert store.row_at(-1.0) == 0
    assert store.row_at(1.0) == 100
    assert store.row_at(1.001) == 101
    assert store.row_at(1e9) == BLOCK + 100
    store.samples.drop_oldest()
    assert store.row_at(0.0) == BLOCK
