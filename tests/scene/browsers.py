"""A browser's half of viser's websocket, without a browser: what the page would send."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import msgspec
from websockets.sync.client import connect
from websockets.typing import Subprotocol

CAMERA = {
    "type": "ViewerCameraMessage", "wxyz": (1.0, 0.0, 0.0, 0.0), "position": (1.0, 1.0, 1.0), "fov": 0.7,
    "near": 0.01, "far": 100.0, "image_height": 100, "image_width": 100, "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
}  # fmt: skip


class Client:
    def __init__(self, socket: Any) -> None:
        self._socket = socket

    def send(self, message: dict[str, Any]) -> None:
        self._socket.send(msgspec.msgpack.encode(message))

    def write(self, control: str, value: object) -> None:
        self.send({"type": "GuiUpdateMessage", "uuid": control, "updates": {"value": value}})


@contextmanager
def client(port: int) -> Iterator[Client]:
    """One that viser takes for a page: it has said where its camera is."""
    spoken = [Subprotocol("viser-v1.1.1")]
    address = f"ws://127.0.0.1:{port}"
    with connect(address, subprotocols=spoken, max_size=None, open_timeout=60) as socket:
        made = Client(socket)
        made.send(CAMERA)
        yield made


def until(said: Callable[[], object], seconds: float = 90.0) -> None:
    """Wait for what another thread does."""
    end = time.monotonic() + seconds
    while not said():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.01)
