"""Where a door listens and who may come in: a wrong wish is one line, before anything is opened."""

from __future__ import annotations

import re
from typing import Any
from urllib.parse import parse_qs, urlsplit

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.door.access import Access, is_loopback, made_token
from app.motion.basics import InputError


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "labpc", "", "evil.localhost"])
@pytest.mark.parametrize("token", [None, ""])
def test_a_host_that_others_can_reach_needs_a_token(host: str, token: str | None) -> None:
    with pytest.raises(InputError, match="token"):
        Access(host, operator=token)


@pytest.mark.parametrize(
    "wish",
    [
        {"port": -1},
        {"port": 65536},
        {"viewer": "look"},
        {"operator": "same", "viewer": "same"},
    ],
)
def test_what_cannot_be_is_one_line(wish: dict[str, Any]) -> None:
    with pytest.raises(InputError) as refused:
        Access(**wish)
    assert "\n" not in str(refused.value)


@given(st.text(min_size=1, max_size=40))
def test_the_address_carries_any_token(token: str) -> None:
    address = urlsplit(Access().address("fe80::1", 8080, token))
    assert address.netloc == "[fe80::1]:8080"
    assert parse_qs(address.query, errors="surrogatepass") == {"token": [token]}


def test_without_a_token_there_is_nothing_to_carry() -> None:
    assert Access().address("127.0.0.1", 8080, None) == "http://127.0.0.1:8080"


def test_a_made_token_is_long_and_never_twice_the_same() -> None:
    made = {made_token() for _ in range(100)}
    assert len(made) == 100
    assert all(re.fullmatch(r"[\w-]{22}", token) for token in made)


@pytest.mark.parametrize(
    ("name", "expected"),
    [("localhost", True), ("127.0.0.1", True), ("127.9.9.9", True), ("::1", True), ("::ffff:127.0.0.1", True),
     ("0.0.0.0", False), ("::", False), ("10.0.0.1", False), ("localhost.com", False), ("", False)],
)  # fmt: skip
def test_loopback_is_known_by_name(name: str, expected: bool) -> None:
    assert is_loopback(name) is expected
