"""Heart: names of files that a browser may give: a name and nothing else: no way out of the folder."""

from __future__ import annotations

import unicodedata

from app.motion.basics import InputError

LONGEST = 120  # bytes: with a suffix it still fits every file system
#: What separates folders somewhere, or means a device or a stream of a file there.
_REFUSED = frozenset('/\\:*?"<>|')


def file_name(text: str) -> str:
    """The name as it is kept; ``InputError`` for one that could mean anything but a file in its folder."""
    name = unicodedata.normalize("NFC", text.strip())
    shown = "".join(c if c.isprintable() else "?" for c in name)[:60]
    if not name or name.startswith(".") or name.endswith("."):
        raise InputError(f"file name {shown!r}: expected a name that does not begin or end with a dot")
    if not name.isprintable() or _REFUSED & set(name):
        raise InputError(f"file name {shown!r}: expected letters, digits, spaces and dashes, no / or \\")
    try:
        length = len(name.encode())
    except UnicodeEncodeError:
        raise InputError(f"file name {shown!r}: not text") from None
    if length > LONGEST:
        raise InputError(f"file name {shown!r}…: {length} bytes, expected at most {LONGEST}")
    return name


def with_suffix_of(text: str, old: str) -> str:
    """A new name for a file, which keeps its suffix whatever is typed."""
    dot = old.rfind(".")
    suffix = old[dot:] if dot > 0 else ""
    return file_name(
        text if not suffix or text.strip().lower().endswith(suffix.lower()) else text.strip() + suffix
    )
