"""The table of attacks: each is refused or bounded, before the upgrade where it can be; the walk goes on."""

from __future__ import annotations

import contextlib
import struct
import threading
import time
from collections.abc import Iterator
from typing import Any, NamedTuple
from urllib.parse import quote

import msgspec
import pytest
import websockets.exceptions

from app.door import listening, upstream
from app.door.access import Access, Visitor
from app.door.gate import Gate
from tests.door.conftest import House, eventually, opened
from tests.door.test_filter import CAMERA

OPERATOR, VIEWER = "the operator's long token", "the viewer's long token"
pack = msgspec.msgpack.encode


class Walk:
    """A frame that moves sixty times a second, and an operator's browser that sees it."""

    def __init__(self, house: House) -> None:
        self.house = house
        self.cookies = {token: house.cookie(token) for token in (OPERATOR, VIEWER)}
        self.browser = self.enter(OPERATOR)
        self.seen = 0
        self._over = threading.Event()
        self._threads = [threading.Thread(target=work) for work in (self._move, self._look)]
        for thread in self._threads:
            thread.start()

    def enter(self, token: str) -> Any:
        return self.house.connect(additional_headers={"Cookie": self.cookies[token]})

    def value(self, token: str) -> str:
        return self.cookies[token].partition("=")[2]

    def _move(self) -> None:
        frame = self.house.viser.scene.add_frame("/foot")
        while not self._over.wait(1 / 60):
            frame.position = (time.monotonic(), 0.0, 0.0)
            self.house.viser.flush()

    def _look(self) -> None:
        with contextlib.suppress(websockets.exceptions.ConnectionClosed):
            while True:
                self.browser.recv(timeout=60)
                self.seen += 1

    def end(self) -> None:
        self._over.set()
        self.browser.close()
        for thread in self._threads:
            thread.join()

    def goes_on(self) -> None:
        """More of it is seen, and the operator's slider is where the operator left it."""
        before = self.seen  # the next one may have been under way already
        eventually(lambda: self.seen > before + 1)
        assert self.house.slider.value == 1.0


@pytest.fixture(scope="module")
def walk() -> Iterator[Walk]:
    with opened(operator=OPERATOR, viewer=VIEWER) as house:
        walk = Walk(house)
        yield walk
        walk.end()


class Attack(NamedTuple):
    """A handshake that must not become a websocket: what differs from an honest one, and the answer."""

    name: str
    headers: dict[str, str]
    status: int


def at(host: str) -> dict[str, str]:
    """What a browser sends whose page has this host in its address."""
    return {"Host": host, "Origin": f"http://{host}"}


#: {port} is ours, {right} the operator's cookie, {replayed} that of another token.
ATTACKS = [
    Attack("evil Origin", {"Origin": "http://evil.example"}, 403),
    Attack("evil Origin over https", {"Origin": "https://evil.example"}, 403),
    Attack("Origin 127.0.0.1.evil", {"Origin": "http://127.0.0.1.evil:{port}"}, 403),
    Attack("Origin null", {"Origin": "null"}, 403),
    Attack("Origin missing", {"Origin": ""}, 403),
    Attack("Origin of another port", {"Origin": "http://127.0.0.1:1"}, 403),
    Attack("Origin by IPv6", {"Origin": "http://[::1]:{port}"}, 403),
    Attack("Origin in mixed case", {"Origin": "HTTP://Evil.EXAMPLE"}, 403),
    Attack("Origin of a file", {"Origin": "file://"}, 403),
    Attack("evil Host", at("evil.example"), 403),
    Attack("Host 127.0.0.1.evil", at("127.0.0.1.evil:{port}"), 403),
    Attack("a name rebound to us", at("evil.example:{port}"), 403),
    Attack("Host by foreign IPv6", at("[2001:db8::1]:{port}"), 403),
    Attack("Host in mixed case", at("EVIL.Example:{port}"), 403),
    Attack("Host missing", {"Host": ""}, 400),
    Attack("no token", {"Cookie": ""}, 401),
    Attack("wrong token", {"Cookie": "stridescope-{port}=" + 64 * "0"}, 401),
    Attack("the token itself as cookie", {"Cookie": "stridescope-{port}=" + quote(OPERATOR)}, 401),
    Attack("a cookie replayed from another run", {"Cookie": "stridescope-{port}={replayed}"}, 401),
    Attack("a cookie of another port", {"Cookie": "stridescope-1={right}"}, 401),
]  # fmt: skip


def status(answer: bytes) -> int:
    return int(answer.split(b" ", 2)[1])


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.name)
def test_before_the_upgrade(walk: Walk, attack: Attack) -> None:
    house, before = walk.house, walk.house.door.counters.connections_total
    replayed = Gate(Access(operator="last week's token")).cookie_value(Visitor.OPERATOR)
    right = walk.cookies[OPERATOR].partition("=")[2]
    sent = {
        name: value.format(port=house.port, replayed=replayed, right=right)
        for name, value in attack.headers.items()
    }
    answer = house.knock(**{"Cookie": walk.cookies[OPERATOR], **sent}).recv(4096)
    assert status(answer) == attack.status
    assert house.door.counters.connections_total == before
    assert len(house.viser._websock_server._live_connections) == 1
    walk.goes_on()


def test_a_wrong_token_in_the_address_gives_no_cookie(walk: Walk) -> None:
    for token in (
        "",
        "wrong",
        OPERATOR[:-1],
        OPERATOR + "x",
        OPERATOR.upper(),
        walk.cookies[OPERATOR].partition("=")[2],
    ):
        answer, headers, _ = walk.house.get("/?token=" + token.replace(" ", "%20"))
        assert (answer, "set-cookie" in headers) == (401, False)


def test_a_viewer_s_slider_and_a_share_url(walk: Walk, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    monkeypatch.setattr(walk.house.viser, "request_share_url", lambda *a, **k: asked.append("share"))
    dropped = walk.house.door.counters.dropped_messages
    before = sum(dropped.values())
    slider = walk.house.slider._impl.uuid
    move = {"type": "GuiUpdateMessage", "uuid": slider, "updates": {"value": 0.1}}
    with walk.enter(VIEWER) as viewer, walk.enter(OPERATOR) as operator:
        for message in (CAMERA, move, {"type": "ShareUrlRequest"}):
            viewer.send(pack(message))
        operator.send(pack({"type": "ShareUrlRequest"}))
        eventually(lambda: sum(dropped.values()) == before + 3)
    assert asked == []
    walk.goes_on()


def test_a_message_of_sixty_megabytes(walk: Walk) -> None:
    counters = walk.house.door.counters
    before = counters.closed_too_big
    connection = walk.house.knock(Cookie=walk.cookies[VIEWER])
    header = b"\x82\xff" + struct.pack(">Q", 60_000_000) + bytes(4)
    with pytest.raises(ConnectionError):  # it is shut long before all has been sent
        connection.sendall(header + bytes(60_000_000))
    assert counters.closed_too_big == before + 1
    walk.goes_on()


def test_a_thousand_connections(walk: Walk) -> None:
    counters = walk.house.door.counters
    full = counters.refused_full
    idle = [walk.house.say(b"") for _ in range(500)]
    eventually(lambda: counters.refused_full > full)
    walk.goes_on()
    for connection in idle:
        connection.close()
    eventually(walk.house.answers)
    knocking = [walk.house.knock(Cookie=walk.cookies[VIEWER]) for _ in range(500)]
    eventually(lambda: counters.connections == upstream.MAX_BROWSERS)
    walk.goes_on()
    assert len(walk.house.viser._websock_server._live_connections) <= upstream.MAX_BROWSERS
    assert counters.refused_full - full >= 1000 - listening.MAX_SOCKETS - upstream.MAX_BROWSERS
    for connection in knocking:
        connection.close()
    eventually(lambda: counters.connections == 1)
    walk.goes_on()
