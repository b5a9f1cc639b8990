"""Heart: orders, settings and markers as JSON, both ways: the part of a recording that people made."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, fields
from typing import Any, NamedTuple, get_args

from app.motion.basics import Vector
from app.motion.commands import KnowBias, Order, ReplaceCandidate, SessionCommand, SetCandidate
from app.settings import Settings

#: No gyro is so far off.
MOST_BIAS_RADPS = 1.0
_COMMANDS: dict[str, type[Any]] = {kind.__name__: kind for kind in get_args(SessionCommand)}


class Start(NamedTuple):
    """What the session held when a recording, or its source, began."""

    settings: Settings
    candidate: Settings
    apply_at_once: bool


def to_json(content: object) -> bytes:
    """Compact JSON; a float comes back to the bit. What is no letter is a question mark."""
    return json.dumps(content, ensure_ascii=False, separators=(",", ":")).encode(errors="replace")


def from_json(data: bytes) -> dict[str, Any]:
    """A JSON object; an empty one if it is none."""
    try:
        content = json.loads(data)
    except (ValueError, RecursionError):
        return {}
    return content if isinstance(content, dict) else {}


def all_from_json(items: Sequence[bytes]) -> list[dict[str, Any]]:
    """The same for many at once."""
    try:
        content = json.loads(b"[" + b",".join(items) + b"]")
    except (ValueError, RecursionError):
        content = []
    if len(content) == len(items) and all(isinstance(item, dict) for item in content):
        return list(content)
    return [from_json(item) for item in items]


def write_start(start: Start) -> bytes:
    """The inverse of ``read_start``."""
    return to_json({
        "settings": asdict(start.settings),
        "candidate": asdict(start.candidate),
        "apply_at_once": start.apply_at_once,
    })  # fmt: skip


def read_start(data: bytes) -> Start | None:
    """The start in a message; None if it is none, or of a version with other settings."""
    content = from_json(data)
    settings, candidate = _settings(content.get("settings")), _settings(content.get("candidate"))
    if settings is None or candidate is None:
        return None
    return Start(settings, candidate, content.get("apply_at_once") is True)


def write_order(number: int, order: Order) -> bytes:
    """The order and the number under which it was taken: the inverse of ``read_order``."""
    command = order.command
    head = {"number": number, "who": order.who, "host_ns": order.host_ns, "command": type(command).__name__}
    return to_json(head | asdict(command))


def read_order(data: bytes) -> tuple[int, Order] | None:
    """Number and order; None if it is none, or one that this version does not know."""
    content = from_json(data)
    number, who, host_ns = content.get("number"), content.get("who"), content.get("host_ns")
    kind = _COMMANDS.get(str(content.get("command")))
    if kind is None or type(number) is not int or not isinstance(who, str) or type(host_ns) is not int:
        return None
    values = {part.name: content.get(part.name) for part in fields(kind)}
    command = _command(kind, values)
    return None if command is None else (number, Order(command, who, host_ns))


def _command(kind: type[Any], values: dict[str, Any]) -> Any:
    if kind is SetCandidate:
        changes = _changes(values["changes"])
        return None if changes is None else SetCandidate(changes)
    if kind is ReplaceCandidate:
        settings, reason = _settings(values["settings"]), values["reason"]
        return ReplaceCandidate(settings, reason) if settings and isinstance(reason, str) else None
    if kind is KnowBias:
        return _bias(values)
    expected = {"bool": bool, "str": str}
    if any(type(values[part.name]) is not expected.get(str(part.type)) for part in fields(kind)):
        return None
    return kind(**values)


def _bias(values: dict[str, Any]) -> KnowBias | None:
    rate, doubt = _vector(values["rate_b"]), _vector(values["doubt_radps"])
    sensor, source = values["sensor"], values["source"]
    if rate is None or doubt is None or min(doubt) <= 0.0:
        return None
    if not isinstance(sensor, str) or not isinstance(source, str):
        return None
    return KnowBias(sensor, rate, doubt, source)


def _vector(value: object) -> Vector | None:
    """Three finite numbers, each a rate that a gyro's bias may be."""
    if not isinstance(value, list) or len(value) != 3:
        return None
    if any(type(part) not in (int, float) or not abs(part) < MOST_BIAS_RADPS for part in value):
        return None
    x, y, z = (float(part) for part in value)
    return (x, y, z)


def _changes(value: object) -> tuple[tuple[str, float | bool | str], ...] | None:
    if not isinstance(value, list):
        return None
    changes = []
    for pair in value:
        if not isinstance(pair, list) or len(pair) != 2 or not isinstance(pair[0], str):
            return None
        if not isinstance(pair[1], float | int | bool | str):
            return None
        changes.append((pair[0], pair[1]))
    return tuple(changes)


def _settings(value: object) -> Settings | None:
    if not isinstance(value, dict):
        return None
    try:
        return Settings(**value)
    except (TypeError, ValueError):
        return None
