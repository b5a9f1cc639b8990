"""Clocks: what is recovered from late, bursty arrivals is the truth they were made of."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from app.clocks import BINS, FixedClock, LiveClock, recorded_line
from app.formats.wire.ticks import DeviceClock
from app.motion.samples import ClockLine

MS = 1_000_000
BURST_NS = 16 * MS


def arrivals(true_ns: np.ndarray, seed: int, burst_ns: int = BURST_NS) -> np.ndarray:
    """When the host sees them: at the end of a burst, and then late by a scheduler's whim."""
    late = np.random.default_rng(seed).exponential(0.2 * MS, len(true_ns)).astype(np.int64)
    burst = true_ns + (-true_ns) % burst_ns if burst_ns else true_ns
    return np.asarray(np.maximum.accumulate(burst + late), np.int64)


def stamped(true_ns: np.ndarray, ppm: float, start_ns: int = 0) -> np.ndarray:
    """What a device's clock shows that runs too fast by ``ppm``."""
    return np.asarray(start_ns + true_ns + np.rint(true_ns * ppm * 1e-6), np.int64)


def walked(seconds: float, rate_hz: float) -> np.ndarray:
    return np.arange(0, int(seconds * 1e9), int(1e9 / rate_hz), dtype=np.int64) + 3_333_333


def filled(device_ns: np.ndarray, host_ns: np.ndarray) -> LiveClock:
    clock = LiveClock()
    for device, host in zip(device_ns.tolist(), host_ns.tolist(), strict=True):
        clock.add(device, host)
    return clock


@pytest.mark.parametrize("ppm", [100.0, -100.0, 37.0, 0.0])
@pytest.mark.parametrize("rate_hz", [60.0, 100.0, 333.0])
def test_drift_and_times_through_bursts_and_a_wrap(ppm: float, rate_hz: float) -> None:
    true_ns = walked(60.0, rate_hz)
    host_ns = arrivals(true_ns, seed=int(rate_hz))
    counter, clock = DeviceClock(tick_ns=1000, bits=25), LiveClock()  # wraps after 33.6 s
    device_ns = []
    for ticks, host in zip((stamped(true_ns, ppm) // 1000).tolist(), host_ns.tolist(), strict=True):
        stamp = counter.stamp(ticks % 2**25, host)
        assert stamp is not None
        device_ns.append(stamp)
        clock.add(stamp, host)
    assert counter.restarts == 0
    assert clock.settled
    assert clock.line.drift_ppm == pytest.approx(ppm, abs=5.0)
    errors = [abs(clock.line.host(d) - t) for d, t in zip(device_ns, true_ns.tolist(), strict=True)]
    assert max(errors) < 1 * MS


@pytest.mark.parametrize("seed", range(3))
def test_a_slow_network_does_not_bend_the_clock(seed: int) -> None:
    """Delays of 5 ms in the mean, and four seconds in which everything piles up."""
    true_ns = walked(60.0, 100.0)
    late = np.random.default_rng(seed).exponential(5 * MS, len(true_ns)).astype(np.int64)
    host_ns = true_ns + late
    host_ns[3000:3400] = np.maximum(host_ns[3000:3400], true_ns[3400])
    clock = filled(stamped(true_ns, 50.0), np.maximum.accumulate(host_ns))
    assert clock.line.drift_ppm == pytest.approx(50.0, abs=5.0)
    assert abs(clock.line.host(int(stamped(true_ns, 50.0)[-1])) - int(true_ns[-1])) < 1 * MS


@pytest.mark.parametrize("jump_ns", [-20_000 * MS, 90_000 * MS])
def test_a_restart_is_another_line_of_the_same_drift(jump_ns: int) -> None:
    true_ns = walked(60.0, 100.0)
    device_ns = stamped(true_ns, 100.0, start_ns=40_000 * MS)
    device_ns[4500:] += jump_ns
    true_ns[4500:] += 2000 * MS  # it was away for two seconds
    clock = filled(device_ns, arrivals(true_ns, 1))
    assert clock.segments == 1
    assert clock.line.drift_ppm == pytest.approx(100.0, abs=5.0)
    assert abs(clock.line.host(int(device_ns[-1])) - int(true_ns[-1])) < 1 * MS


def test_a_gap_without_a_restart_keeps_the_line() -> None:
    true_ns = np.concatenate([walked(40.0, 100.0), walked(50.0, 100.0)[4300:]])
    device_ns = stamped(true_ns, -80.0)
    clock = filled(device_ns, arrivals(true_ns, 2))
    assert clock.segments == 0
    assert clock.line.drift_ppm == pytest.approx(-80.0, abs=5.0)


def test_two_feet_come_onto_one_clock() -> None:
    """The same instant of two devices whose clocks began apart and run apart is the same instant again."""
    true_ns = walked(60.0, 100.0)
    lines = [
        recorded_line(stamped(true_ns, ppm, start), arrivals(true_ns, seed))
        for seed, (ppm, start) in enumerate([(100.0, 0), (-100.0, 7_000_000 * MS)])
    ]
    left, right = stamped(true_ns, 100.0), stamped(true_ns, -100.0, 7_000_000 * MS)
    apart = [
        abs(lines[0].host(a) - lines[1].host(b)) for a, b in zip(left.tolist(), right.tolist(), strict=True)
    ]
    assert max(apart) < 1 * MS


def test_a_long_walk_keeps_little_and_follows_a_crystal_that_warms() -> None:
    true_ns = walked(1200.0, 20.0)
    device_ns = true_ns + np.rint(20e-6 * true_ns * (true_ns / 1200e9)).astype(np.int64)  # 0 to 40 ppm
    clock = filled(device_ns, arrivals(true_ns, 3, burst_ns=0))
    assert len(clock._bins.points) <= 1.25 * BINS
    assert clock.line.drift_ppm == pytest.approx(40.0, abs=8.0)
    assert abs(clock.line.host(int(device_ns[-1])) - int(true_ns[-1])) < 1 * MS


def test_before_the_drift_is_known_only_the_offset_is_told() -> None:
    true_ns = walked(5.0, 100.0)
    clock = filled(stamped(true_ns, 100.0), arrivals(true_ns, 4))
    assert not clock.settled
    assert clock.line.slope == 0.0
    assert abs(clock.line.host(int(stamped(true_ns, 100.0)[-1])) - int(true_ns[-1])) < 2 * MS


def test_a_known_clock_learns_nothing() -> None:
    clock = FixedClock(ClockLine(5, 105, 1e-4))
    clock.add(1, 2)
    assert clock.line.host(10_005) == 10_106
    assert FixedClock().line.host(123) == 123


def test_the_line_does_not_depend_on_later_samples_being_asked_about() -> None:
    """A fold: the same samples, the same line, to the bit."""
    true_ns = walked(30.0, 100.0)
    device_ns, host_ns = stamped(true_ns, 20.0), arrivals(true_ns, 5)
    assert filled(device_ns, host_ns).line == recorded_line(device_ns, host_ns)
    assert all(a <= b for a, b in itertools.pairwise(host_ns.tolist()))


def test_a_replay_at_another_speed_is_no_drift() -> None:
    true_ns = walked(30.0, 100.0)
    assert recorded_line(true_ns, true_ns // 8) == ClockLine(int(true_ns[0]), int(true_ns[0]) // 8)
