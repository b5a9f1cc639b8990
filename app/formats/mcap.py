"""Heart: MCAP containers: chunks of messages with a CRC, written in order, read as a stream.

https://mcap.dev/spec. Schemas and channels stand inside the chunks, where the CRC covers them. A chunk
is found by its mark and believed only by its CRC, so a damaged or cut file gives all that is whole.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from app.compressed import LARGEST, pack, unpack_all
from app.formats.records import MESSAGE, At, table
from app.motion.basics import Ints

MAGIC = b"\x89MCAP0\r\n"
LIBRARY = "stridescope"

_HEADER, _FOOTER, _SCHEMA, _CHANNEL, _, _CHUNK, _MESSAGE_INDEX, _CHUNK_INDEX = range(1, 9)
_STATISTICS, _SUMMARY_OFFSET, _DATA_END = 0x0B, 0x0E, 0x0F
_COMPRESSION = b"\x04\x00\x00\x00zstd"  # as it stands in every chunk
_RECORD = struct.Struct("<BQ")
_CHUNK_HEAD = struct.Struct("<BQQQQI8sQ")  # opcode, length, start, end, size, crc, "zstd", packed size
_MARK_AT = 37  # of the compression's name in a chunk
_TOGETHER = 4 * 2**20  # bytes of records unpacked at once
_MESSAGE_HEAD = struct.Struct("<BQHIQQ")


class Channel(NamedTuple):
    """Where messages of one kind go. A CDR message's ``schema`` is ros2msg, a JSON one's jsonschema."""

    id: int
    topic: str
    encoding: str  # "cdr" | "json"
    schema: str
    definition: bytes
    metadata: tuple[tuple[str, str], ...] = ()


class Message(NamedTuple):
    """One message as it stands in a chunk."""

    channel: int
    sequence: int
    log_ns: int
    publish_ns: int
    data: bytes


def _string(text: str) -> bytes:
    data = text.encode()
    return struct.pack("<I", len(data)) + data


def _record(opcode: int, content: bytes) -> bytes:
    return _RECORD.pack(opcode, len(content)) + content


def _definitions(channel: Channel) -> bytes:
    """The channel's schema (of the same number) and the channel."""
    encoding = "ros2msg" if channel.encoding == "cdr" else "jsonschema"
    schema = struct.pack("<H", channel.id) + _string(channel.schema) + _string(encoding)
    schema += struct.pack("<I", len(channel.definition)) + channel.definition
    pairs = b"".join(_string(key) + _string(value) for key, value in channel.metadata)
    body = struct.pack("<HH", channel.id, channel.id) + _string(channel.topic) + _string(channel.encoding)
    return _record(_SCHEMA, schema) + _record(_CHANNEL, body + struct.pack("<I", len(pairs)) + pairs)


# --- writing -------------------------------------------------------------------------------------


@dataclass
class Writer:
    """Turns channels and messages into the bytes of a file, in order; knows no file itself.

    ``chunk`` closes what came since the last one; every ``repeat``-th defines all channels again.
    """

    repeat: int = 8
    channels: list[Channel] = field(default_factory=list)
    size: int = 0  # bytes given out so far
    counts: dict[int, int] = field(default_factory=dict)
    _new: list[Channel] = field(default_factory=list)
    _messages: list[Message] = field(default_factory=list)
    _indexes: list[bytes] = field(default_factory=list)
    _span: tuple[int, int] = (2**64 - 1, 0)

    def begin(self) -> bytes:
        """The first bytes of a file."""
        return self._out(MAGIC + _record(_HEADER, _string("") + _string(LIBRARY)))

    def channel(
        self,
        topic: str,
        encoding: str,
        schema: str,
        definition: str,
        metadata: tuple[tuple[str, str], ...] = (),
    ) -> int:
        """A new channel's number."""
        made = Channel(len(self.channels) + 1, topic, encoding, schema, definition.encode(), metadata)
        self.channels.append(made)
        self._new.append(made)
        return made.id

    def add(self, channel: int, sequence: int, log_ns: int, publish_ns: int, data: bytes) -> None:
        """One message for the next chunk; the numbers are kept modulo their width."""
        numbers = (sequence % 2**32, log_ns % 2**64, publish_ns % 2**64)
        self._messages.append(Message(channel, *numbers, data))

    def chunk(self) -> bytes:
        """Close a chunk: its bytes, ready to be synced; none if there is nothing to say."""
        if not self._messages:
            return b""
        again = len(self._indexes) % self.repeat == 0
        parts = [_definitions(channel) for channel in (self.channels if again else self._new)]
        offset = sum(map(len, parts))
        index: dict[int, list[int]] = {}
        for channel, sequence, log_ns, publish_ns, data in self._messages:
            index.setdefault(channel, []).extend((log_ns, offset))
            head = _MESSAGE_HEAD.pack(MESSAGE, 22 + len(data), channel, sequence, log_ns, publish_ns)
            parts += (head, data)
            offset += len(head) + len(data)
        start = min(message.log_ns for message in self._messages)
        end = max(message.log_ns for message in self._messages)
        self._span = (min(start, self._span[0]), max(end, self._span[1]))
        self._messages, self._new = [], []
        return self._out(self._chunk(b"".join(parts), start, end, index))

    def _chunk(self, records: bytes, start: int, end: int, index: dict[int, list[int]]) -> bytes:
        packed = pack(records)
        head = struct.pack("<QQQI", start, end, len(records), zlib.crc32(records))
        body = _record(_CHUNK, head + _COMPRESSION + struct.pack("<Q", len(packed)) + packed)
        indexes: list[bytes] = []
        places: list[bytes] = []
        after = self.size + len(body)
        for channel, pairs in index.items():
            self.counts[channel] = self.counts.get(channel, 0) + len(pairs) // 2
            places.append(struct.pack("<HQ", channel, after + sum(map(len, indexes))))
            entry = struct.pack(f"<HI{len(pairs)}Q", channel, 8 * len(pairs), *pairs)
            indexes.append(_record(_MESSAGE_INDEX, entry))
        tail = b"".join(places)
        place = struct.pack("<QQQQI", start, end, self.size, len(body), len(tail)) + tail
        place += struct.pack("<Q", sum(map(len, indexes))) + _COMPRESSION
        self._indexes.append(_record(_CHUNK_INDEX, place + struct.pack("<QQ", len(packed), len(records))))
        return body + b"".join(indexes)

    def end(self) -> bytes:
        """The last bytes: a summary, so that other tools can seek."""
        data_end = _record(_DATA_END, struct.pack("<I", 0))
        groups = [
            (_SCHEMA, b"".join(_definitions(channel) for channel in self.channels)),
            (_STATISTICS, _record(_STATISTICS, self._statistics())),
            (_CHUNK_INDEX, b"".join(self._indexes)),
        ]
        summary = b"".join(group for _, group in groups)
        start = self.size + len(data_end)
        footer = _RECORD.pack(_FOOTER, 20) + struct.pack("<QQ", start, 0)
        crc = struct.pack("<I", zlib.crc32(summary + footer))
        return self._out(data_end + summary + footer + crc + MAGIC)

    def _statistics(self) -> bytes:
        start, end = self._span if self.counts else (0, 0)
        numbers = (sum(self.counts.values()), len(self.channels), len(self.channels), 0, 0)
        counts = b"".join(struct.pack("<HQ", channel, count) for channel, count in self.counts.items())
        head = struct.pack("<QHIIIIQQI", *numbers, len(self._indexes), start, end, len(counts))
        return head + counts

    def _out(self, data: bytes) -> bytes:
        self.size += len(data)
        return data


# --- reading -------------------------------------------------------------------------------------


class Contents(NamedTuple):
    """What is whole in a file: channels by number, chunks' messages in order, and whether it was closed."""

    channels: dict[int, Channel]
    chunks: tuple[tuple[Message, ...], ...]
    closed: bool


class Index(NamedTuple):
    """What a closed file's summary says; of each chunk: where it is, how long, and its channels."""

    channels: dict[int, Channel]
    chunks: tuple[tuple[int, int, frozenset[int]], ...]
    start_ns: int
    end_ns: int


_FOOT = struct.Struct("<BQQQI8s")  # opcode, length, summary's start, offsets' start, crc, magic


def index(size: int, read_at: Callable[[int, int], bytes]) -> Index | None:
    """A file's index, by ``read_at`` (offset, count) alone; None if it is not closed or not whole."""
    foot = read_at(max(0, size - _FOOT.size), _FOOT.size)
    if len(foot) < _FOOT.size or read_at(0, len(MAGIC)) != MAGIC:
        return None
    opcode, length, start, _, crc, magic = _FOOT.unpack(foot)
    if (opcode, length, magic) != (_FOOTER, 20, MAGIC) or not len(MAGIC) <= start <= size - _FOOT.size:
        return None
    if size - start > LARGEST:
        return None
    summary = read_at(start, size - _FOOT.size - start)
    rows = table(summary)
    if zlib.crc32(summary + foot[:-12]) != crc or rows is None:
        return None
    channels: dict[int, Channel] = {}
    if not define(summary, rows, channels):
        return None
    own = rows[rows[:, At.OPCODE] == _CHUNK_INDEX, At.BEGIN :].tolist()
    try:
        places = [_place(summary[begin:end]) for begin, end in own]
    except struct.error:
        return None
    start_ns = min((start for (start, _), _ in places), default=0)
    end_ns = max((end for (_, end), _ in places), default=0)
    return Index(channels, tuple(chunk for _, chunk in places), start_ns, end_ns)


def _place(entry: bytes) -> tuple[tuple[int, int], tuple[int, int, frozenset[int]]]:
    """A chunk index: the time it spans, and the chunk."""
    start, end, at, length, places = struct.unpack_from("<QQQQI", entry)
    numbers = (number for number, _ in struct.iter_unpack("<HQ", entry[36 : 36 + places]))
    return (start, end), (at, length, frozenset(numbers))


def messages(chunks: bytes, channels: dict[int, Channel]) -> Iterator[Message]:
    """The messages of chunks that stand one behind the other, of these channels."""
    for records in whole_chunks(MAGIC + chunks):
        yield from _messages(records, dict(channels)) or ()


def recognises(data: bytes) -> bool:
    """Whether the bytes begin as an MCAP file does."""
    return data.startswith(MAGIC)


def read(data: bytes) -> Contents:
    """Everything whole in a file, damaged or cut or not; it never raises."""
    channels: dict[int, Channel] = {}
    chunks = []
    for records in whole_chunks(data):
        found = _messages(records, channels)
        if found is not None:
            chunks.append(tuple(found))
    known = tuple(tuple(m for m in chunk if m.channel in channels) for chunk in chunks)
    return Contents(channels, known, is_closed(data))


def is_closed(data: bytes) -> bool:
    """Whether the file has its end."""
    return data.endswith(MAGIC) and len(data) > 2 * len(MAGIC)


class _Found(NamedTuple):
    """A chunk by its own words: where it is, and what its records should be."""

    begin: int
    next: int  # where to look on: its end, or its second byte where it says two lengths
    frame: bytes
    size: int
    crc: int


def whole_chunks(data: bytes) -> Iterator[bytes]:
    """The records of every chunk whose CRC is good, in the file's order."""
    position, together = len(MAGIC), _TOGETHER
    while found := _chunks_from(data, position, together):
        together = min(2 * together, _TOGETHER)
        unpacked = unpack_all([chunk.frame for chunk in found], [chunk.size for chunk in found])
        for chunk, records in zip(found, unpacked, strict=True):
            if records is None or _crc(records) != chunk.crc:
                # it may have said a false length: look from behind its first byte, and in small steps for now
                position, together = chunk.begin + 1, 1
                break
            position = chunk.next
            yield records


def _chunks_from(data: bytes, position: int, together: int) -> list[_Found]:
    """Some chunks that follow one another if each is as long as it says."""
    found: list[_Found] = []
    size = 0
    while size < together and (mark := data.find(_COMPRESSION, position + _MARK_AT)) >= 0:
        begin = mark - _MARK_AT
        chunk = _chunk_at(data, begin)
        position = begin + 1 if chunk is None else chunk.next
        if chunk is not None:
            found.append(chunk)
            size += chunk.size
    return found


def _chunk_at(data: bytes, begin: int) -> _Found | None:
    """The chunk that begins there, if one does."""
    if len(data) - begin < _CHUNK_HEAD.size:
        return None
    opcode, length, _, _, size, crc, _, packed = _CHUNK_HEAD.unpack_from(data, begin)
    end = begin + _CHUNK_HEAD.size + packed
    if opcode != _CHUNK or size > LARGEST or end > len(data):
        return None
    agreed = begin + _RECORD.size + length == end  # a frame is good whatever stands behind it
    return _Found(begin, end if agreed else begin + 1, data[begin + _CHUNK_HEAD.size : end], size, crc)


def _crc(records: bytes) -> int:
    """zlib's, piece by piece: for more than 5 kB it would hand over the interpreter's lock each time."""
    crc, view = 0, memoryview(records)
    for begin in range(0, len(view), 4096):
        crc = zlib.crc32(view[begin : begin + 4096], crc)
    return crc


def _messages(records: bytes, channels: dict[int, Channel]) -> list[Message] | None:
    """The messages of a chunk; its channels go into ``channels``. None if it is not what the CRC promised."""
    rows = table(records)
    if rows is None or not define(records, rows, channels):
        return None
    return [
        Message(number, sequence, log_ns % 2**64, publish_ns % 2**64, records[begin:end])
        for opcode, number, sequence, log_ns, publish_ns, begin, end in rows.tolist()
        if opcode == MESSAGE
    ]


def define(records: bytes, rows: Ints, channels: dict[int, Channel]) -> bool:
    """Put the channels that a chunk defines into ``channels``; False if a definition makes no sense."""
    if len(rows) and rows[0, At.OPCODE] == MESSAGE and (rows[:, At.OPCODE] == MESSAGE).all():
        return True
    own = rows[rows[:, At.OPCODE] == _CHANNEL, At.NUMBER]
    if all(number in channels for number in own.tolist()):  # repeated for whoever begins to read here
        return True
    schemas: dict[int, tuple[str, bytes]] = {}
    found: dict[int, Channel] = {}
    try:
        for opcode, *_, begin, end in rows[rows[:, At.OPCODE] != MESSAGE].tolist():
            if opcode == _SCHEMA:
                number, name, definition = _schema(records[begin:end])
                schemas[number] = (name, definition)
            elif opcode == _CHANNEL:
                channel = _channel(records[begin:end], schemas)
                found.setdefault(channel.id, channel)
    except (struct.error, UnicodeDecodeError, KeyError):
        return False
    for number, channel in found.items():
        channels.setdefault(number, channel)
    return True


def _text(data: bytes, at: int) -> tuple[str, int]:
    (length,) = struct.unpack_from("<I", data, at)
    return data[at + 4 : at + 4 + length].decode(), at + 4 + length


def _schema(data: bytes) -> tuple[int, str, bytes]:
    (number,) = struct.unpack_from("<H", data)
    name, at = _text(data, 2)
    _, at = _text(data, at)
    return number, name, data[at + 4 :]


def _channel(data: bytes, schemas: dict[int, tuple[str, bytes]]) -> Channel:
    number, schema = struct.unpack_from("<HH", data)
    topic, at = _text(data, 4)
    encoding, at = _text(data, at)
    (length,) = struct.unpack_from("<I", data, at)
    at, end = at + 4, at + 4 + length
    pairs = []
    while at < end:
        key, at = _text(data, at)
        value, at = _text(data, at)
        pairs.append((key, value))
    name, definition = schemas[schema]
    return Channel(number, topic, encoding, name, definition, tuple(pairs))
