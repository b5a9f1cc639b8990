"""The gate: Host, Origin and token, as a table of friends and foes."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.door.gate import Gate, is_ip, is_loopback, split_host

HOME = Gate("127.0.0.1", 8080)
HOME_6 = Gate("::1", 8080)
OPEN = Gate("0.0.0.0", 8080, "secret", frozenset({"labpc", "labpc.local"}))

FRIENDS = [
    "127.0.0.1:8080", "localhost:8080", "LOCALHOST:8080", "LocalHost:8080", "[::1]:8080", "127.0.0.9:8080",
]  # fmt: skip
FOES = [
    "", " ", "evil.com", "evil.com:8080", "127.0.0.1.evil:8080", "127.0.0.1.evil", "localhost.evil.com:8080",
    "evil.localhost:8080", "localhost", "127.0.0.1", "127.0.0.1:8081", "127.0.0.1:", "127.0.0.1:80800",
    "::1:8080", "[::1]", "[::1", "0.0.0.0:8080", "[::]:8080", "192.168.1.5:8080", "127.1:8080",
    "2130706433:8080", "0x7f000001:8080", "0177.0.0.1:8080", "user@127.0.0.1:8080",
    "127.0.0.1:8080@evil.com", "127.0.0.1:8080 evil", "127.0.0.1:8080/", "127.0.0.1:+8080",
    "127.0.0.1:8080\n", "null", "[::1]:8080.evil", "localhost:8080:8080", "127.0.0.1:8080,evil.com",
    "localhоst:8080",  # a Cyrillic о
]  # fmt: skip


@pytest.mark.parametrize("gate", [HOME, HOME_6])
@pytest.mark.parametrize("host", FRIENDS)
def test_our_own_address_comes_in(gate: Gate, host: str) -> None:
    assert gate.check_site([host], [], websocket=False) is None
    assert gate.check_site([host], [f"http://{host}"], websocket=True) is None


@pytest.mark.parametrize("gate", [HOME, HOME_6])
@pytest.mark.parametrize("host", FOES)
def test_a_foreign_or_malformed_host_stays_outside(gate: Gate, host: str) -> None:
    refusal = gate.check_site([host], [f"http://{host}"], websocket=True)
    assert refusal is not None
    assert (refusal.status, refusal.what) == (403, "host")
    assert refusal.line.isprintable()
    assert refusal.line.isascii()


@pytest.mark.parametrize("hosts", [[], ["127.0.0.1:8080", "127.0.0.1:8080"], ["127.0.0.1:8080", "evil.com"]])
def test_exactly_one_host(hosts: list[str]) -> None:
    assert HOME.check_site(hosts, [], websocket=False) is not None


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.com", "https://evil.com", "null", "", "http://127.0.0.1.evil:8080", "http://127.0.0.1:8081",
        "http://127.0.0.1", "http://localhost:8080", "http://[::1]:8080", "file://", "127.0.0.1:8080",
        "ftp://127.0.0.1:8080", "http://127.0.0.1:8080/path", "http://127.0.0.1:8080@evil.com",
        "http://evil.com@127.0.0.1:8080", "http://127.0.0.1:8080 http://evil.com", "chrome-extension://abc",
    ],
)  # fmt: skip
@pytest.mark.parametrize("websocket", [True, False])
def test_another_origin_stays_outside(origin: str, websocket: bool) -> None:
    refusal = HOME.check_site(["127.0.0.1:8080"], [origin], websocket)
    assert refusal is not None
    assert (refusal.status, refusal.what) == (403, "origin")


def test_a_websocket_says_its_origin_and_a_page_need_not() -> None:
    assert HOME.check_site(["127.0.0.1:8080"], [], websocket=True) is not None
    assert HOME.check_site(["127.0.0.1:8080"], [], websocket=False) is None
    own = "http://127.0.0.1:8080"
    assert HOME.check_site(["127.0.0.1:8080"], [own, own], websocket=True) is not None


def test_mixed_case_is_the_same_origin() -> None:
    assert HOME.check_site(["LocalHost:8080"], ["HTTP://LOCALHOST:8080"], websocket=True) is None


def test_a_default_port_may_be_left_out() -> None:
    at_80 = Gate("127.0.0.1", 80)
    assert at_80.check_site(["localhost"], ["http://localhost:80"], websocket=True) is None
    assert at_80.check_site(["localhost:80"], ["http://localhost"], websocket=True) is None
    assert at_80.check_site(["localhost"], ["http://localhost:8080"], websocket=True) is not None
    assert OPEN.check_site(["labpc"], ["https://labpc:443"], websocket=True) is None


@pytest.mark.parametrize(
    "host", ["192.168.1.5:9000", "[fe80::1]:8080", "labpc:8080", "LABPC.local", "localhost"]
)
def test_on_a_network_any_address_and_our_names_are_ours(host: str) -> None:
    assert OPEN.check_site([host], [f"http://{host}"], websocket=True) is None


@pytest.mark.parametrize("host", ["evil.com", "192.168.1.5.evil.com:8080", "labpc.evil:8080", "labpc.", ""])
def test_on_a_network_foreign_names_stay_outside(host: str) -> None:
    assert OPEN.check_site([host], [f"http://{host}"], websocket=True) is not None


@pytest.mark.parametrize("wrong", ["", "Secret", "secret ", "secre", "secrets", "sécret", "\udcff", "\0"])
def test_only_the_token_opens(wrong: str) -> None:
    for refusal in (OPEN.check_token(wrong), OPEN.check_cookie(wrong)):
        assert refusal is not None
        assert (refusal.status, refusal.what) == (401, "token")
        assert "secret" not in refusal.line
    assert OPEN.check_token("secret") is None


def test_the_cookie_follows_from_the_token_and_does_not_tell_it() -> None:
    assert OPEN.check_cookie(OPEN.cookie_value) is None
    assert OPEN.check_cookie("secret") is not None
    assert OPEN.check_token(OPEN.cookie_value) is not None
    assert OPEN.check_cookie(None) is not None
    assert Gate("0.0.0.0", 8080, "another").cookie_value != OPEN.cookie_value
    assert OPEN.cookie_value.isalnum()


def test_without_a_token_the_door_is_open() -> None:
    assert HOME.check_cookie(None) is None


@pytest.mark.parametrize(
    ("name", "expected"),
    [("localhost", True), ("127.0.0.1", True), ("127.9.9.9", True), ("::1", True), ("::ffff:127.0.0.1", True),
     ("0.0.0.0", False), ("::", False), ("10.0.0.1", False), ("localhost.com", False), ("", False)],
)  # fmt: skip
def test_loopback_is_known_by_name(name: str, expected: bool) -> None:
    assert is_loopback(name) is expected


@given(st.ip_addresses(), st.integers(0, 65535))
def test_every_address_with_a_port_can_be_taken_apart(ip: object, port: int) -> None:
    name = str(ip)
    split = split_host(f"[{name}]:{port}" if ":" in name else f"{name}:{port}")
    assert split == (name, port)
    assert is_ip(name)


@given(st.text(max_size=30))
def test_no_header_breaks_it(header: str) -> None:
    refusal = HOME.check_site([header], [header], websocket=True)
    assert refusal is not None
    assert refusal.line.isprintable()
