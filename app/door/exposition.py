"""Door: numbers as Prometheus reads them (text format 0.0.4). Pure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from app.door.counters import Counters
from app.motion.door import Measure

CONTENT_TYPE = "text/plain; version=0.0.4"
_WORDS = {
    "connections": "Browsers connected now",
    "connections_total": "Browsers that connected",
    "refused": "Requests refused",
    "closed": "Connections ended for what the browser did",
    "messages_in": "Messages of browsers handed on",
    "messages_out": "Messages sent to browsers",
    "bytes_out": "Bytes sent to browsers",
    "paced": "Times that a browser that talked too fast had to wait",
    "dropped": "Messages of browsers that were not let through",
}


def exposition(measures: Iterable[Measure]) -> str:
    """The page for a scraper: one block for each name, in the order in which the names come first."""
    blocks: dict[str, list[Measure]] = {}
    for measure in measures:
        blocks.setdefault(measure.name, []).append(measure)
    return "".join(f"{line}\n" for name, block in blocks.items() for line in _block(name, block))


def _block(name: str, block: list[Measure]) -> Iterator[str]:
    yield f"# HELP {name} {_escaped(block[0].what)}"
    yield f"# TYPE {name} {'counter' if name.endswith('_total') else 'gauge'}"
    for measure in block:
        labels = ",".join(f'{key}="{_quoted(value)}"' for key, value in measure.labels)
        yield f"{name}{f'{{{labels}}}' if labels else ''} {_number(measure.value)}"


def of_counters(counters: Counters) -> Iterator[Measure]:
    """What the door counted."""
    yield _door("connections", counters.connections)
    yield _door("connections_total", counters.connections_total)
    for name, value in vars(counters).items():
        kind, _, why = name.partition("_")
        if kind in ("refused", "closed"):
            yield _door(f"{kind}_total", value, why)
    for name in ("messages_in", "messages_out", "bytes_out", "paced"):
        yield _door(f"{name}_total", getattr(counters, name))
    for kind, count in dict(counters.dropped_messages).items():
        yield _door("dropped_total", count, kind)


def _door(name: str, value: int, why: str = "") -> Measure:
    what = _WORDS.get(name) or _WORDS[name.removesuffix("_total")]
    return Measure(f"stridescope_door_{name}", what, float(value), (("why", why),) if why else ())


def _number(value: float) -> str:
    if math.isnan(value):
        return "NaN"
    if math.isinf(value):
        return "+Inf" if value > 0 else "-Inf"
    return repr(int(value)) if value == int(value) and abs(value) < 2**53 else repr(value)


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("\n", "\\n")


def _quoted(text: str) -> str:
    return _escaped(text).replace('"', '\\"')
