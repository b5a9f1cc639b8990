"""What a recording shows at a glance is what it tells, and no damage makes it tell anything else."""

from __future__ import annotations

import random
import struct
import zlib
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.formats import glance as glances
from app.formats import mcap
from app.motion.basics import Role
from app.motion.estimate import Saved, Way
from app.motion.source import Outline
from app.settings import Settings
from tests.formats.walks import keeper, random_samples, write

WAYS = {
    "left": [Way(0, 5, np.full((2, 2, 3), 1, np.float32)), Way(5, 9, np.full((1, 2, 3), 2, np.float32))],
    "right": [Way(0, 6, np.full((1, 2, 3), 3, np.float32))],
}


STATE = Saved(Settings(), 1, b"", (), 0, 0.0, None)


def a_file() -> bytes:
    """Some chunks, two of them with ways."""
    made = keeper()
    data = made.begin(0)
    waiting = {10: ("left", 0), 11: ("right", 0), 30: ("left", 1)}
    for i, sample in enumerate(random_samples(40)):
        made.sample(sample)
        if i in waiting:
            sensor, number = waiting[i]
            made.estimate(sensor, i, STATE, partial(WAYS[sensor].__getitem__, number))
        if i % 3 == 0:
            data += made.chunk()
    return data + made.end()


WHOLE = a_file()


def at_a_glance(data: bytes) -> Outline | None:
    return glances.glance("x", len(data), lambda at, count: data[at : at + count])


def test_it_shows_the_ways_and_the_duration() -> None:
    shown = at_a_glance(WHOLE)
    assert shown is not None
    ways = dict(shown.ways)
    assert list(ways) == [Role.LEFT, Role.RIGHT]
    assert ways[Role.LEFT][:, 0, 0].tolist() == [1.0, 1.0, 2.0]
    assert ways[Role.RIGHT][:, 0, 0].tolist() == [3.0]
    assert shown.duration_s == pytest.approx(39 * 5e-3)


def test_it_reads_the_summary_and_the_chunks_with_a_way_only() -> None:
    asked: list[int] = []

    def read_at(at: int, count: int) -> bytes:
        asked.append(len(WHOLE[at : at + count]))
        return WHOLE[at : at + count]

    assert glances.glance("x", len(WHOLE), read_at) is not None
    found = mcap.index(len(WHOLE), read_at)
    assert found is not None
    assert len(found.chunks) == 14
    assert len(asked) == 2 * 3 + 2  # twice head, foot and summary; two chunks


def test_one_whose_chunks_are_too_large_to_be_glanced_at_shows_nothing(monkeypatch) -> None:
    monkeypatch.setattr(glances, "MOST_BYTES", 1_000)
    assert at_a_glance(WHOLE) is None


def test_one_without_ways_shows_nothing() -> None:
    assert at_a_glance(write(random_samples(40))) is None


def test_a_cut_one_shows_nothing() -> None:
    assert all(at_a_glance(WHOLE[:length]) is None for length in range(0, len(WHOLE), 7))


def test_a_damaged_one_shows_nothing_that_is_not_in_it() -> None:
    chance = random.Random(5)
    told = {way.segments.tobytes() for ways in WAYS.values() for way in ways}
    told |= {np.concatenate([way.segments for way in ways]).tobytes() for ways in WAYS.values()}
    for _ in range(1000):
        damaged = bytearray(WHOLE)
        damaged[chance.randrange(len(WHOLE))] ^= 1 << chance.randrange(8)
        shown = at_a_glance(bytes(damaged))
        assert shown is None or all(segments.tobytes() in told for _, segments in shown.ways)


@settings(max_examples=200)
@given(st.binary(max_size=200), st.integers(0, 200))
def test_rubbish_with_a_good_foot_shows_nothing(rubbish: bytes, start: int) -> None:
    head = mcap.MAGIC + rubbish
    begin = min(start, len(head))
    foot = struct.pack("<BQQQ", 2, 20, begin, 0)
    crc = struct.pack("<I", zlib.crc32(head[begin:] + foot))
    assert at_a_glance(head + foot + crc + mcap.MAGIC) is None
