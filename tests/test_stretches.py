"""A stretch taken in one go leaves the session as its samples one by one do: to the bit, budget and all."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.blocks import BLOCK
from app.motion.commands import Order, SetCandidate
from app.session import Session
from app.settings import Settings
from app.simulate.walk import make_walk
from app.sources.timeline import Timeline

WALK = make_walk(
    {"path": "square", "feet": "2", "noise": "1", "rate_hz": "200", "duration_s": "60"}
).recording
LINE = Timeline(WALK)
ROOM = 4 * BLOCK * (10 + 2 + 2 * 12) * 8


def one_by_one(edges: list[int], budget: int) -> Session:
    session = Session(Settings(), budget_bytes=budget)
    for first, last in pairwise(edges):
        tell(session, first)
        for sample in LINE.cut(first, last, 7):
            session.take(sample)
    return session


def in_stretches(edges: list[int], budget: int) -> Session:
    session = Session(Settings(), budget_bytes=budget)
    for first, last in pairwise(edges):
        tell(session, first)
        while first < last:
            end = min(last, LINE.block_end(first))
            session.take_stretch(LINE.stretch(first, end, 7))
            first = end
    return session


def tell(session: Session, at: int) -> None:
    session.apply(Order(SetCandidate((("gain_stance", 0.5 + at / len(LINE)),)), "me", 0))
    while (job := session.applying.wanted) is not None:
        session.applying.adopt(job, job.run())


def assert_same(one: Session, other: Session) -> None:
    assert one.number == other.number
    assert list(one.stores) == list(other.stores)
    for sensor, store in one.stores.items():
        twin = other.stores[sensor]
        assert (store.samples.start, store.samples.end) == (twin.samples.start, twin.samples.end)
        assert (store.elapsed_s, store.saturated) == (twin.elapsed_s, twin.saturated)
        for a, b in ((store.samples, twin.samples), (store.clocks, twin.clocks)):
            np.testing.assert_array_equal(a.table(a.start, a.end), b.table(b.start, b.end))
    assert (one.applying.candidate is None) == (other.applying.candidate is None)
    for track, twin_track in ((one.main, other.main), (one.applying.candidate, other.applying.candidate)):
        for sensor, foot in track.feet.items() if track else ():
            assert twin_track is not None
            mine, its = foot.tracker, twin_track.feet[sensor].tracker
            assert mine.state.tobytes() == its.state.tobytes()
            assert mine.strides == its.strides
            rows, twin_rows = (t.rows.table(t.rows.start, t.rows.end) for t in (mine, its))
            assert rows.tobytes() == twin_rows.tobytes()


@settings(max_examples=8)
@given(st.lists(st.integers(0, len(LINE)), max_size=3), st.sampled_from([2**30, ROOM]))
def test_a_stretch_is_its_samples(cuts: list[int], budget: int) -> None:
    edges = sorted({0, len(LINE), *cuts})
    assert_same(one_by_one(edges, budget), in_stretches(edges, budget))


def test_the_room_is_small_enough_to_matter() -> None:
    session = one_by_one([0, len(LINE)], ROOM)
    assert all(store.samples.start > 0 for store in session.stores.values())


@pytest.mark.parametrize("first", [0, 1, 5, BLOCK, 2 * BLOCK + 1, 20_000])
def test_a_stretch_holds_what_a_cut_holds(first: int) -> None:
    last = LINE.block_end(first)
    stretch = LINE.stretch(first, last, 7)
    samples = LINE.cut(first, last, 7)
    assert stretch.each() == samples
    assert len(stretch) == len(samples)
    for samples_of, begin, end in stretch.rows:
        own = [s for s in samples if s.sensor == samples_of.sensor]
        assert [s.seq for s in own] == list(range(begin, end))
        assert all(row % BLOCK for row in range(begin, end - 1))
