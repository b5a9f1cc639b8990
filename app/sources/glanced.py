"""Edge: a recording whose samples are still being read: what it shows at a glance, and no sample."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path
from typing import BinaryIO

from app.formats.glance import glance
from app.motion.basics import InputError
from app.motion.commands import ReplayCommand
from app.motion.source import Link, Outline, SourceInfo
from app.sources.files import printable
from app.sources.source import Item, Live
from app.sources.spec import parse_spec

#: Smaller files are read before anybody could look.
LEAST_BYTES = 10_000_000


def glanced(spec_text: str) -> Glanced | None:
    """What stands in for a large recording of ours until it is opened; None where there is no need."""
    spec = parse_spec(spec_text)
    if spec.kind != "replay" or spec.options:
        return None
    try:
        path = Path(spec.target).expanduser()
        size = path.stat().st_size if path.is_file() else 0
        if size < LEAST_BYTES:
            return None
        with path.open("rb") as file:
            outline = glance(printable(path.name), size, lambda at, count: _read_at(file, at, count))
    except (OSError, ValueError, RuntimeError):  # opening it will say what is wrong
        return None
    return Glanced(outline, size) if outline is not None else None


def _read_at(file: BinaryIO, at: int, count: int) -> bytes:
    file.seek(at)
    return file.read(count)


class Glanced(Live):
    """A source that waits, for as long as somebody reads it."""

    link = Link.WAITING

    def __init__(self, outline: Outline, size: int) -> None:
        self.info = SourceInfo(
            outline.name, "Stridescope recording", duration_s=outline.duration_s, outline=outline
        )
        self.detail = f"reading {size / 1e6:.0f} MB"

    def control(self, command: ReplayCommand) -> None:
        """Refused."""
        raise InputError(f"{type(command).__name__.lower()}: {self.info.name} is still being read")

    async def __aiter__(self) -> AsyncIterator[Item]:
        await asyncio.Event().wait()
        return
        yield  # never: it makes this an iterator

    def close(self) -> None:
        """Nothing is held open."""
