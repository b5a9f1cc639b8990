"""Who is let in: Host, Origin, token and numbers, over real sockets."""

from __future__ import annotations

import asyncio
import json
import logging
import math
import socket
import time
from collections.abc import Callable
from typing import Any

import pytest
import websockets.exceptions

from app.door import listening, upstream
from app.motion.door import Measure

Open = Callable[..., Any]
EVIL_HOSTS = [
    "evil.com", "evil.com:{port}", "127.0.0.1.evil:{port}", "null", "", "0.0.0.0:{port}", "127.0.0.1:1",
]  # fmt: skip
EVIL_ORIGINS = [
    "http://evil.com", "null", "http://127.0.0.1.evil:{port}", "http://localhost:{port}", "http://127.0.0.1",
    "",
]  # fmt: skip


def first_line(connection: socket.socket) -> str:
    return connection.recv(4096).split(b"\r\n", 1)[0].decode()


@pytest.mark.parametrize("host", EVIL_HOSTS)
def test_a_rebound_or_foreign_host_gets_one_plain_line(house: Any, host: str) -> None:
    status, headers, body = house.get(host=host.format(port=house.port))
    assert (status, body.count("\n")) == (403, 1)
    assert headers["content-type"].startswith("text/plain")
    assert house.door.counters.refused_host == 1


@pytest.mark.parametrize("host", EVIL_HOSTS)
def test_an_evil_host_gets_no_websocket(house: Any, host: str) -> None:
    evil = host.format(port=house.port)
    assert " 403 " in first_line(house.knock(Host=evil or " ", Origin=f"http://{evil}"))
    assert house.door.counters.connections_total == 0


@pytest.mark.parametrize("origin", EVIL_ORIGINS)
def test_an_evil_or_missing_origin_gets_no_websocket(house: Any, origin: str) -> None:
    assert " 403 " in first_line(house.knock(Origin=origin.format(port=house.port)))
    assert (house.door.counters.refused_origin, house.door.counters.connections_total) == (1, 0)


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost", "LocalHost", "[::1]"])
def test_our_own_names_get_a_websocket(house: Any, name: str) -> None:
    host = f"{name}:{house.port}"
    assert " 101 " in first_line(house.knock(Host=host, Origin=f"http://{host}"))


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "TRACE"])
def test_only_reading_is_possible(house: Any, method: str) -> None:
    assert house.get("/", method)[0] == 405
    assert house.get("/healthz", method)[0] == 405


def test_every_answer_has_the_safe_headers(house: Any) -> None:
    for path, host in (("/", None), ("/healthz", None), ("/nothing.js", None), ("/", "evil.com")):
        headers = house.get(path, host=host)[1]
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["x-frame-options"] == "DENY"
        assert headers["referrer-policy"] == "no-referrer"
        assert headers["cache-control"] == "no-store"
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert "aiohttp" not in headers["server"]


def test_health_is_told_as_json(house: Any) -> None:
    status, headers, body = house.get("/healthz")
    assert (status, json.loads(body)) == (200, {"ok": True, "samples": 7})
    assert headers["content-type"].startswith("application/json")


def test_bad_health_is_no_broken_json(open_house: Open) -> None:
    house = open_house(health=lambda: {"ok": False, "rate_hz": math.nan, "source": object})
    status, _, body = house.get("/healthz")
    assert status == 503
    assert json.loads(body)["rate_hz"] is None


def test_a_failing_health_report_is_logged_and_the_door_stays(
    open_house: Open, caplog: pytest.LogCaptureFixture
) -> None:
    house = open_house(health=lambda: {"ok": 1 / 0})
    assert house.get("/healthz")[0] == 500
    assert "ZeroDivisionError" in caplog.text
    assert house.get("/")[0] == 200


def test_the_token_becomes_a_cookie_and_leaves_the_address(open_house: Open) -> None:
    house = open_house(operator="secret-token")
    status, headers, _ = house.get("/?fixedDpr=1&token=secret-token")
    assert (status, headers["location"]) == (303, "/?fixedDpr=1")
    assert house.get("/?token=secret-token")[1]["location"] == "/"
    cookie = headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    assert "secret-token" not in cookie
    assert house.get("/", Cookie=cookie.split(";")[0])[0] == 200
    with house.connect(additional_headers={"Cookie": cookie.split(";")[0]}) as websocket:
        assert websocket.recv(timeout=60)


@pytest.mark.parametrize(
    "query", ["", "?token=", "?token=wrong", "?token=secret-token2", "?Token=secret-token"]
)
def test_without_the_token_nothing_opens(open_house: Open, query: str) -> None:
    house = open_house(operator="secret-token")
    for path in ("/", "/index.html", "/nothing.js"):
        status, headers, body = house.get(path + query)
        assert (status, body.count("\n")) == (401, 1)
        assert "set-cookie" not in headers
    with pytest.raises(websockets.exceptions.InvalidStatus, match="401"):
        house.connect()
    assert house.door.counters.refused_token == 4


@pytest.mark.parametrize(
    "cookie", ["stridescope-{port}=wrong", "stridescope-{port}=secret-token", "other={value}"]
)
def test_a_wrong_cookie_opens_nothing(open_house: Open, cookie: str) -> None:
    house = open_house(operator="secret-token")
    value = house.get("/?token=secret-token")[1]["set-cookie"].split(";")[0].partition("=")[2]
    assert house.get("/", Cookie=cookie.format(port=house.port, value=value))[0] == 401
    with pytest.raises(websockets.exceptions.InvalidStatus, match="401"):
        house.connect(additional_headers={"Cookie": cookie.format(port=house.port, value=value)})


def test_a_token_in_another_path_gives_no_cookie(open_house: Open) -> None:
    house = open_house(operator="secret-token")
    for path in ("/index.html", "/healthz", "//evil.com", "/nothing.js"):
        assert "set-cookie" not in house.get(f"{path}?token=secret-token")[1]


def test_an_absolute_address_in_the_request_redirects_nowhere_else(open_house: Open) -> None:
    house = open_house(operator="secret-token")
    host = f"127.0.0.1:{house.port}"
    answer = house.say(f"GET http://evil.com/?token=secret-token HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
    assert "evil" not in answer.recv(4096).decode()


def test_health_needs_no_token_on_this_machine(open_house: Open) -> None:
    assert open_house(operator="secret-token").get("/healthz")[0] == 200


def test_metrics_are_told_as_prometheus_reads_them(open_house: Open) -> None:
    house = open_house(measures=lambda: [Measure("stridescope_samples_total", "Samples", 7.0)])
    status, headers, body = house.get("/metrics")
    assert (status, headers["content-type"]) == (200, "text/plain; version=0.0.4")
    assert "\nstridescope_samples_total 7\n" in body
    assert "\nstridescope_door_connections 0\n" in body


@pytest.mark.parametrize("path", ["/healthz", "/metrics"])
def test_numbers_are_for_this_machine_and_for_who_has_a_token(open_house: Open, path: str) -> None:
    house = open_house(host="0.0.0.0", operator="secret-token", viewer="look-only-token")
    assert house.get(path)[0] == 200
    by_proxy = f"192.168.1.5:{house.port}"
    assert house.get(path, host=by_proxy)[0] == 401
    for token in ("secret-token", "look-only-token"):
        assert house.get(path, host=by_proxy, Authorization=f"Bearer {token}")[0] == 200
    for wrong in ("Bearer secret", "secret", "Basic c2VjcmV0", "Bearer"):
        assert house.get(path, host=by_proxy, Authorization=wrong)[0] == 401


def test_who_comes_by_a_link_of_another_site_is_sent_round_once(open_house: Open) -> None:
    house = open_house(operator="secret-token")
    status, headers, _ = house.get("/", Sec_Fetch_Site="cross-site")
    assert (status, headers["refresh"]) == (401, "0; url=/")
    assert "refresh" not in house.get("/", Sec_Fetch_Site="same-origin")[1]
    assert "refresh" not in house.get("/nothing", Sec_Fetch_Site="cross-site")[1]


def test_no_log_line_holds_a_token(open_house: Open, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG)
    house = open_house(operator="secret-token")
    house.get("/?token=secret-token")
    house.get("/?token=secret-tokem")
    house.get("/?token=secret-token", host="evil.com")
    house.get("/nothing?token=secret-token")
    for broken in (b"GET /?token=secret-token XTTP", b"GE\x00T /?token=secret-token HTTP/1.1"):
        house.say(broken + b"\r\nHost: x\r\n\r\n").recv(4096)
    house.door.stop()
    assert "refused a request" in caplog.text
    assert "secret-toke" not in caplog.text


def test_browsers_are_counted_and_bounded(
    house: Any, wait: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(upstream, "MAX_BROWSERS", 2)
    with house.connect() as first, house.connect():
        with pytest.raises(websockets.exceptions.InvalidStatus, match="503"):
            house.connect()
        assert (house.door.counters.connections, house.door.counters.refused_full) == (2, 1)
        first.close()
        wait(lambda: house.door.counters.connections == 1)
        with house.connect() as again:
            assert again.recv(timeout=60)
    assert house.door.counters.connections_total == 3


def test_idle_sockets_are_bounded(
    house: Any, wait: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(listening, "MAX_SOCKETS", 20)
    held = [house.say(b"GET / HT") for _ in range(100)]
    wait(lambda: house.door.counters.refused_full == 80)
    for connection in held:
        connection.close()
    wait(house.answers)


def test_a_connection_that_comes_about_slowly_counts_once(
    house: Any, wait: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    made = asyncio.BaseEventLoop.connect_accepted_socket

    async def slowly(*args: Any, **options: Any) -> Any:
        done = await made(*args, **options)
        await asyncio.sleep(0.5)
        return done

    monkeypatch.setattr(asyncio.BaseEventLoop, "connect_accepted_socket", slowly)
    monkeypatch.setattr(listening, "MAX_SOCKETS", 20)
    for _ in range(30):
        house.say(b"GET / HT")
        time.sleep(0.005)
    wait(lambda: house.door.counters.refused_full >= 10)
    assert house.door.counters.refused_full == 10


def test_one_caller_from_outside_holds_few(
    house: Any, wait: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(listening, "is_loopback", lambda address: False)
    for _ in range(listening.MAX_SOCKETS_OF_ONE + 6):
        house.say(b"GET / HT")
    wait(lambda: house.door.counters.refused_full >= 6)
    assert house.door.counters.refused_full == 6
