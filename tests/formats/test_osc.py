"""OSC messages read by a kept library."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pythonosc.osc_message import OscMessage

from app.formats.osc import FORWARD, RIGHT, TURN, axes, message

floats = st.floats(width=32, allow_nan=False, allow_infinity=False)


@given(st.text("abcXYZ019_/", min_size=1, max_size=30), st.lists(floats, max_size=6))
def test_another_reader_finds_what_was_said(name: str, values: list[float]) -> None:
    read = OscMessage(message("/" + name, *values))
    assert read.address == "/" + name
    assert list(read.params) == values
    assert len(message("/" + name, *values)) % 4 == 0


@pytest.mark.parametrize("address", ["", "input", "/a b", "/\u00e4", "/a\n"])
def test_what_is_no_address_is_refused(address: str) -> None:
    with pytest.raises(ValueError, match="OSC address"):
        message(address, 0.0)


def test_a_value_that_is_no_number_is_refused() -> None:
    with pytest.raises(ValueError, match="finite"):
        message("/a", math.nan)


@given(*[st.floats(allow_nan=True, allow_infinity=True)] * 3)
def test_axes_are_always_within_one(ahead: float, right: float, turn: float) -> None:
    made = axes(ahead, right, turn)
    assert set(made) == {FORWARD, RIGHT, TURN}
    assert all(-1.0 <= value <= 1.0 for value in made.values())
