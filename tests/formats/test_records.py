"""The compiled walk over a chunk's records against a plain one, on any bytes."""

from __future__ import annotations

import struct

from hypothesis import given
from hypothesis import strategies as st

from app.formats.records import MESSAGE, table

record = st.tuples(st.sampled_from([3, 4, MESSAGE, MESSAGE, 0xFF]), st.binary(max_size=40)).map(
    lambda item: struct.pack("<BQ", item[0], len(item[1])) + item[1]
)
damage = st.tuples(st.integers(0, 10**6), st.integers(0, 255))


def plainly(records: bytes) -> list[list[int]] | None:
    """The same table, as the specification reads."""
    rows, at = [], 0
    while at < len(records):
        if len(records) - at < 9:
            return None
        opcode, length = struct.unpack_from("<BQ", records, at)
        content = records[at + 9 : at + 9 + length]
        if len(content) < length or (opcode == MESSAGE and length < 22):
            return None
        number = struct.unpack_from("<H", content)[0] if length >= 2 else -1
        told = struct.unpack_from("<Iqq", content, 2) if opcode == MESSAGE else (0, 0, 0)
        begin = at + 9 + (22 if opcode == MESSAGE else 0)
        at += 9 + length
        rows.append([opcode, number, *told, begin, at])
    return rows


@given(st.lists(record, max_size=8), st.none() | damage)
def test_the_table_is_what_the_specification_says(parts, harm) -> None:
    records = bytearray(b"".join(parts))
    if harm and records:
        records[harm[0] % len(records)] = harm[1]
    found = table(bytes(records))
    assert (None if found is None else found.tolist()) == plainly(bytes(records))


@given(st.binary(max_size=60))
def test_rubbish_is_no_table_or_the_same(data: bytes) -> None:
    found = table(data)
    assert (None if found is None else found.tolist()) == plainly(data)
