"""Numbers for Prometheus: each name once, each value as it is, whatever a sensor is called."""

from __future__ import annotations

import math
import re
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from app.door.counters import Counters
from app.door.exposition import exposition, of_counters
from app.motion.door import Measure

LINE = re.compile(r'([a-z_]+)(?:\{((?:[a-z_]+="(?:[^"\\\n]|\\.)*",?)+)\})? (\S+)')
LABEL = re.compile(r'([a-z_]+)="((?:[^"\\]|\\.)*)"')


def read(text: str) -> dict[tuple[str, tuple[tuple[str, str], ...]], float]:
    """What a scraper would make of it: text format 0.0.4."""
    found = {}
    for line in text.split("\n")[:-1]:
        if line.startswith("# "):
            continue
        match = LINE.fullmatch(line)
        assert match, line
        labels = tuple((key, unescaped(value)) for key, value in LABEL.findall(match[2] or ""))
        found[match[1], labels] = float(match[3])
    return found


def unescaped(value: str) -> str:
    return re.sub(r"\\(.)", lambda m: "\n" if m[1] == "n" else m[1], value)


@given(st.dictionaries(st.text(max_size=12), st.floats(allow_nan=False), max_size=5))
def test_every_value_and_every_label_comes_back(values: dict[str, float]) -> None:
    sent = [
        Measure("x_total", "Things\nof \\ note", value, (("sensor", name),)) for name, value in values.items()
    ]
    read_back = read(exposition(sent))
    assert read_back == {("x_total", (("sensor", name),)): value for name, value in values.items()}


def test_a_name_is_explained_once_and_its_lines_stand_together() -> None:
    a, b, c = (
        Measure("a_total", "A", 1.0, (("k", "1"),)),
        Measure("b", "B", math.nan),
        Measure("a_total", "A", 2.5),
    )
    assert exposition([a, b, c]).splitlines() == [
        "# HELP a_total A", "# TYPE a_total counter", 'a_total{k="1"} 1', "a_total 2.5",
        "# HELP b B", "# TYPE b gauge", "b NaN",
    ]  # fmt: skip


def test_everything_that_the_door_counts_is_told() -> None:
    counters = Counters()
    numbers = {name: i + 1 for i, name in enumerate(vars(counters)) if name != "dropped_messages"}
    for name, value in numbers.items():
        setattr(counters, name, value)
    counters.dropped_messages["ShareUrlRequest"] = 99
    told: Any = read(exposition(of_counters(counters)))
    assert sorted(told.values()) == sorted([*numbers.values(), 99])
