"""Edge: the user's configuration folder: what the set-up found for a visitor, as TOML files."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from pathlib import Path

from app.home import small
from app.home.small import NAME, NAMES
from app.motion.basics import InputError

MOST_BYTES = 4096
_KEYS = ("on_radps", "off_radps", "sure_rad", "swapped")


def folder() -> Path:
    """Where visitors are kept; it need not exist."""
    return small.folder("visitors")


def place(name: str) -> Path:
    """The file of a visitor; a name that is not a plain file name is ``InputError``."""
    if not name:
        raise InputError("no visitor's name: type one first, then save")
    if not NAME.fullmatch(name):
        raise InputError(f"visitor {name!r}: expected {NAMES}")
    return folder() / f"{name}.toml"


def names() -> tuple[str, ...]:
    """Who has been here."""
    return tuple(small.names_in(folder()))


def save(name: str, values: Mapping[str, float | bool]) -> None:
    """Keep thresholds and whether the feet are swapped."""
    lines = [f"{key} = {str(values[key]).lower()}\n" for key in _KEYS if key in values]
    small.write(f"visitor {name!r}", place(name), "".join(lines))


def load(name: str) -> dict[str, float | bool]:
    """What was kept; ``InputError`` names what is wrong with it."""
    text = small.read(f"visitor {name!r}", place(name), MOST_BYTES, "a few lines")
    if text is None:
        raise InputError(f"visitor {name!r}: cannot be read: no such file")
    try:
        found = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"visitor {name!r}: cannot be read: {error}") from None
    for key, value in found.items():
        number = isinstance(value, int | float) and not isinstance(value, bool)
        fits = (
            isinstance(value, bool) if key == "swapped" else number and math.isfinite(value) and value > 0.0
        )
        if key not in _KEYS or not fits:
            raise InputError(f"visitor {name!r}: {key} = {value!r}: expected {', '.join(_KEYS)}")
    return found
