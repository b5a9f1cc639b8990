"""The contract with viser 1.1.1: what this project uses and viser does not promise."""

from __future__ import annotations

import asyncio
import socket
import threading
from collections import deque
from collections.abc import Iterator
from importlib.metadata import version
from typing import Any

from viser import _messages

from app.scene import private
from app.scene.page import Scene
from tests.scene.browsers import client, until


def test_the_version_that_was_read() -> None:
    assert version("viser") == "1.1.1"


def test_it_listens_on_loopback_and_says_nothing(capsys: object, scene: Scene) -> None:
    assert scene._server.get_host() == "127.0.0.1"
    assert 0 < scene.port < 65536
    assert not capsys.readouterr().out  # type: ignore[attr-defined]


def test_no_browser_can_open_a_tunnel(scene: Scene) -> None:
    handlers = scene._server._websock_server._incoming_handlers
    assert _messages.ShareUrlRequest not in handlers
    assert _messages.ShareUrlDisconnect not in handlers
    assert _messages.GuiUpdateMessage in handlers


def test_little_is_kept_for_a_browser_that_is_slow(scene: Scene) -> None:
    with client(scene.port):
        until(lambda: bool(scene._server._websock_server._live_connections))
        (connection,) = scene._server._websock_server._live_connections.values()
        kept = connection.transport.get_extra_info("socket")
        assert kept.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF) <= 2 * private.SOCKET_BYTES


def test_a_controls_name_is_the_key_of_its_messages(scene: Scene) -> None:
    button = scene._server.gui.add_button("x")
    assert scene._server.gui._gui_input_handle_from_uuid[private.control_id(button)] is button


def test_a_press_is_what_viser_itself_sends() -> None:
    message = private.press("some-uuid", True)
    assert message.pop("type") == _messages.GuiUpdateMessage.__name__
    assert _messages.GuiUpdateMessage(**message) == _messages.GuiUpdateMessage("some-uuid", {"value": True})


def test_a_pose_is_sent_whatever_it_was(scene: Scene) -> None:
    node = scene._server.scene.add_frame("/x")
    private.force_pose(node, (1.0, 0.0, 0.0, 0.0), (100.0, 0.0, 0.0))
    private.force_pose(node, (1.0, 0.0, 0.0, 0.0), (100.0004, 0.0, 0.0))
    assert node.position[0] == 100.0004
    sent = [
        m for m in private.broadcast_messages(scene._server) if isinstance(m, _messages.SetPositionMessage)
    ]
    assert [m.position[0] for m in sent if m.name == "/x"] == [100.0004]


def test_progress_goes_from_nought_to_a_hundred(scene: Scene) -> None:
    bar = scene._server.gui.add_progress_bar(0.0)
    private.set_progress(bar, 0.25)
    assert bar.value == 25.0
    private.set_progress(bar, 7.0)
    assert bar.value == 100.0


def test_two_scenes_have_two_ports(scene: Scene) -> None:
    other = private.open_server("other")
    try:
        assert other.get_port() != scene.port
    finally:
        private.close_server(other)


class Visited(deque[Any]):
    """Notes which threads went through it."""

    def __init__(self, held: deque[Any]) -> None:
        super().__init__(held)
        self.threads = set[int]()

    def __iter__(self) -> Iterator[Any]:
        self.threads.add(threading.get_ident())
        return super().__iter__()


def test_only_visers_own_thread_wakes_who_waits_for_messages(scene: Scene) -> None:
    """Another thread would meet browsers that come and go: "deque mutated during iteration"."""
    buffer = scene._server._websock_server._broadcast_buffer
    buffer.message_event._waiters = visited = Visited(buffer.message_event._waiters)

    async def wait() -> bool:
        buffer.message_event.clear()
        return await buffer.message_event.wait()

    woken = asyncio.run_coroutine_threadsafe(wait(), buffer.event_loop)
    until(lambda: len(visited) > 0)
    scene._server.scene.add_frame("/anything")
    assert woken.result(timeout=90.0)
    assert threading.get_ident() not in visited.threads
