"""What is whole in a damaged recording comes back, and nothing that was not in it."""

from __future__ import annotations

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.formats import kept
from app.formats.recover import recover
from app.motion.basics import InputError
from app.motion.samples import Sample
from tests.formats.walks import random_samples, write

SAMPLES = random_samples(40)
WHOLE = write(SAMPLES, chunk=4)


def left_in(data: bytes) -> list[Sample]:
    return kept.samples(kept.kept("x", recover("x", data).data))


def test_a_whole_file_is_recovered_whole() -> None:
    made = recover("x", WHOLE)
    assert (made.samples, made.chunks, made.was_whole) == (40, 10, True)
    assert left_in(WHOLE) == SAMPLES


@pytest.mark.parametrize("first", range(8))
def test_cut_anywhere_it_gives_every_chunk_before(first: int) -> None:
    for length in range(first, len(WHOLE), 101):
        try:
            found = left_in(WHOLE[:length])
        except InputError as error:
            assert "not one whole chunk" in str(error)
            continue
        assert found == SAMPLES[: len(found)]
        assert len(found) % 4 == 0


def test_a_thousand_flipped_bits_cost_a_chunk_each() -> None:
    chance = random.Random(4)
    for _ in range(1000):
        damaged = bytearray(WHOLE)
        damaged[chance.randrange(len(WHOLE))] ^= 1 << chance.randrange(8)
        made = recover("x", bytes(damaged))
        assert made.samples >= 36


def test_a_chunk_that_says_it_is_longer_hides_none_behind_it() -> None:
    begin = WHOLE.index(b"zstd", 3000) - 41
    for bit in range(8, 15):
        damaged = bytearray(WHOLE)
        damaged[begin + 45 + bit // 8] ^= 1 << bit % 8
        assert recover("x", bytes(damaged)).samples >= 36


def test_the_first_chunk_is_not_needed() -> None:
    damaged = bytearray(WHOLE)
    damaged[300] ^= 1
    found = left_in(bytes(damaged))
    assert found == SAMPLES[4:]


@settings(max_examples=100)
@given(st.binary(max_size=300))
def test_rubbish_is_one_line(data: bytes) -> None:
    with pytest.raises(InputError, match="not one whole chunk") as error:
        recover("x", data)
    assert "\n" not in str(error.value)
