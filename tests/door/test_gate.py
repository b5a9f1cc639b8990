"""The gate: Host, Origin and token, as a table of friends and foes."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.door.access import Access, Certificate, Visitor, is_ip
from app.door.gate import Gate, Refusal, split_host

HOME = Gate(Access("127.0.0.1", 8080))
HOME_6 = Gate(Access("::1", 8080))
LAN = Access("0.0.0.0", 8080, "secret", "look")
OPEN = Gate(LAN, frozenset({"labpc", "labpc.local"}))
LOCKED = Gate(replace(LAN, certificate=Certificate(Path("cert.pem"), Path("key.pem"))))

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
    at_80 = Gate(Access("127.0.0.1", 80))
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
def test_only_a_token_opens(wrong: str) -> None:
    for refusal in (OPEN.check_token(wrong), OPEN.check_cookie(wrong)):
        assert isinstance(refusal, Refusal)
        assert (refusal.status, refusal.what) == (401, "token")
        assert "secret" not in refusal.line


def test_each_token_is_one_visitor_s() -> None:
    assert OPEN.check_token("secret") is Visitor.OPERATOR
    assert OPEN.check_token("look") is Visitor.VIEWER


@pytest.mark.parametrize("visitor", Visitor)
def test_the_cookie_follows_from_the_token_and_does_not_tell_it(visitor: Visitor) -> None:
    cookie = OPEN.cookie_value(visitor)
    assert OPEN.check_cookie(cookie) is visitor
    assert isinstance(OPEN.check_token(cookie), Refusal)
    assert cookie.isalnum()
    other = Gate(replace(LAN, operator="another", viewer="yet another"))
    assert isinstance(other.check_cookie(cookie), Refusal)


@pytest.mark.parametrize("cookie", [None, "", "secret", "look", hashlib.sha256(b"").hexdigest()])
def test_what_is_no_cookie_of_ours_stays_outside(cookie: str | None) -> None:
    assert isinstance(OPEN.check_cookie(cookie), Refusal)


@pytest.mark.parametrize("empty", ["", Gate(Access(operator="secret")).cookie_value(Visitor.VIEWER)])
def test_where_viewers_have_no_token_nobody_is_one(empty: str) -> None:
    gate = Gate(Access(operator="secret"))
    assert isinstance(gate.check_token(""), Refusal)
    assert isinstance(gate.check_cookie(empty), Refusal)


def test_with_tls_only_tls_is_the_same_origin() -> None:
    assert LOCKED.check_site(["labpc.local:8080"], [], websocket=False) is not None  # no name of ours
    assert LOCKED.check_site(["10.0.0.7:8080"], ["https://10.0.0.7:8080"], websocket=True) is None
    assert LOCKED.check_site(["10.0.0.7:8080"], ["http://10.0.0.7:8080"], websocket=True) is not None
    assert LOCKED.cookie_name == "__Host-stridescope-8080"


def test_without_a_token_the_door_is_open() -> None:
    assert HOME.check_cookie(None) is Visitor.OPERATOR


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
