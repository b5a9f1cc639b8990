"""MCAP containers: Foxglove's reader agrees, and no damage makes us raise or invent."""

from __future__ import annotations

import io
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import NonSeekingReader, SeekingReader

from app.formats import mcap


def a_file(chunks: int = 5, per_chunk: int = 4, close: bool = True) -> tuple[bytes, list[bytes], list[int]]:
    """A file, its messages, and where each chunk's bytes end."""
    writer = mcap.Writer(repeat=2)
    data, said, ends = writer.begin(), [], []
    channels = [writer.channel(f"/{name}", "json", name, "{}", (("for", name),)) for name in "ab"]
    for i in range(chunks * per_chunk):
        said.append(b'{"i":%d}' % i)
        writer.add(channels[i % 2], i, 1000 + i, -i, said[-1])
        if i % per_chunk == per_chunk - 1:
            chunk = writer.chunk()
            found = mcap._chunk_at(chunk, 0)
            assert found is not None
            ends.append(len(data) + found.next)
            data += chunk
    return data + (writer.end() if close else b""), said, ends


def said_in(data: bytes) -> list[bytes]:
    return [message.data for chunk in mcap.read(data).chunks for message in chunk]


def test_what_was_written_is_read() -> None:
    data, said, _ = a_file()
    contents = mcap.read(data)
    assert said_in(data) == said
    assert contents.closed
    assert contents.channels[2].metadata == (("for", "b"),)
    first = contents.chunks[0][1]
    assert (first.sequence, first.log_ns, first.publish_ns) == (1, 1001, 2**64 - 1)


@pytest.mark.parametrize("reader", [SeekingReader, NonSeekingReader])
def test_foxgloves_readers_find_the_same(reader: type) -> None:
    data, said, _ = a_file()
    found = reader(io.BytesIO(data), validate_crcs=True)
    assert [message.data for _, _, message in found.iter_messages()] == said
    statistics = reader(io.BytesIO(data), validate_crcs=True).get_summary().statistics
    assert statistics.message_count == len(said)
    assert (statistics.message_start_time, statistics.message_end_time) == (1000, 1000 + len(said) - 1)


def test_an_unfinished_file_has_all_of_its_chunks() -> None:
    data, said, _ = a_file(close=False)
    assert said_in(data) == said
    assert not mcap.read(data).closed


def test_cut_at_every_byte_every_whole_chunk_is_there_and_nothing_else() -> None:
    data, said, ends = a_file()
    for length in range(len(data)):
        whole = sum(end <= length for end in ends)
        assert said_in(data[:length]) == said[: 4 * whole]


def test_a_flipped_bit_costs_one_chunk_at_most_and_invents_nothing() -> None:
    data, said, _ = a_file(chunks=8)
    chance = random.Random(1)
    for _ in range(1000):
        damaged = bytearray(data)
        damaged[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        found = said_in(bytes(damaged))
        assert len(found) >= len(said) - 4
        assert [message for message in said if message in set(found)] == found


@settings(max_examples=200)
@given(st.binary(max_size=300))
def test_rubbish_is_an_empty_file(data: bytes) -> None:
    assert mcap.read(mcap.MAGIC + data).chunks == ()


@settings(max_examples=200)
@given(st.binary(max_size=200), st.integers(0, 400))
def test_rubbish_between_chunks_is_passed_over(rubbish: bytes, at: int) -> None:
    data, said, ends = a_file(chunks=2)
    assert said_in(data[: ends[0]] + rubbish + data[ends[0] :]) == said


def test_a_chunk_that_keeps_its_crc_but_makes_no_sense_is_left_out() -> None:
    writer = mcap.Writer()
    data = writer.begin() + writer._chunk(b"\x05\xff\xff\xff\xff\xff\xff\xff\x00", 0, 0, {})
    assert mcap.read(data).chunks == ()
