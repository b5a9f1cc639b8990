"""Edge: whole files: made new beside what is there, never in its place."""

from __future__ import annotations

import os
from pathlib import Path

from app.motion.basics import InputError


def beside(path: Path, word: str) -> Path:
    """A name that is free: ``walk.mcap`` and ``recovered`` make ``walk_recovered.mcap``, or with a number."""
    for number in range(1, 1000):
        suffix = "" if number == 1 else f"_{number}"
        found = path.with_name(f"{path.stem}_{word}{suffix}{path.suffix or '.mcap'}")
        if not found.exists():
            return found
    raise InputError(f"{path}: a thousand files beside it have its name, expected fewer")


def write_new(path: Path, data: bytes) -> None:
    """The file, synced. One that exists, or a disk that refuses, is ``InputError``; nothing is half left."""
    try:
        file = path.open("xb")
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    try:
        with file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        path.unlink(missing_ok=True)
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
