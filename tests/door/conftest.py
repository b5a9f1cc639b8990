"""A real small viser with a door in front, and clients that say what a browser could not."""

from __future__ import annotations

import base64
import http.client
import os
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, fields
from typing import Any
from urllib.parse import quote

import msgspec
import pytest
import viser
import websockets.sync.client as ws

from app.door.access import Access
from app.door.front import Door
from app.motion.door import GuiRule

ACCESS = {field.name for field in fields(Access)}
VERSION = f"viser-v{viser.__version__}"


@dataclass
class House:
    """A viser server with a few controls behind a door."""

    viser: viser.ViserServer
    door: Door
    slider: Any
    name: Any
    rules: dict[str, GuiRule]
    sockets: list[socket.socket] = field(default_factory=list)

    @property
    def port(self) -> int:
        return int(self.door.address.split("/")[2].rpartition(":")[2])

    @property
    def origin(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def connect(self, **more: object) -> ws.ClientConnection:
        """A websocket like the page's; it takes messages of any size."""
        options: dict[str, object] = {
            "origin": self.origin,
            "subprotocols": [VERSION],
            "open_timeout": 60,
            **more,
        }
        return ws.connect(f"ws://127.0.0.1:{self.port}/", compression=None, max_size=None, **options)  # type: ignore[arg-type]

    def get(
        self, path: str = "/", method: str = "GET", host: str | None = None, **headers: str
    ) -> tuple[int, dict[str, str], str]:
        """Status, headers (names in lower case) and body of one plain request."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        connection.putheader("Host", host if host is not None else f"127.0.0.1:{self.port}")
        for name, value in headers.items():
            connection.putheader(name.replace("_", "-"), value)
        connection.endheaders()
        answer = connection.getresponse()
        body = answer.read().decode()
        connection.close()
        return answer.status, {name.lower(): value for name, value in answer.getheaders()}, body

    def answers(self) -> bool:
        """Whether it has room for one more that asks."""
        try:
            return self.get("/healthz")[0] == 200
        except OSError:
            return False

    def cookie(self, token: str) -> str:
        """The cookie header of a browser that opened the address with this token."""
        return self.get(f"/?token={quote(token)}")[1]["set-cookie"].split(";")[0]

    def knock(self, path: str = "/", **headers: str) -> socket.socket:
        """A bare socket that has asked to become a websocket; it holds little. Headers may be replaced."""
        sent = {
            "Host": f"127.0.0.1:{self.port}", "Origin": self.origin, "Upgrade": "websocket",
            "Connection": "Upgrade", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Protocol": VERSION,
            "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(),
        }  # fmt: skip
        sent |= {name.replace("_", "-"): value for name, value in headers.items()}
        lines = "".join(f"{name}: {value}\r\n" for name, value in sent.items() if value)
        return self.say(f"GET {path} HTTP/1.1\r\n{lines}\r\n".encode())

    def say(self, data: bytes) -> socket.socket:
        """A bare socket that has sent ``data``."""
        connection = socket.socket()
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 64 * 1024)
        connection.settimeout(60)
        connection.connect(("127.0.0.1", self.port))
        connection.sendall(data)
        self.sockets.append(connection)
        return connection


def eventually(condition: Callable[[], bool], seconds: float = 90.0) -> None:
    """Wait until a condition holds; fail if it never does."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it never happened"
        time.sleep(0.01)


@pytest.fixture
def wait() -> Callable[[Callable[[], bool]], None]:
    return eventually


@contextmanager
def opened(**more: object) -> Iterator[House]:
    """A house until the block ends; arguments are those of the door and of its access."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    slider = server.gui.add_slider("gain", 0.0, 2.0, 0.01, 1.0)
    name = server.gui.add_text("name", "")
    rules = {slider._impl.uuid: GuiRule("number", 0.0, 2.0), name._impl.uuid: GuiRule("text")}
    access = Access(**{"port": 0} | {name: more.pop(name) for name in ACCESS & set(more)})  # type: ignore[arg-type]
    options: dict[str, object] = {"health": lambda: {"samples": 7}, **more}
    door = Door(access, viser_port=server.get_port(), rules=lambda: rules, **options)  # type: ignore[arg-type]
    house = House(server, door, slider, name, rules)
    door.start()
    try:
        yield house
    finally:
        door.stop()
        server.stop()
        for connection in house.sockets:
            connection.close()


@pytest.fixture
def open_house() -> Iterator[Callable[..., House]]:
    """Opens houses that close after the test."""
    with ExitStack() as closing:
        yield lambda **more: closing.enter_context(opened(**more))


@pytest.fixture
def house(open_house: Callable[..., House]) -> House:
    return open_house()


@pytest.fixture
def set_value() -> Callable[..., bytes]:
    """The frame a browser sends when a control is moved."""

    def frame(control: Any, value: object, **inner: object) -> bytes:
        updates = {"value": value, **inner}
        return msgspec.msgpack.encode(
            {"type": "GuiUpdateMessage", "uuid": control._impl.uuid, "updates": updates}
        )

    return frame
