"""Edge: the user's configuration folder: profiles are settings as TOML files."""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import asdict
from pathlib import Path

import platformdirs

from app.motion.basics import InputError
from app.settings import BUILT_IN, Settings

#: A profile's name is a file's name and nothing else: no separators, no leading dot.
NAME = re.compile(r"[\w][\w \-]{0,39}")
#: No honest profile is larger.
MOST_BYTES = 64 * 1024


def folder() -> Path:
    """Where profiles live; it need not exist."""
    return Path(platformdirs.user_config_dir("stridescope", appauthor=False)) / "profiles"


def names() -> tuple[str, ...]:
    """The built-in profiles, then the saved ones."""
    try:
        saved = sorted(path.stem for path in folder().glob("*.toml") if NAME.fullmatch(path.stem))
    except OSError:
        saved = []
    return (*BUILT_IN, *(name for name in saved if name not in BUILT_IN))


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
    try:
        if path.exists() and not path.is_file():
            raise InputError(f"profile {path}: not a file, expected a TOML file of settings")
        if path.stat().st_size > MOST_BYTES:
            raise InputError(f"profile {path}: {path.stat().st_size} bytes, expected a TOML file of settings")
        text = path.read_text("utf-8")
    except FileNotFoundError:
        raise InputError(f"profile {path}: no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"profile {path}: cannot be read: {_reason(error)}") from None
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
    if not NAME.fullmatch(name):
        raise InputError(f"profile name {name!r}: expected up to 40 letters, digits, spaces, - or _")
    if name in BUILT_IN:
        raise InputError(f"profile name {name!r}: built in; choose another")
    lines = [f"{key} = {json.dumps(value)}\n" for key, value in asdict(settings).items()]
    path = folder() / f"{name}.toml"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        new = path.with_suffix(".new")
        new.write_text("".join(lines), "utf-8")
        new.replace(path)
    except OSError as error:
        raise InputError(f"profile {name!r}: cannot be saved in {path.parent}: {_reason(error)}") from None
    return path


def _reason(error: Exception) -> str:
    return (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
