"""Edge: recordings on disk: the bytes of a file, and every way in which there are none."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from app.formats.options import parse_options
from app.formats.reading import read
from app.motion.basics import InputError
from app.motion.recording import Recording

MOST_BYTES = 2_000_000_000


def load(path: str | Path, options: Mapping[str, str] | None = None, shown: str | None = None) -> Recording:
    """The recording at ``path``; ``options`` as typed (rate, axes, foot, device). ``shown``: what to call it.

    Raises ``InputError``, one line, if there is no such file or it is no recording.
    """
    told = parse_options(options or {})
    try:
        file = Path(path).expanduser()
    except RuntimeError:  # ~nobody
        raise InputError(f"{printable(str(path))}: no such user, expected a recording") from None
    name = printable(shown or file.name)
    return read(name, _bytes(file, printable(shown or str(file))), told)


def printable(name: str) -> str:
    """A name for a message of one line: a file may be called anything, line ends too."""
    return "".join(character if character.isprintable() else "?" for character in name)


def read_bytes(file: Path) -> bytes:
    """The bytes of a file; ``InputError``, one line, if there are none to have."""
    return _bytes(file, printable(str(file)))


def _bytes(file: Path, shown: str) -> bytes:
    try:
        if file.is_dir():
            raise InputError(f"{shown}: a folder, expected a recording")
        if not file.is_file():
            what = "not a regular file" if file.exists() else "no such file"
            raise InputError(f"{shown}: {what}, expected a recording")
        size = file.stat().st_size
        if size > MOST_BYTES:
            raise InputError(f"{shown}: {size / 1e9:.1f} GB, expected at most {MOST_BYTES / 1e9:g} GB")
        return file.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        if isinstance(error, InputError):
            raise
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise InputError(f"{shown}: cannot be read ({reason}), expected a recording") from None
