"""Edge: the user's configuration folder: profiles are settings as TOML files."""

from __future__ import annotations

import json
import tomllib
from dataclasses import asdict
from pathlib import Path

from app.home import small
from app.home.small import NAME, NAMES
from app.motion.basics import InputError
from app.settings import BUILT_IN, Settings

#: No honest profile is larger.
MOST_BYTES = 64 * 1024


def folder() -> Path:
    """Where profiles live; it need not exist."""
    return small.folder("profiles")


def names() -> tuple[str, ...]:
    """The built-in profiles, then the saved ones."""
    return (*BUILT_IN, *(name for name in small.names_in(folder()) if name not in BUILT_IN))


def load(name: str) -> Settings:
    """A profile by name, or from a TOML file; ``InputError`` names what is wrong with it."""
    if name in BUILT_IN:
        return BUILT_IN[name]
    path = Path(name)
    if NAME.fullmatch(name) and path.suffix != ".toml":
        path = folder() / f"{name}.toml"
        if not path.is_file():
            raise InputError(
                f"profile {name!r}: not found, expected one of {', '.join(names())}, or a .toml file"
            )
    return read(path)


def load_named(name: str) -> Settings:
    """A profile by its name only, for whom no other file is meant to be read: a browser."""
    if name not in BUILT_IN and not NAME.fullmatch(name):
        raise InputError(f"profile name {name!r}: expected one of {', '.join(names())}")
    return load(name)


def read(path: Path) -> Settings:
    """The settings of a TOML file; what it leaves out is as in ``papers``."""
    text = small.read(f"profile {path}", path, MOST_BYTES, "a TOML file of settings")
    if text is None:
        raise InputError(f"profile {path}: no such file")
    try:
        values = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # also a number of thousands of digits, a deep nest
        raise InputError(f"profile {path}: not TOML: {error}") from None
    try:
        return BUILT_IN["papers"].with_changes(values)
    except ValueError as error:
        raise InputError(f"profile {path}: {error}") from None


def save(name: str, settings: Settings) -> Path:
    """Save settings under a name; a name that is not a plain file name is ``InputError``."""
    if not name:
        raise InputError("no profile name: type one first, then save")
    if not NAME.fullmatch(name):
        raise InputError(f"profile name {name!r}: expected {NAMES}")
    if name in BUILT_IN:
        raise InputError(f"profile name {name!r}: built in; choose another")
    lines = [f"{key} = {json.dumps(value)}\n" for key, value in asdict(settings).items()]
    path = folder() / f"{name}.toml"
    small.write(f"profile {name!r}", path, "".join(lines))
    return path
