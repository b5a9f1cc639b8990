"""The way to viser: page, files and websocket come through as viser gives them."""

from __future__ import annotations

import gzip
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import viser
import websockets.exceptions

VERSION = f"viser-v{viser.__version__}"


def test_the_page_is_viser_s_with_our_head_and_a_new_nonce_each_time(open_house: Callable[..., Any]) -> None:
    house = open_house(extra_head="<script>ours()</script>")
    pages = [house.get("/"), house.get("/index.html")]
    nonces = [headers["content-security-policy"].split("'nonce-")[1].split("'")[0] for _, headers, _ in pages]
    assert nonces[0] != nonces[1]
    for (status, headers, body), nonce in zip(pages, nonces, strict=True):
        assert status == 200
        assert f'<script nonce="{nonce}">ours()</script>' in body
        assert int(headers["content-length"]) == len(body.encode())
        assert "content-encoding" not in headers
        assert headers["content-type"] == "text/html; charset=utf-8"


def test_head_tells_the_same_without_a_body(house: Any) -> None:
    status, headers, body = house.get("/", "HEAD")
    assert (status, body) == (200, "")
    assert int(headers["content-length"]) > 100_000


@pytest.mark.parametrize("encoding", ["identity", "gzip"])
def test_files_come_byte_for_byte_and_compressed_as_asked(house: Any, encoding: str) -> None:
    # viser's build is one page; asked for with a stroke at its end, it comes as any file would
    file = Path(viser.__file__).parent / "client" / "build" / "index.html"
    request = urllib.request.Request(f"{house.origin}/index.html/", headers={"Accept-Encoding": encoding})
    with urllib.request.urlopen(request) as answer:
        body = answer.read()
    assert answer.headers["Content-Encoding"] == encoding
    assert int(answer.headers["Content-Length"]) == len(body)
    assert (gzip.decompress(body) if encoding == "gzip" else body) == file.read_bytes()


@pytest.mark.parametrize(
    "path",
    [
        "/nothing.js",
        "/../_viser.py",
        "/%2e%2e/_viser.py",
        "/..%2f..%2f_viser.py",
        "/..\\..\\x",
        "/%00",
        "/a//b",
    ],
)
def test_only_what_viser_serves(house: Any, path: str) -> None:
    status, _, body = house.get(path)
    assert (status, body.count("\n")) == (404, 1)


def test_while_viser_is_away_the_page_says_so_and_tries_again(house: Any) -> None:
    house.viser.stop()
    status, headers, body = house.get("/")
    assert (status, headers["refresh"], body.count("\n")) == (502, "2", 1)
    with pytest.raises(websockets.exceptions.InvalidStatus, match="502"):
        house.connect()
    assert house.get("/healthz")[0] == 200


def test_the_subprotocol_goes_both_ways(house: Any) -> None:
    with house.connect(subprotocols=["chat", VERSION]) as websocket:
        assert websocket.subprotocol == VERSION
        assert websocket.recv(timeout=60)


def test_an_old_page_hears_viser_s_own_refusal(house: Any) -> None:
    with (
        house.connect(subprotocols=["viser-v0.0.1"]) as websocket,
        pytest.raises(websockets.exceptions.ConnectionClosed) as closed,
    ):
        websocket.recv(timeout=60)
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.code == 1002
    assert "Version mismatch" in closed.value.rcvd.reason


@pytest.mark.parametrize("protocols", [None, ["chat"]])
def test_a_websocket_that_is_not_viser_s_is_refused(house: Any, protocols: list[str] | None) -> None:
    with pytest.raises(websockets.exceptions.InvalidStatus, match="400"):
        house.connect(subprotocols=protocols)


def test_a_handshake_that_is_none_is_refused(house: Any) -> None:
    assert b" 400 " in house.knock(Sec_WebSocket_Key="short").recv(4096)
    assert b" 400 " in house.knock(Sec_WebSocket_Version="1").recv(4096)


def test_viser_learns_who_came_and_by_which_address_but_no_token(open_house: Callable[..., Any]) -> None:
    house = open_house()
    with house.connect(additional_headers={"Cookie": "a=b"}) as websocket:
        websocket.recv(timeout=60)
        (connection,) = house.viser._websock_server._live_connections.values()
        assert connection.request.headers["X-Forwarded-For"] == "127.0.0.1"
        assert "Cookie" not in connection.request.headers
        assert connection.request.path == "/"
