"""Edge: the user's configuration folder: a key by which this program knows again what it wrote itself."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from app.home import small

LENGTH = 32


def path() -> Path:
    """Where it lies; it need not exist yet."""
    return small.folder("key")


def key() -> bytes:
    """The user's key, made when first asked for; where none can be kept, one for this run."""
    try:
        return _read() or _made()
    except OSError:
        return _made_up


def _read() -> bytes:
    """The key; nothing if there is none, or something else in its place."""
    try:
        found = path().read_bytes()
    except FileNotFoundError:
        return b""
    return found if len(found) == LENGTH else _made_up


def _made() -> bytes:
    path().parent.mkdir(parents=True, exist_ok=True)
    made = path().with_name(f"key.{secrets.token_hex(4)}")
    descriptor = os.open(made, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "wb") as file:
        file.write(secrets.token_bytes(LENGTH))
    try:
        os.link(made, path())  # whole from the first moment, and never in place of another's
    except FileExistsError:
        pass
    finally:
        made.unlink()
    return _read() or _made_up


_made_up = secrets.token_bytes(LENGTH)
