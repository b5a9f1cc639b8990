"""Heart: an estimate and the way to it as messages of a recording, both ways.

A state is believed only if this program's kernels made it for this user (a code made with ``key`` says so):
compiled steps go where a state tells them, so one that somebody forged could lead them anywhere. A way is
only drawn.
"""

from __future__ import annotations

import hmac
import json
from base64 import b64decode, b64encode
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from app.compiled import KERNELS
from app.formats.journal import from_json, to_json
from app.motion.estimate import Saved, Way
from app.settings import Settings

#: No way of half a minute has more corners; one that says so is not drawn.
MOST_POINTS = 100_000


def write_state(saved: Saved, key: bytes) -> bytes:
    """The inverse of ``read_state``."""
    told = {
        "kernels": KERNELS,
        "row": saved.row,
        "settings": asdict(saved.settings),
        "strides": saved.strides,
        "distance_m": saved.distance_m,
        "contact": saved.contact,
        "newest": saved.newest,
        "state": b64encode(saved.state).decode(),
    }
    return to_json(told | {"code": _code(told, key)})


def read_state(data: bytes, key: bytes) -> Saved | None:
    """What was saved; None if it is none, of other kernels, or not by who holds ``key``."""
    told = from_json(data)
    code = told.pop("code", None)
    if told.get("kernels") != KERNELS or not isinstance(code, str) or not code.isascii():
        return None
    if not hmac.compare_digest(code, _code(told, key)):
        return None
    try:
        contact = told["contact"]
        return Saved(
            Settings(**told["settings"]),
            told["row"],
            b64decode(told["state"]),
            tuple(told["newest"]),
            told["strides"],
            told["distance_m"],
            contact and (contact[0], tuple(contact[1]), contact[2]),
        )
    except (KeyError, TypeError, ValueError, IndexError):  # of another version, with the same kernels
        return None


def _code(told: dict[str, Any], key: bytes) -> str:
    """Only who holds the key can make it."""
    return hmac.new(key, json.dumps(told, sort_keys=True).encode(), "sha256").hexdigest()


def write_way(way: Way) -> bytes:
    """The way as lines of points, to the millimetre."""
    lines = [np.round(line, 3).tolist() for line in _lines(way)]
    return to_json({"first": way.first, "last": way.last, "lines_ned_m": lines})


def _lines(way: Way) -> list[Any]:
    """Segments that hang together, as points [k + 1, 3]."""
    segments = way.segments.astype(np.float64)
    if not len(segments):
        return []
    breaks = np.flatnonzero((segments[1:, 0] != segments[:-1, 1]).any(axis=1)) + 1
    return [np.concatenate([chain[:1, 0], chain[:, 1]]) for chain in np.split(segments, breaks)]


def read_way(data: bytes) -> Way | None:
    """The way in a message; None if it is none."""
    told = from_json(data)
    first, last, lines = told.get("first"), told.get("last"), told.get("lines_ned_m")
    if type(first) is not int or type(last) is not int or not isinstance(lines, list):
        return None
    try:
        points = [np.array(line, np.float64).reshape(-1, 3) for line in lines]
    except (TypeError, ValueError):
        return None
    if sum(map(len, points)) > MOST_POINTS or not all(np.abs(line).max(initial=0.0) < 1e9 for line in points):
        return None
    joined = [np.stack([line[:-1], line[1:]], axis=1) for line in points if len(line) > 1]
    segments = np.concatenate(joined) if joined else np.empty((0, 2, 3))
    return Way(first, last, segments.astype(np.float32)) if 0 <= first <= last else None


def joined(ways: Sequence[Way]) -> Way | None:
    """The newest way that reaches back to the start, of messages in the file's order."""
    chain: list[Way] = []
    for way in ways:
        if way.first == 0:
            chain = [way]
        elif chain and way.first == chain[-1].last:
            chain.append(way)
    if not chain:
        return None
    return Way(0, chain[-1].last, np.concatenate([way.segments for way in chain]))
