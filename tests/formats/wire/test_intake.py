"""Many senders into one stream: none twice, every gap counted, whatever order and resends."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.formats.mounting import parse_axes
from app.formats.options import Options
from app.formats.wire import intake
from app.formats.wire.intake import Intake
from app.formats.wire.message import Malformed, encode_binary, encode_json
from app.formats.wire.reply import Ack
from app.motion.samples import GAP_NS, Sample

MS = 1_000_000


def samples(count: int, name: str = "left", first: int = 0) -> list[Sample]:
    return [
        Sample(name, i, (i + 1) * 10 * MS, 0, (0.1 * i, 0.2, -9.8), (0.0, 0.1, 0.01 * i), (20.0, 0.0, 44.0))
        for i in range(first, first + count)
    ]


def take(box: Intake, session: int, sent: list[Sample], host_ns: int = 0) -> list[Sample]:
    got, answer = box.take(encode_binary(session, sent, doubles=True), host_ns)
    assert isinstance(answer, Ack)
    return got


@given(st.lists(st.tuples(st.integers(0, 60), st.integers(1, 20)), max_size=40), st.booleans())
def test_resends_in_any_order_give_each_sample_once_and_in_order(
    spans: list[tuple[int, int]], json: bool
) -> None:
    box, got, walk = Intake(), [], samples(80)
    for first, count in [(0, 1), *spans]:
        part = walk[first : first + count]
        data = encode_json(9, part) if json else encode_binary(9, part, doubles=True)
        got += box.take(data, 0)[0]
    numbers = [s.seq for s in got]
    assert numbers == sorted(set(numbers))
    assert all(s == walk[s.seq] for s in got)
    assert box.counters.lost == numbers[-1] + 1 - len(numbers)
    assert box.counters.repeated == 1 + sum(len(walk[a : a + n]) for a, n in spans) - len(got)


def test_an_ack_says_how_far_it_has_come_under_the_senders_own_name() -> None:
    box = Intake(Options(foot="left"))
    _, answer = box.take(encode_json(0xAB, samples(3, "imu7")), 0)
    assert answer == Ack(0xAB, "imu7", 3)
    assert box.take(encode_json(0xAB, samples(2, "imu7")), 0) == ([], Ack(0xAB, "imu7", 3))


def test_two_feet_do_not_mix() -> None:
    box = Intake()
    left, right = samples(20), samples(20, "right")
    got = [s for a, b in zip(left, right, strict=True) for s in take(box, 1, [a]) + take(box, 2, [b])]
    assert [s for s in got if s.sensor == "left"] == left
    assert [s for s in got if s.sensor == "right"] == right
    assert box.counters.lost == box.counters.repeated == 0


def test_a_new_start_goes_on_behind_the_old_one_over_a_gap() -> None:
    box = Intake()
    before = take(box, 1, samples(10), host_ns=1000 * MS)
    after = take(box, 2, samples(10), host_ns=3000 * MS)
    stamps = [s.device_ns for s in before + after]
    assert all(a < b for a, b in pairwise(stamps))
    assert after[0].device_ns - before[-1].device_ns == 2000 * MS
    assert [s.seq for s in before + after] == list(range(20))
    quick = take(box, 3, samples(2), host_ns=3000 * MS)
    assert quick[0].device_ns - after[-1].device_ns > GAP_NS


def test_a_session_that_is_over_does_not_come_back() -> None:
    box = Intake()
    take(box, 1, samples(5))
    take(box, 2, samples(5))
    got, answer = box.take(encode_json(1, samples(5, first=5)), 0)
    assert got == []
    assert isinstance(answer, Malformed)
    assert "taken over" in answer.why


def test_a_receiver_that_joins_later_counts_no_loss() -> None:
    box = Intake()
    assert len(take(box, 1, samples(5, first=1000))) == 5
    assert box.counters.lost == 0
    take(box, 1, samples(5, first=1007))
    assert box.counters.lost == 2


def test_one_foot_of_two_is_picked() -> None:
    box = Intake(Options(foot="right"))
    assert box.take(encode_json(1, samples(5)), 0)[0] == []
    assert len(take(box, 1, samples(5, "right"))) == 5
    assert [s.sensor for s in take(Intake(Options(foot="right")), 1, samples(2, "esp32"))] == ["right"] * 2


def test_axes_turn_and_a_rate_replaces_the_stamps() -> None:
    sent = samples(3, first=4)
    got = take(Intake(Options(axes=parse_axes("y,x,-z"), rate_hz=50.0)), 1, sent)
    for a, b in zip(got, sent, strict=True):
        x, y, z = b.specific_force_b
        np.testing.assert_allclose(a.specific_force_b, (y, x, -z))
        assert a.device_ns == b.seq * 20 * MS
        assert a.seq == b.seq


def test_a_known_device_flags_what_touches_its_range() -> None:
    hard = samples(1)[0]._replace(angular_rate_b=(0.0, 35.0, 0.0))
    got = take(Intake(Options(device="ximu3")), 1, [hard])
    assert got[0].saturation == 1 << 4


def test_rubbish_is_counted_and_remembered_nowhere() -> None:
    box = Intake()
    for i in range(300):
        got, answer = box.take(b"rubbish %d" % i, 0)
        assert got == []
        assert isinstance(answer, Malformed)
        box.take(encode_json(i, samples(1, f"s{i}")), 0)
    c = box.counters
    assert c.bad_checksum == 300
    assert c.bytes_fed == c.bytes_good + c.bytes_skipped
    assert len(box._streams) == intake.MOST_SENSORS
    assert c.unknown == 300 - intake.MOST_SENSORS


def test_a_sender_that_forgets_to_choose_a_session_is_told_of() -> None:
    box = Intake()
    take(box, 1, samples(300))
    for sample in samples(250):
        take(box, 1, [sample])
    assert any("new session" in note for note in box.notes)
    assert len(box.notes) == 1


def stamped(stamps: list[int]) -> list[tuple[Sample, int]]:
    """Samples that come every 10 ms, with these stamps, and when they come."""
    walk = samples(len(stamps))
    return [
        (s._replace(device_ns=stamp), i * 10 * MS)
        for i, (s, stamp) in enumerate(zip(walk, stamps, strict=True))
    ]


def taken_one_by_one(sent: list[tuple[Sample, int]]) -> list[Sample]:
    box = Intake()
    return [got for sample, host_ns in sent for got in take(box, 1, [sample], host_ns)]


def test_a_lone_wild_stamp_costs_its_own_sample_only() -> None:
    stamps = [(i + 1) * 10 * MS for i in range(100)]
    for wild in (10**18, 3600 * 10**9, 1):
        got = taken_one_by_one(stamped([*stamps[:50], wild, *stamps[51:]]))
        assert [s.device_ns for s in got] == stamps[:50] + stamps[51:]


def test_a_clock_that_is_set_goes_on_behind_a_gap() -> None:
    for shift in (10**13, -400 * MS):
        stamps = [(i + 1) * 10 * MS + (shift if i >= 50 else 0) for i in range(100)]
        got = taken_one_by_one(stamped(stamps))
        steps = [b.device_ns - a.device_ns for a, b in pairwise(got)]
        assert len(got) >= 92
        assert all(step > 0 for step in steps)
        assert sum(step > GAP_NS for step in steps) == 1
        assert steps.count(10 * MS) == len(steps) - 1
