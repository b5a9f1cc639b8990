"""Heart: what is whole in a damaged recording, as a new file: every chunk with a good CRC, nothing else."""

from __future__ import annotations

from typing import NamedTuple

from app.formats import mcap
from app.formats.keeping import IMU
from app.motion.basics import InputError


class Recovered(NamedTuple):
    """A new file's bytes, and what is in it."""

    data: bytes
    chunks: int
    messages: int
    samples: int
    was_whole: bool  # the file had its end: nothing was cut off


def recover(name: str, data: bytes) -> Recovered:
    """Every whole message of every whole chunk, in order; ``InputError`` if there is none."""
    contents = mcap.read(data)
    if not any(contents.chunks):
        raise InputError(f"{name}: not one whole chunk in {len(data)} bytes: nothing can be recovered")
    writer = mcap.Writer()
    numbers = {
        old: writer.channel(c.topic, c.encoding, c.schema, c.definition.decode(errors="replace"), c.metadata)
        for old, c in contents.channels.items()
    }
    parts = [writer.begin()]
    for chunk in contents.chunks:
        for message in chunk:
            writer.add(numbers[message.channel], *message[1:])
        parts.append(writer.chunk())
    parts.append(writer.end())
    made = b"".join(parts)
    samples = [numbers[old] for old, c in contents.channels.items() if ("kind", IMU) in c.metadata]
    counts = writer.counts
    return Recovered(
        made,
        len(contents.chunks),
        sum(counts.values()),
        sum(counts.get(n, 0) for n in samples),
        contents.closed,
    )
