"""Orders and settings as JSON and back."""

from __future__ import annotations

from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats import journal
from app.motion.commands import (
    ApplyCandidate,
    DropCandidate,
    KeepAs,
    KnowBias,
    LookBack,
    Order,
    ReplaceCandidate,
    ResetHeading,
    RestartHere,
    SessionCommand,
    SetApplyAtOnce,
    SetCandidate,
    SwapAB,
    Undo,
)
from app.settings import Settings

COMMANDS = [
    SetCandidate((("gain_swing", 0.1 + 0.2), ("magnetometer", True), ("estimator", "papers"))),
    ReplaceCandidate(Settings().with_changes({"gain_swing": 0.3}), "profile Ann"),
    ApplyCandidate(),
    DropCandidate(),
    Undo(),
    SetApplyAtOnce(True),
    KeepAs("B"),
    SwapAB(),
    ResetHeading(),
    RestartHere(),
    LookBack(),
    KnowBias("left", (0.1 + 0.2, -0.004, 0.0), (3e-4, 1e-3, 0.5), "2026-11-20"),
]


def test_no_command_of_a_session_is_forgotten() -> None:
    assert {type(command) for command in COMMANDS} == set(get_args(SessionCommand))


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: type(c).__name__)
def test_an_order_comes_back(command: SessionCommand) -> None:
    order = Order(command, "Ann <i>", 12345678901234567)
    assert journal.read_order(journal.write_order(7, order)) == (7, order)


def test_a_start_comes_back() -> None:
    start = journal.Start(Settings(), Settings().with_changes({"gain_stance": 0.2}), True)
    assert journal.read_start(journal.write_start(start)) == start


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)
KEYS = (
    *("number", "who", "host_ns", "changes", "settings", "reason", "on", "slot"),
    *("sensor", "rate_b", "doubt_radps", "source"),
)


@given(
    st.sampled_from([type(c).__name__ for c in COMMANDS]), st.dictionaries(st.sampled_from(KEYS), anything)
)
def test_any_json_is_an_order_or_none(name: str, content: dict[str, object]) -> None:
    data = journal.to_json({"number": 1, "who": "Ann", "host_ns": 2, **content, "command": name})
    found = journal.read_order(data)
    if found is not None:
        again = journal.read_order(journal.write_order(*found))
        assert repr(again) == repr(found)


def test_what_is_no_letter_is_kept_as_a_question_mark() -> None:
    """A file's name may hold any bytes, and JSON may name half a letter."""
    told = journal.from_json(b'{"source": "na\\udcffme.csv"}')
    assert journal.to_json(told) == b'{"source":"na?me.csv"}'


@given(st.binary(max_size=60))
def test_rubbish_is_no_order(data: bytes) -> None:
    assert journal.read_order(data) is None
    assert journal.read_start(data) is None
