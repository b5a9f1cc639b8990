"""The compressor: what goes in comes out, and damage is None."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.compressed import LARGEST, pack, unpack_all


@given(st.lists(st.binary(min_size=1, max_size=500), max_size=6), st.integers(0, 5))
def test_what_is_packed_comes_back_whatever_stands_beside_it(parts: list[bytes], harmed: int) -> None:
    frames = [pack(part) for part in parts]
    wanted: list[bytes | None] = list(parts)
    if harmed < len(frames):
        frames[harmed], wanted[harmed] = frames[harmed][:-1], None
    assert unpack_all(frames, [len(part) for part in parts]) == wanted


@given(st.binary(max_size=60), st.integers(0, 2**63))
def test_rubbish_is_none_or_of_the_size_asked_for(frame: bytes, size: int) -> None:
    (data,) = unpack_all([frame], [size])
    assert data is None or len(data) == size


def test_another_size_is_refused() -> None:
    frame = pack(b"abc")
    assert unpack_all([frame, frame, frame], [4, LARGEST + 1, 3]) == [None, None, b"abc"]
