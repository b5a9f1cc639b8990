"""Estimates and ways as messages: to the bit and back, and nothing that somebody forged."""

from __future__ import annotations

import json

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.formats import states
from app.motion.estimate import Saved, Way
from app.settings import BUILT_IN

KEY = b"k" * 32
numbers = st.floats(width=64, allow_nan=False)
vectors = st.tuples(numbers, numbers, numbers)
any_state = st.builds(
    Saved,
    st.sampled_from(list(BUILT_IN.values())),
    st.integers(0, 2**40),
    st.binary(max_size=60),
    st.lists(numbers, max_size=13).map(tuple),
    st.integers(0, 2**30),
    numbers,
    st.none() | st.tuples(numbers, vectors, numbers),
)


@given(any_state)
def test_a_state_comes_back_to_the_bit(saved: Saved) -> None:
    assert states.read_state(states.write_state(saved, KEY), KEY) == saved


@given(any_state, st.binary(min_size=1, max_size=32))
def test_a_state_of_another_key_is_none(saved: Saved, key: bytes) -> None:
    assert key == KEY or states.read_state(states.write_state(saved, key), KEY) is None


@given(any_state, st.data())
def test_a_state_that_somebody_changed_is_none(saved: Saved, data: st.DataObject) -> None:
    written = bytearray(states.write_state(saved, KEY))
    at = data.draw(st.integers(0, len(written) - 1))
    written[at] ^= 1 << data.draw(st.integers(0, 6))
    try:
        same = json.loads(bytes(written)) == json.loads(states.write_state(saved, KEY))
    except ValueError:
        same = False
    assert same or states.read_state(bytes(written), KEY) is None


def test_a_state_of_other_kernels_is_none(monkeypatch) -> None:
    saved = Saved(BUILT_IN["papers"], 1, b"x", (), 0, 0.0, None)
    monkeypatch.setattr(states, "KERNELS", "others")
    written = states.write_state(saved, KEY)
    monkeypatch.undo()
    assert states.read_state(written, KEY) is None


@given(st.binary(max_size=200) | st.text().map(str.encode))
def test_any_bytes_are_read_without_a_fault(data: bytes) -> None:
    assert states.read_state(data, KEY) is None
    states.read_way(data)


json_values = st.recursive(
    st.none() | st.booleans() | numbers | st.integers() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4),
    max_leaves=12,
)


@given(json_values, json_values, json_values)
def test_any_json_is_read_without_a_fault(first, last, lines) -> None:
    told = {"first": first, "last": last, "lines_ned_m": lines}
    way = states.read_way(json.dumps(told).encode())
    assert way is None or np.isfinite(way.segments).all()


@given(st.lists(st.lists(st.tuples(*[st.floats(-500, 500)] * 3), min_size=2, max_size=6), max_size=4))
def test_a_way_comes_back_to_the_millimetre(lines) -> None:
    segments = [np.stack([line[:-1], line[1:]], axis=1) for line in map(np.array, lines)]
    made = np.concatenate(segments) if segments else np.empty((0, 2, 3))
    way = Way(3, 99, made.astype(np.float32))
    again = states.read_way(states.write_way(way))
    assert again is not None
    assert (again.first, again.last) == (3, 99)
    np.testing.assert_allclose(again.segments, way.segments, atol=6e-4)


def test_ways_join_from_the_newest_start_on() -> None:
    def way(first: int, last: int) -> Way:
        return Way(first, last, np.full((1, 2, 3), first, np.float32))

    joined = states.joined([way(0, 5), way(5, 9), way(0, 7), way(8, 9), way(7, 12)])
    assert joined is not None
    assert (joined.first, joined.last, joined.segments[:, 0, 0].tolist()) == (0, 12, [0.0, 7.0])
    assert states.joined([way(3, 5)]) is None
