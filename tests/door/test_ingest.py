"""The ways in for samples, over real sockets: who may send, what is answered, what is too much."""

from __future__ import annotations

import http.client
import threading
from collections.abc import Callable, Mapping
from typing import Any

import pytest
import websockets.sync.client as ws
from websockets.exceptions import ConnectionClosed, InvalidStatus

from app.door.access import Access
from app.door.ingest import MOST_MESSAGE_BYTES, MOST_PUSH_BYTES, phone_address, sender_token


class Taken:
    """A taker that keeps what it got."""

    def __init__(self) -> None:
        self.messages: list[bytes | str] = []
        self.pushes: list[tuple[bytes, Mapping[str, str]]] = []
        self.thread: set[int] = set()

    def take(self, data: bytes | str) -> str:
        self.messages.append(data)
        self.thread.add(threading.get_ident())
        return f"{len(data)} taken"

    def push(self, data: bytes, query: Mapping[str, str]) -> tuple[int, str]:
        self.pushes.append((data, query))
        self.thread.add(threading.get_ident())
        return 200, "ok"


@pytest.fixture
def taken() -> Taken:
    return Taken()


def feed(house: Any, query: str = "", **more: Any) -> ws.ClientConnection:
    return ws.connect(f"ws://127.0.0.1:{house.port}/feed{query}", open_timeout=60, **more)


def post(house: Any, body: bytes, path: str = "/push", **headers: str) -> tuple[int, str]:
    connection = http.client.HTTPConnection("127.0.0.1", house.port, timeout=60)
    connection.request("POST", path, body, {name.replace("_", "-"): value for name, value in headers.items()})
    answer = connection.getresponse()
    text = answer.read().decode().strip()
    connection.close()
    return answer.status, text


def test_messages_are_answered_one_by_one(open_house: Callable[..., Any], taken: Taken) -> None:
    house = open_house(taker=taken)
    with feed(house) as sender, feed(house, origin=house.origin) as page:
        for each in (sender, page):
            each.send("text")
            assert each.recv() == "4 taken"
            each.send(b"bytes")
            assert each.recv() == "5 taken"
    assert taken.messages == ["text", b"bytes"] * 2


def test_a_message_that_is_too_long_ends_the_connection(open_house: Callable[..., Any], taken: Taken) -> None:
    house = open_house(taker=taken)
    with feed(house) as sender:
        sender.send(b"x" * (MOST_MESSAGE_BYTES + 1))
        with pytest.raises(ConnectionClosed):
            sender.recv(timeout=60)
    assert taken.messages == []


def test_pushes_are_taken_and_told_their_query(open_house: Callable[..., Any], taken: Taken) -> None:
    house = open_house(taker=taken, operator="secret")
    assert post(house, b"body", "/push?foot=left&token=secret") == (200, "ok")
    assert taken.pushes == [(b"body", {"foot": "left"})]
    head = f"POST /push?token=secret HTTP/1.1\r\nHost: 127.0.0.1:{house.port}\r\n"
    announced = house.say(f"{head}Content-Length: {MOST_PUSH_BYTES + 1}\r\n\r\n".encode())
    assert announced.recv(100).startswith(b"HTTP/1.1 413")
    assert len(taken.pushes) == 1
    assert len(taken.thread) == 1, "the taker is called on one thread only"


def test_another_sites_page_cannot_send(open_house: Callable[..., Any], taken: Taken) -> None:
    house = open_house(taker=taken)
    assert post(house, b"body", Origin="http://evil.example")[0] == 403
    assert post(house, b"body", Host="evil.example")[0] == 403
    with pytest.raises(InvalidStatus, match="403"):
        feed(house, origin="http://evil.example")
    assert not taken.messages
    assert not taken.pushes


def test_the_senders_token_lets_send_and_nothing_else(open_house: Callable[..., Any], taken: Taken) -> None:
    house = open_house(taker=taken, operator="secret")
    token = sender_token(house.door.access)
    assert token
    assert post(house, b"a", f"/push?token={token}")[0] == 200
    assert post(house, b"b", Authorization=f"Bearer {token}")[0] == 200
    assert post(house, b"c", Authorization="Bearer secret")[0] == 200
    assert house.get(f"/phone?token={token}")[0] == 200
    with feed(house, f"?token={token}") as sender:
        sender.send("x")
        assert sender.recv() == "1 taken"
    assert house.get(f"/?token={token}")[0] == 401
    assert house.get("/phone-code.svg", Authorization=f"Bearer {token}")[0] == 401
    for wrong in ("", "?token=", "?token=wrong", f"?token={token}x"):
        assert post(house, b"d", f"/push{wrong}")[0] == 401
        assert house.get(f"/phone{wrong}")[0] == 401
        with pytest.raises(InvalidStatus, match="401"):
            feed(house, wrong)
    assert [body for body, _ in taken.pushes] == [b"a", b"b", b"c"]


def test_who_only_watches_may_not_send_and_sees_no_code(open_house: Callable[..., Any], taken: Taken) -> None:
    house = open_house(taker=taken, operator="secret", viewer="watch")
    assert post(house, b"a", "/push?token=watch")[0] == 401
    status, headers, _ = house.get("/?token=watch")
    assert status == 303
    cookie = headers["set-cookie"].partition(";")[0]
    status, _, svg = house.get("/phone-code.svg", Cookie=cookie)
    assert status == 200
    assert "operates" in svg


def test_the_code_says_why_there_is_none(open_house: Callable[..., Any], taken: Taken) -> None:
    assert "this machine only" in open_house(taker=taken).get("/phone-code.svg")[2]
    open_to_all = open_house(taker=taken, host="0.0.0.0", operator="secret")
    cookie = open_to_all.get("/?token=secret")[1]["set-cookie"].partition(";")[0]
    assert "https" in open_to_all.get("/phone-code.svg", Cookie=cookie)[2]


def test_the_phones_page_runs_only_its_own_script(open_house: Callable[..., Any], taken: Taken) -> None:
    status, headers, html = open_house(taker=taken).get("/phone")
    assert status == 200
    nonce = html.partition('nonce="')[2].partition('"')[0]
    assert len(nonce) == 32
    assert f"script-src 'nonce-{nonce}'" in headers["content-security-policy"]
    assert "unsafe" not in headers["content-security-policy"]
    assert html.count("<script") == html.count(f'<script nonce="{nonce}"') == 1


def test_a_walk_that_takes_no_phone_says_how_to_have_one(house: Any) -> None:
    assert "--source phone:" in house.get("/phone")[2]
    assert post(house, b"a") == (404, house.get("/phone")[2].strip())
    with pytest.raises(InvalidStatus, match="404"):
        feed(house)


def test_the_feed_is_a_websocket_and_says_so(open_house: Callable[..., Any], taken: Taken) -> None:
    assert open_house(taker=taken).get("/feed")[0] == 426


def test_ever_more_senders_are_refused(
    open_house: Callable[..., Any], taken: Taken, monkeypatch: Any
) -> None:
    monkeypatch.setattr("app.door.ingest.MOST_SENDERS", 2)
    house = open_house(taker=taken)
    with feed(house), feed(house), pytest.raises(InvalidStatus, match="503"):
        feed(house)


def test_the_address_for_phones_holds_the_senders_token_only() -> None:
    access = Access(host="192.0.2.7", operator="secret")
    address = phone_address(access)
    assert address.startswith("http://192.0.2.7:8080/phone?token=")
    assert "secret" not in address
    assert sender_token(Access()) is None
    assert sender_token(access) != sender_token(Access(operator="other"))
