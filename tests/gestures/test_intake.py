"""Whose sample it is, on which clock, and what is said when a foot is missing, silent or swapped."""

from __future__ import annotations

from itertools import pairwise

import pytest

from app.gestures.intake import Intake
from app.motion.basics import Role, role_of
from app.motion.samples import Sample


def intake() -> Intake:
    return Intake(role_of)


def sample(sensor: str, device_ms: float, host_ms: float) -> Sample:
    return Sample(sensor, 0, round(device_ms * 1e6), round(host_ms * 1e6), (0.0, 0.0, -9.8), (0.0, 0.0, 0.0))


def test_clocks_that_began_years_apart_come_together() -> None:
    made, apart = intake(), []
    for k in range(300):
        late = 8.0 * (k % 5)
        left = made.take(sample("left", 5e9 + 10.0 * k, 1000.0 + 10.0 * k + late))
        right = made.take(sample("right", 10.0 * k, 1000.0 + 10.0 * k + late))
        assert left
        assert right
        apart.append(abs(left.t_ns - right.t_ns))
    assert max(apart[10:]) < 1_000_000


def test_different_rates_do_no_harm_and_are_said() -> None:
    made = intake()
    for k in range(1000):
        made.take(sample("left", 5.0 * k, 5.0 * k))
        if k % 4 == 0:
            made.take(sample("right", 5.0 * k, 5.0 * k))
    assert made.sensor(Role.LEFT).rate_hz == pytest.approx(200.0, rel=0.05)
    assert made.sensor(Role.RIGHT).rate_hz == pytest.approx(50.0, rel=0.05)
    assert "different rates" in made.note()
    assert made.fault(4_996_000_000) == ""


def test_a_cable_that_was_out_is_no_slow_sensor() -> None:
    made = intake()
    for k in range(2000):
        made.take(sample("left", 10.0 * k, 10.0 * k))
        if not 1000 < k < 1960:
            made.take(sample("right", 10.0 * k, 10.0 * k))
    assert made.sensor(Role.RIGHT).rate_hz == pytest.approx(100.0, rel=0.05)
    assert made.note() == ""


def test_a_missing_and_a_silent_foot_are_named() -> None:
    made = intake()
    assert "no sensor" in made.fault(0)
    made.take(sample("left", 0.0, 0.0))
    assert "no sensor on the right foot" in made.fault(0)
    made.take(sample("right", 0.0, 0.0))
    assert made.fault(100_000_000) == ""
    made.take(sample("left", 200.0, 200.0))
    assert "right foot's sensor is silent" in made.fault(200_000_000)
    assert "both" in made.fault(500_000_000)


def test_swapped_feet_are_put_right() -> None:
    made = intake()
    made.swapped = True
    reading = made.take(sample("left", 0.0, 0.0))
    assert reading
    assert reading.foot is Role.RIGHT
    assert "no sensor on the left foot" in made.fault(0)


def test_sensors_without_a_side_get_one_and_it_is_said() -> None:
    made = intake()
    first, second = made.take(sample("A1", 0.0, 0.0)), made.take(sample("B2", 0.0, 0.0))
    assert first
    assert second
    assert (first.foot, second.foot) == (Role.LEFT, Role.RIGHT)
    assert "A1 as the left foot" in made.note()
    made.sided = True
    assert made.note() == ""
    assert made.take(sample("C3", 0.0, 0.0)) is None


def test_time_never_goes_back() -> None:
    made, stamps = intake(), []
    for k in range(200):
        reading = made.take(sample("left", 10.0 * k, 10.0 * k + 30.0 - 0.3 * min(k, 90)))
        assert reading
        stamps.append(reading.t_ns)
    assert all(b > a for a, b in pairwise(stamps))
