"""Edge: the user's configuration folder: small text files, read whole, replaced whole."""

from __future__ import annotations

import re
from pathlib import Path

import platformdirs

from app.motion.basics import InputError

#: A name that a person gives is a file's name and nothing else: no separators, no leading dot.
NAME = re.compile(r"[\w][\w \-]{0,39}")
NAMES = "up to 40 letters, digits, spaces, - or _"


def folder(name: str) -> Path:
    """A folder of ours; it need not exist."""
    return Path(platformdirs.user_config_dir("stridescope", appauthor=False)) / name


def names_in(place: Path) -> list[str]:
    """What TOML files are called that a person named; nothing where there is no such folder."""
    try:
        return sorted(path.stem for path in place.glob("*.toml") if NAME.fullmatch(path.stem))
    except OSError:
        return []


def read(what: str, path: Path, most_bytes: int, expected: str) -> str | None:
    """A file's text; None where there is none. ``what`` begins the one line of ``InputError``."""
    try:
        if path.exists() and not path.is_file():
            raise InputError(f"{what}: not a file, expected {expected}")
        if path.stat().st_size > most_bytes:
            raise InputError(f"{what}: {path.stat().st_size} bytes, expected {expected}")
        return path.read_text("utf-8")
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{what}: cannot be read: {reason(error)}") from None


def write(what: str, path: Path, text: str, before: Path | None = None) -> None:
    """Put a file in the place of the one before, which stays as ``before`` if that is wanted."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        new = path.with_suffix(".new")
        new.write_text(text, "utf-8")
        if before is not None and path.exists():
            path.replace(before)
        new.replace(path)
    except OSError as error:
        raise InputError(f"{what}: cannot be saved in {path.parent}: {reason(error)}") from None


def reason(error: Exception) -> str:
    """What is wrong, without what the line says already."""
    return (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
