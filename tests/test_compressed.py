"""The compressor: what goes in comes out, and damage is None."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.compressed import LARGEST, Unpacker, pack


@given(st.binary(max_size=500))
def test_what_is_packed_comes_back(data: bytes) -> None:
    assert Unpacker()(pack(data), len(data)) == data


@given(st.binary(max_size=60), st.integers(0, 2**63))
def test_rubbish_is_none_or_of_the_size_asked_for(frame: bytes, size: int) -> None:
    data = Unpacker()(frame, size)
    assert data is None or len(data) == size


def test_another_size_is_refused() -> None:
    assert Unpacker()(pack(b"abc"), 4) is None
    assert Unpacker()(pack(b"abc"), LARGEST + 1) is None
