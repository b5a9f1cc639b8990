"""Edge, scene: everything this project uses of viser that viser does not promise (1.1.1).

tests/scene/test_private.py is the contract: run it before any other version of viser is pinned.
"""

from __future__ import annotations

import asyncio
import contextlib
import io
import socket
from functools import partial
from typing import Any

import viser
from viser import _messages

from app.motion.basics import Quaternion, Vector

SOCKET_BYTES = 64 * 1024
Json = dict[str, Any]


def open_server(label: str) -> viser.ViserServer:
    """A viser on a free loopback port, silent, with no share tunnel."""
    with contextlib.redirect_stdout(io.StringIO()):  # it prints the port nobody is told
        server = viser.ViserServer(host="127.0.0.1", port=_free_port(), label=label, verbose=False)
    for message in (_messages.ShareUrlRequest, _messages.ShareUrlDisconnect):
        server._websock_server.unregister_handler(message)
    server._websock_server.on_client_connect(partial(_hold_little, server))
    buffer = server._websock_server._broadcast_buffer
    buffer.message_event = _OnItsLoop(buffer.event_loop)
    return server


class _OnItsLoop(asyncio.Event):
    """viser sets it from any thread and then again on its loop, where alone that is safe.

    The first is left out: it would, while a browser comes or goes, end in "deque mutated during iteration".
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__()
        self._its = loop

    def set(self) -> None:
        """Wake who waits, if this is the loop's own thread."""
        if asyncio._get_running_loop() is self._its:
            super().set()


def _hold_little(server: viser.ViserServer, client: Any) -> None:
    """Let the kernel keep little for a browser that is slow to read: viser replaces old news, it can't."""
    connection = server._websock_server._live_connections[client.client_id]
    kept = connection.transport.get_extra_info("socket")
    kept.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SOCKET_BYTES)


def close_server(server: viser.ViserServer) -> None:
    """Stop it, silently."""
    with contextlib.redirect_stdout(io.StringIO()):
        server.stop()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def force_pose(node: viser.SceneNodeHandle, wxyz: Quaternion, position: Vector) -> None:
    """Set a pose whatever it was: the public setter skips moves that ``np.allclose`` calls none.

    Its tolerance grows with the coordinate: 2 mm at 200 m from the start. What is the same is not sent again.
    """
    its = node._impl
    if its.wxyz.tolist() != [*wxyz]:
        its.wxyz[:] = wxyz
        its.api._queue_scene_message(_messages.SetOrientationMessage(its.name, wxyz))
    if its.position.tolist() != [*position]:
        its.position[:] = position
        its.api._queue_scene_message(_messages.SetPositionMessage(its.name, position))


def control_id(handle: Any) -> str:
    """The name by which a browser writes into a GUI control: also its element's id."""
    return str(handle._impl.uuid)


def set_progress(bar: Any, part: float) -> None:
    """How far a bar is, 0 to 1 (viser's class calls its own setter read-only)."""
    bar.__setattr__("value", 100.0 * min(max(part, 0.0), 1.0))


def inputs(server: viser.ViserServer) -> dict[str, Any]:
    """Every element of the GUI that takes a value, by its name (for tests)."""
    return dict(server.gui._gui_input_handle_from_uuid)


def broadcast_messages(server: viser.ViserServer) -> list[Any]:
    """What a browser that joins now would be sent (for tests)."""
    return list(server._websock_server._broadcast_buffer.message_from_id.values())


def press(control: str, value: bool | str) -> Json:
    """The message by which our script presses a button, as viser's own page sends it."""
    return {"type": "GuiUpdateMessage", "uuid": control, "updates": {"value": value}}
