from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.ticks import ArrivalClock, DeviceClock, TickLength
from app.motion.samples import GAP_NS

MS = 1_000_000


@given(start=st.integers(0, 65535), steps=st.lists(st.integers(1, 150), min_size=1, max_size=200))
def test_sixteen_bits_wrap_without_a_trace(start: int, steps: list[int]) -> None:
    clock = DeviceClock(6_553_600, 16)
    true = [start, *itertools.accumulate(steps, initial=start)][1:]
    stamps = [clock.stamp(ticks & 0xFFFF, ticks * 6_553_600) for ticks in true]
    assert np.diff(stamps).tolist() == [step * 6_553_600 for step in steps]  # type: ignore[arg-type]
    assert clock.restarts == 0


def test_a_silence_longer_than_a_wrap_is_told_by_the_host() -> None:
    clock = DeviceClock(MS, 16)
    first = clock.stamp(100, 0)
    ticks = 100 + 3 * 65536 + 500
    later = clock.stamp(ticks & 0xFFFF, (ticks - 100 - 40) * MS)
    assert first is not None
    assert later == first + (ticks - 100) * MS


def test_repeated_and_late_stamps_are_refused_and_do_no_harm() -> None:
    clock = DeviceClock(MS, 32)
    stamps = [clock.stamp(ticks, i * 10 * MS) for i, ticks in enumerate((100, 110, 110, 140, 120, 130, 150))]
    assert stamps == [100 * MS, 110 * MS, None, 140 * MS, None, None, 150 * MS]
    assert clock.restarts == 0


@pytest.mark.parametrize("bits", [16, 32, 64])
@pytest.mark.parametrize("ran_ms", [3000, 60_000])
def test_a_restart_is_a_gap_at_the_hosts_pace(bits: int, ran_ms: int) -> None:
    clock = DeviceClock(MS, bits)
    before = [clock.stamp(t, t * MS) for t in range(1000, ran_ms, 10)]
    after = [clock.stamp(t, (ran_ms + 3000 + t) * MS) for t in range(5, 200, 10)]
    got = [stamp for stamp in after if stamp is not None]
    assert clock.restarts == 1
    assert len(got) == len(after) - 1  # one to see, one to believe
    assert before[-1] is not None
    assert got[0] - before[-1] == pytest.approx(3025 * MS, abs=20 * MS)
    assert got[0] - before[-1] > GAP_NS
    assert set(np.diff(got)) == {10 * MS}


def test_one_false_stamp_is_not_believed() -> None:
    clock = DeviceClock(MS, 64)
    given_ticks = [*range(0, 100, 10), 10**12, *range(110, 200, 10), 0, *range(200, 300, 10)]
    stamps = [clock.stamp(t, i * 10 * MS) for i, t in enumerate(given_ticks)]
    assert stamps.count(None) == 2
    assert clock.restarts == 0


def test_a_recorded_stream_fed_at_once_keeps_its_gaps() -> None:
    clock = DeviceClock(MS, 64)
    stamps = [clock.stamp(t, 0) for t in (0, 10, 20, 60_000, 60_010, 60_020)]
    assert stamps == [0, 10 * MS, 20 * MS, None, 60_010 * MS, 60_020 * MS]


@pytest.mark.parametrize("true_ms", [1.0, 3.0, 6.5536, 10.0])
@pytest.mark.parametrize("start", [0, 65_300])
def test_the_ticks_length_is_seen_through_bursts_and_drift(true_ms: float, start: int) -> None:
    rng = np.random.default_rng(4)
    length = TickLength((6_553_600, MS, 3 * MS, 10 * MS), 16)
    step = 2 if true_ms > 5 else 10
    for i in range(4000):
        host_ns = i * step * true_ms * MS * 1.0001
        found = length.add(
            (start + i * step) & 0xFFFF, int(host_ns // (16 * MS) * 16 * MS + rng.exponential(MS))
        )
        if found is not None:
            break
    assert found == round(true_ms * MS)
    assert length.snapped
    assert 5.0 <= host_ns / 1e9 < 6.5


@pytest.mark.parametrize("backlog_ms", [400, 1000])
def test_a_backlog_at_the_start_does_not_lengthen_the_tick(backlog_ms: int) -> None:
    """The host was busy while the first samples waited; then they came at once."""
    length = TickLength((6_553_600, MS, 3 * MS, 10 * MS), 16)
    found = [length.add(3 * i & 0xFFFF, max(3 * i, backlog_ms) * MS) for i in range(3000)]
    assert next(tick for tick in found if tick is not None) == MS
    assert length.snapped


def test_a_counter_that_stands_still_raises_nothing() -> None:
    length = TickLength((MS,), 16)
    assert [length.add(7, i * 100 * MS) for i in range(110)][-1] is not None


def test_an_unknown_tick_is_measured_and_no_host_clock_means_the_usual_one() -> None:
    odd = TickLength((6_553_600, MS), 16)
    found = next(f for i in range(10_000) if (f := odd.add(i, i * 2 * MS)) is not None)
    assert (found, odd.snapped) == (2 * MS, False)
    blind = TickLength((6_553_600, MS), 16)
    found = next(f for i in range(10_000) if (f := blind.add(i & 0xFFFF, 0)) is not None)
    assert (found, blind.snapped) == (6_553_600, False)


@pytest.mark.parametrize("rate_hz", [100.0, None])
@pytest.mark.parametrize("true_hz", [100.0, 100.05])
def test_without_a_clock_the_count_is_held_to_the_arrivals(rate_hz: float | None, true_hz: float) -> None:
    rng = np.random.default_rng(5)
    clock = ArrivalClock(rate_hz)
    times = np.arange(6000) / true_hz * 1e9
    arrivals = np.maximum.accumulate(np.ceil(times / (16 * MS)) * 16 * MS + rng.exponential(0.3 * MS, 6000))
    stamps = np.array([clock.stamp(int(arrival)) for arrival in arrivals])
    steps = np.diff(stamps)
    assert steps.min() > 0
    lag = (stamps - times)[1000:]
    assert np.ptp(lag) < 5 * MS, "bursts of 16 ms must not show"
    assert np.median(np.abs(steps[1000:] / (1e9 / true_hz) - 1)) < 0.05


def test_a_silence_is_a_gap() -> None:
    clock = ArrivalClock(100.0)
    stamps = [clock.stamp(at * MS) for at in (0, 10, 20, 2020, 2030)]
    assert np.diff(stamps).tolist() == pytest.approx([10 * MS, 10 * MS, 2000 * MS, 10 * MS], abs=MS)


@given(
    start=st.integers(0, 1 << 40),
    wild=st.lists(
        st.tuples(st.integers(20, 380), st.integers(1, 2), st.integers(0, 1 << 41)), min_size=1, max_size=4
    ),
)
def test_damaged_stamps_do_not_move_the_time_of_those_behind_them(
    start: int, wild: list[tuple[int, int, int]]
) -> None:
    """One alone, or two in a row that follow each other, as where each lost the same digit."""
    clock = DeviceClock(1000, 64)
    told = [start + 10_000 * i for i in range(400)]
    for place, count, wrong in wild:
        for i in range(place, min(place + count, 400)):
            told[i] = wrong + 10_000 * (i - place)
    stamps = [clock.stamp(ticks, 10 * MS * i) for i, ticks in enumerate(told)]
    given_ns = [stamp for stamp in stamps if stamp is not None]
    assert given_ns == sorted(set(given_ns))
    near = {i for place, _, _ in wild for i in range(place, place + 130)}
    for i, stamp in enumerate(stamps):
        if i not in near:
            assert stamp == 1000 * start + 10 * MS * i
