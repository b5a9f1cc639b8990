from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.stream import NO_PACKET, UNKNOWN_YET, Frames, find_first, find_header


def toy() -> Frames:
    """``AB``, a length, so many bytes, their sum."""

    def size(data: bytes, at: int) -> int:
        return UNKNOWN_YET if len(data) < at + 3 else data[at + 2] + 4 if data[at + 2] < 20 else NO_PACKET

    return Frames(find_header(b"AB"), size, lambda packet: sum(packet[3:-1]) & 0xFF == packet[-1], 23)


def packet(data: bytes) -> bytes:
    return b"AB" + bytes([len(data)]) + data + bytes([sum(data) & 0xFF])


@given(st.lists(st.tuples(st.binary(max_size=19), st.binary(max_size=5).filter(lambda b: b"A" not in b))))
def test_every_packet_is_found_behind_any_rubbish_and_every_byte_counted(parts) -> None:
    frames = toy()
    found = [p for data, rubbish in parts for p in frames.feed(rubbish + packet(data))]
    assert found == [packet(data) for data, _ in parts]
    c = frames.counters
    assert c.bytes_skipped == sum(len(rubbish) for _, rubbish in parts)
    assert (c.bytes_good, c.bytes_pending, c.packets) == (sum(map(len, found)), 0, len(parts))


def test_a_packet_inside_a_damaged_one_is_found() -> None:
    frames = toy()
    inner = packet(b"xyz")
    assert frames.feed(b"AB" + bytes([len(inner)]) + inner + b"?") == [inner]
    assert frames.counters.bad_checksum == 1
    assert frames.counters.bytes_skipped == 4


def test_breaks_say_where_bytes_were_skipped() -> None:
    frames = toy()
    one = packet(b"1")
    assert len(frames.feed(one + one + b"??" + one)) == 3
    assert frames.breaks == {2}
    assert frames.feed(b"?") == []
    frames.feed(one)
    assert frames.breaks == {0}


def test_half_a_header_at_the_end_is_kept() -> None:
    frames = toy()
    assert frames.feed(b"...A") == []
    assert frames.counters.bytes_pending == 1
    assert frames.feed(packet(b"q")[1:]) == [packet(b"q")]


def test_first_bytes_are_found_and_nothing_else() -> None:
    find = find_first(b"AZ")
    assert [find(b"--Z-A", at) for at in range(6)] == [2, 2, 2, 4, 4, 5]


def test_what_never_ends_is_let_go_at_the_longest_length() -> None:
    frames = Frames(find_first(b"A"), lambda data, at: UNKNOWN_YET, lambda packet: True, 10)
    frames.feed(b"A" * 1000)
    assert frames.counters.bytes_pending == 9
