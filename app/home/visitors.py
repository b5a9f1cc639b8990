"""Edge: the user's configuration folder: what the set-up found for a visitor, as TOML files."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path

import platformdirs

from app.motion.basics import InputError

#: A visitor's name is a file's name and nothing else.
NAME = re.compile(r"[\w][\w \-]{0,39}")
MOST_BYTES = 4096
_KEYS = ("on_radps", "off_radps", "sure_rad", "swapped")


def folder() -> Path:
    """Where visitors are kept; it need not exist."""
    return Path(platformdirs.user_config_dir("stridescope", appauthor=False)) / "visitors"


def place(name: str) -> Path:
    """The file of a visitor; a name that is not a plain file name is ``InputError``."""
    if not NAME.fullmatch(name):
        raise InputError(f"visitor {name!r}: expected up to 40 letters, digits, spaces, - or _")
    return folder() / f"{name}.toml"


def names() -> tuple[str, ...]:
    """Who has been here."""
    try:
        found = sorted(path.stem for path in folder().glob("*.toml"))
    except OSError:
        return ()
    return tuple(name for name in found if NAME.fullmatch(name))


def save(name: str, values: Mapping[str, float | bool]) -> None:
    """Keep thresholds and whether the feet are swapped."""
    path = place(name)
    lines = [f"{key} = {str(values[key]).lower()}\n" for key in _KEYS if key in values]
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        new = path.with_suffix(".new")
        new.write_text("".join(lines), "utf-8")
        new.replace(path)
    except OSError as error:
        raise InputError(f"visitor {name!r}: cannot be saved: {error.strerror or error}") from None


def load(name: str) -> dict[str, float | bool]:
    """What was kept; ``InputError`` names what is wrong with it."""
    path = place(name)
    try:
        if path.stat().st_size > MOST_BYTES:
            raise InputError(f"visitor {name!r}: {path.stat().st_size} bytes, expected a few lines")
        found = tomllib.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"visitor {name!r}: cannot be read: {error}") from None
    for key, value in found.items():
        number = isinstance(value, int | float) and not isinstance(value, bool)
        fits = (
            isinstance(value, bool) if key == "swapped" else number and math.isfinite(value) and value > 0.0
        )
        if key not in _KEYS or not fits:
            raise InputError(f"visitor {name!r}: {key} = {value!r}: expected {', '.join(_KEYS)}")
    return found
