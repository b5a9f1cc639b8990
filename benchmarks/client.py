"""Benchmarks: a browser's websocket without the browser: viser 1.1.1's handshake, frames and messages."""

from __future__ import annotations

import base64
import http.client
import json
import os
import socket
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import msgspec
import viser
import websockets.sync.client as ws
import zstandard

PROTOCOL = f"viser-v{viser.__version__}"
CAMERA = {
    "type": "ViewerCameraMessage", "wxyz": (1.0, 0.0, 0.0, 0.0), "position": (1.0, -1.0, 1.0), "fov": 0.7,
    "near": 0.1, "far": 100.0, "image_height": 480, "image_width": 640, "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
}  # fmt: skip


class Frame(NamedTuple):
    """One websocket message as it came: monotonic nanoseconds, bytes."""

    at_ns: int
    data: bytes


def messages(data: bytes) -> list[dict[str, Any]]:
    """What a frame holds: viser's own layout (sizes, zstd of MessagePack, then the arrays)."""
    full, packed = (int.from_bytes(data[i : i + 8], "little") for i in (0, 8))
    inner = zstandard.ZstdDecompressor().decompress(data[16 : 16 + packed], max_output_size=full)
    return list(msgspec.msgpack.decode(inner)["messages"])


class Client:
    """A client that reads; it has told its camera, so the server hears its controls."""

    def __init__(self, port: int) -> None:
        self._socket = ws.connect(
            f"ws://127.0.0.1:{port}/", origin=f"http://127.0.0.1:{port}", subprotocols=[PROTOCOL],  # type: ignore[list-item, arg-type]
            compression=None, max_size=None, open_timeout=20.0,
        )  # fmt: skip
        self._socket.send(msgspec.msgpack.encode(CAMERA))

    def frame(self, timeout_s: float) -> Frame | None:
        """The next frame, or None after ``timeout_s``."""
        try:
            data = self._socket.recv(timeout_s)
        except TimeoutError:
            return None
        assert isinstance(data, bytes)
        return Frame(time.monotonic_ns(), data)

    def frames(self, seconds: float) -> Iterator[Frame]:
        """Everything that comes within ``seconds``."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            if (frame := self.frame(left)) is not None:
                yield frame

    def until(self, wanted: Callable[[dict[str, Any]], bool], seconds: float) -> tuple[int, dict[str, Any]]:
        """When the first wanted message came, and the message."""
        for frame in self.frames(seconds):
            for message in messages(frame.data):
                if wanted(message):
                    return frame.at_ns, message
        raise TimeoutError(f"it did not come within {seconds:.0f} s")

    def write(self, control: str, value: object) -> int:
        """Move a control as a browser does; returns when, in monotonic nanoseconds."""
        update = {"type": "GuiUpdateMessage", "uuid": control, "updates": {"value": value}}
        data = msgspec.msgpack.encode(update)
        at_ns = time.monotonic_ns()
        self._socket.send(data)
        return at_ns

    def close(self) -> None:
        """Leave."""
        self._socket.close()


def controls(replayed: list[dict[str, Any]]) -> dict[str, str]:
    """Label → uuid of every control among the messages a new client is sent; small buttons by their words."""
    found = {}
    for message in replayed:
        if str(message["type"]).startswith("Gui") and "props" in message:
            names = [message["props"].get("label")]
            if message["type"] == "GuiButtonGroupMessage":
                names += message["props"]["options"]
            found.update({str(name): str(message["uuid"]) for name in names if name})
    return found


def backlog(client: Client, seconds: float = 2.0) -> list[dict[str, Any]]:
    """All messages of the first seconds: what was there before, and what came meanwhile."""
    return [message for frame in client.frames(seconds) for message in messages(frame.data)]


def deaf(port: int) -> socket.socket:
    """A browser that joins and never reads."""
    key = base64.b64encode(os.urandom(16)).decode()
    lines = (
        "GET / HTTP/1.1", f"Host: 127.0.0.1:{port}", f"Origin: http://127.0.0.1:{port}", "Upgrade: websocket",
        "Connection: Upgrade", "Sec-WebSocket-Version: 13", f"Sec-WebSocket-Key: {key}",
        f"Sec-WebSocket-Protocol: {PROTOCOL}", "", "",
    )  # fmt: skip
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 64 * 1024)
    connection.connect(("127.0.0.1", port))
    connection.sendall("\r\n".join(lines).encode())
    return connection


def get(port: int, path: str) -> tuple[int, bytes]:
    """Status and body."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    try:
        connection.request("GET", path)
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


def health(port: int) -> dict[str, Any]:
    """What ``/healthz`` tells."""
    return dict(json.loads(get(port, "/healthz")[1]))
