"""How fast a browser may talk: never faster than the pace, and an honest one never waits."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.door.bridge import MAX_INBOUND_BYTES
from app.door.pace import BURST_S, BYTES_PER_S, MESSAGES_PER_S, Pace


@given(st.lists(st.tuples(st.floats(0.0, 0.5), st.integers(0, MAX_INBOUND_BYTES)), max_size=60))
def test_in_no_time_more_is_read_than_the_pace_allows(sent: list[tuple[float, int]]) -> None:
    pace, now_s, messages, size = Pace(), 100.0, 0, 0
    for rest_s, length in sent:
        now_s += rest_s
        messages, size = messages + 1, size + length
        now_s += pace.delay_s(length, now_s)
        spent_s = messages / MESSAGES_PER_S + size / BYTES_PER_S
        assert spent_s <= now_s - 100.0 + BURST_S + 1e-6


@pytest.mark.parametrize("rate", [50, 60, 120])
def test_a_person_s_browser_never_waits(rate: int) -> None:
    pace = Pace()
    assert not any(pace.delay_s(400, i / rate) for i in range(60 * rate))


def test_after_a_rest_a_burst_is_free_again() -> None:
    pace = Pace()
    flood = sum(pace.delay_s(100, 0.0) > 0.0 for _ in range(1000))
    assert flood > 500
    assert pace.delay_s(100, 60.0) == 0.0
