"""Heart: what a closed recording of ours shows at a glance: by its summary, without reading its samples."""

from __future__ import annotations

from collections.abc import Callable

from app.formats import keeping, mcap
from app.formats.states import joined, read_way
from app.motion.basics import Role, role_of
from app.motion.estimate import Way
from app.motion.source import Outline

#: Bytes of a file from an offset on: (offset, count) → bytes, fewer at its end.
ReadAt = Callable[[int, int], bytes]

#: More than this takes as long as all of it: a replay recorded as fast as it went has large chunks.
MOST_BYTES = 16_000_000


def glance(name: str, size: int, read_at: ReadAt) -> Outline | None:
    """The trails that the file tells and how long it is; None if it tells none or has no good summary."""
    found = mcap.index(size, read_at)
    roles = {} if found is None else _roles(found)
    if found is None or not roles:
        return None
    wanted = [(at, length) for at, length, channels in found.chunks if channels & set(roles)]
    if sum(length for _, length in wanted) > MOST_BYTES:
        return None
    chunks = b"".join(read_at(at, length) for at, length in wanted)
    ways: dict[int, list[Way]] = {number: [] for number in roles}
    for message in mcap.messages(chunks, found.channels):
        way = read_way(message.data) if message.channel in ways else None
        if way is not None:
            ways[message.channel].append(way)
    whole = ((roles[number], joined(own)) for number, own in ways.items())
    told = tuple((role, way.segments) for role, way in whole if way is not None)
    return Outline(name, (found.end_ns - found.start_ns) * 1e-9, told) if told else None


def _roles(found: mcap.Index) -> dict[int, Role]:
    """Each sensor's role, by the number of the channel that has its trail."""
    about = {number: dict(channel.metadata) for number, channel in found.channels.items()}
    return {
        number: Role(told["role"]) if told.get("role") in set(Role) else role_of(told.get("sensor", ""))
        for number, told in about.items()
        if told.get("kind") == keeping.WAY
    }
