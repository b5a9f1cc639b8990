import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.clean import LEAPT, clean, countable, told_on
from app.formats.raw import NO_STAMP, RawFoot
from app.motion.basics import InputError
from app.motion.samples import BACKWARD, GAP_NS, NOT_FINITE, REPEATED

STAMPS = st.lists(
    st.one_of(st.integers(-50, 50), st.sampled_from([NO_STAMP, 2**62, -(2**62), 2**53])),
    min_size=1,
    max_size=30,
)


def raw(stamps: list[int], force: list[float] | None = None, field: list[float] | None = None) -> RawFoot:
    count = len(stamps)
    f = np.zeros((count, 3))
    f[:, 2] = force if force is not None else -9.8
    m = None if field is None else np.tile(np.array(field)[:, None], (1, 3))
    return RawFoot("foot", np.array(stamps, np.int64), f, np.zeros((count, 3)), m)


def one_by_one(stamps: list[int], usable: list[bool]) -> list[int]:
    """The rule a live intake follows, in a loop: finite, and later than the last one kept."""
    kept: list[int] = []
    for i, (stamp, fine) in enumerate(zip(stamps, usable, strict=True)):
        if fine and (not kept or stamp > stamps[kept[-1]]):
            kept.append(i)
    return kept


@given(STAMPS, st.data())
def test_the_same_rows_as_the_live_rule(stamps: list[int], data: st.DataObject) -> None:
    force = data.draw(
        st.lists(
            st.sampled_from([-9.8, math.nan, math.inf, 1e300]), min_size=len(stamps), max_size=len(stamps)
        )
    )
    usable = [s != NO_STAMP and f == -9.8 for s, f in zip(stamps, force, strict=True)]
    first = next((s for s, fine in zip(stamps, usable, strict=True) if fine), 0)
    usable = [fine and s - first < 2**53 for s, fine in zip(stamps, usable, strict=True)]
    rows, dropped = countable(raw(stamps, force))
    assert rows.tolist() == one_by_one(stamps, usable)
    assert len(rows) + sum(dropped.values()) == len(stamps)


@given(STAMPS)
def test_cleaned_stamps_increase_and_every_row_is_counted(stamps: list[int]) -> None:
    try:
        samples = clean(raw(stamps))[0]
    except InputError:
        assert all(s == NO_STAMP for s in stamps) or len(stamps) > 2
        return
    assert (np.diff(samples.matrix[:, 0]) > 0).all()
    assert len(samples) + sum(samples.dropped.values()) == len(stamps)


@pytest.mark.parametrize("at", [0, 1, 57, 98])
def test_a_lone_wild_stamp_costs_its_own_row_only(at: int) -> None:
    stamps = [i * 10_000_000 for i in range(100)]
    wild = [*stamps[:at], stamps[at] + 10**15, *stamps[at + 1 :]]
    samples, _ = clean(raw(wild))
    assert samples.dropped == {LEAPT: 1}
    assert (samples.device_ns + samples.matrix[:, 0]).tolist() == stamps[:at] + stamps[at + 1 :]


def test_a_clock_that_was_really_set_ahead_keeps_every_row() -> None:
    stamps = [i * 10_000_000 + (10**12 if i > 50 else 0) for i in range(100)]
    assert len(clean(raw(stamps))[0]) == 100


def test_each_reason_is_counted() -> None:
    samples, _ = clean(raw([0, 10, 10, 5, 20, NO_STAMP, 30], [-9.8, -9.8, -9.8, -9.8, math.nan, -9.8, -9.8]))
    assert samples.matrix[:, 0].tolist() == [0, 10, 30]
    assert samples.dropped == {REPEATED: 1, BACKWARD: 1, NOT_FINITE: 2}


def test_a_gap_stays_a_gap() -> None:
    assert clean(raw([0, 10**10]))[0].matrix[:, 0].tolist() == [0, 1e10]


def test_a_field_that_is_not_finite_is_no_field() -> None:
    samples, _ = clean(raw([0, 1, 2], field=[40.0, math.nan, math.inf]))
    assert len(samples) == 3
    assert np.isfinite(samples.matrix[:, 7:]).tolist() == [[True] * 3, [False] * 3, [False] * 3]


@pytest.mark.parametrize("back_ns", [80_000_000, 10**9, 10**12, 1_700_000_000 * 10**9])
@pytest.mark.parametrize("at", [8, 50, 92])
def test_behind_a_clock_that_was_set_back_every_row_counts(back_ns: int, at: int) -> None:
    start = 1_700_000_000 * 10**9
    stamps = [start + i * 10_000_000 - (back_ns if i >= at else 0) for i in range(100)]
    samples, (set_back,) = clean(raw(stamps))
    steps = np.diff(samples.matrix[:, 0])
    assert len(samples) == 100
    assert samples.dropped == {}
    assert np.flatnonzero(steps != 10_000_000).tolist() == [at - 1]
    assert steps[at - 1] == GAP_NS + 1  # a segment of its own
    assert set_back == pytest.approx(((at - 1) * 0.01, back_ns * 1e-9 - 0.01))


@pytest.mark.parametrize("left", [2, 3, 7])
@pytest.mark.parametrize("before", [2, 3, 100])
def test_a_few_rows_at_the_end_behind_a_clock_set_back_count(before: int, left: int) -> None:
    stamps = [10**12 + i * 10_000_000 for i in range(before)] + [i * 10_000_000 for i in range(left)]
    samples, set_back = clean(raw(stamps))
    assert (len(samples), samples.dropped) == (before + left, {})
    assert len(set_back) == 1
    assert samples.matrix[before, 0] - samples.matrix[before - 1, 0] == GAP_NS + 1


@pytest.mark.parametrize("stamps", [[10**12, 10**12 + 10, 5], [0, 10, 20, 5, 6], [0, 10, 10**9, 20, 15]])
def test_a_lone_row_at_the_end_and_those_a_little_late_stay_late(stamps: list[int]) -> None:
    assert clean(raw(stamps))[1] == ()


def test_set_back_time_and_again() -> None:
    stamps = [i % 20 * 10_000_000 for i in range(200)]
    samples, set_back = clean(raw(stamps))
    assert (len(samples), len(set_back)) == (200, 9)
    assert (np.diff(samples.matrix[:, 0]) > 0).all()
    assert [back.by_s for back in set_back] == pytest.approx([0.19] * 9)


@pytest.mark.parametrize("late", [1, 3, 7])
def test_rows_that_are_merely_late_stay_late(late: int) -> None:
    even = [i * 10_000_000 for i in range(100)]
    stamps = [*even[:40], *even[50:60], *even[40 : 40 + late], *even[60:]]
    samples, set_back = clean(raw(stamps))
    assert set_back == ()
    assert samples.dropped == {BACKWARD: late}


@given(STAMPS)
def test_a_set_back_never_costs_a_row_that_counted(stamps: list[int]) -> None:
    rows, _ = countable(raw(stamps))
    told, _ = told_on(raw(stamps))
    assert len(countable(told)[0]) >= len(rows)
