"""A browser's messages against a real viser: good ones arrive, forged ones change nothing."""

from __future__ import annotations

import contextlib
import math
import struct
import threading
import time
from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
import pytest
import websockets.exceptions
import zstandard

from app.door import bridge
from app.door.bridge import MAX_INBOUND_BYTES

Frame = Callable[..., bytes]
Wait = Callable[..., None]
pack = msgspec.msgpack.encode


def send_then_mark(house: Any, set_value: Frame, wait: Wait, *frames: bytes) -> None:
    """Send frames over one connection, then an honest one, and wait until viser has taken that."""
    with house.connect() as websocket:
        for frame in frames:
            websocket.send(frame)
        mark = f"mark {house.door.counters.connections_total}"
        websocket.send(set_value(house.name, mark))
        wait(lambda: house.name.value == mark)


def test_a_value_in_range_arrives(house: Any, set_value: Frame, wait: Wait) -> None:
    send_then_mark(house, set_value, wait, set_value(house.slider, 1.5))
    assert house.slider.value == 1.5


def test_a_value_arrives_in_the_other_browser_too(house: Any, set_value: Frame, wait: Wait) -> None:
    with house.connect() as other:
        send_then_mark(house, set_value, wait, set_value(house.slider, 1.25))
        seen = b""
        while house.slider._impl.uuid.encode() not in seen.split(b"mark")[0] or b"mark" not in seen:
            seen = _messages(other.recv(timeout=60))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 2.5, -1, "1.5", None, [1.0], True, {}])
def test_a_forged_value_changes_nothing(house: Any, set_value: Frame, wait: Wait, value: object) -> None:
    send_then_mark(house, set_value, wait, set_value(house.slider, value))
    assert house.slider.value == 1.0
    assert house.door.counters.dropped_messages == {"GuiUpdateMessage": 1}


@pytest.mark.parametrize("inner", [{"removed": True}, {"sync_cb": None}, {"update_cb": []}])
def test_inner_fields_cannot_be_written(house: Any, set_value: Frame, wait: Wait, inner: Any) -> None:
    state = house.slider._impl
    before = (state.removed, state.sync_cb, list(state.update_cb))
    alone = pack({"type": "GuiUpdateMessage", "uuid": state.uuid, "updates": inner})
    send_then_mark(house, set_value, wait, set_value(house.slider, 1.5, **inner), alone)
    assert house.slider.value == 1.0
    assert (state.removed, state.sync_cb, list(state.update_cb)) == before
    send_then_mark(house, set_value, wait, set_value(house.slider, 0.5))
    assert house.slider.value == 0.5


def test_a_control_without_a_rule_cannot_be_written(house: Any, set_value: Frame, wait: Wait) -> None:
    secret = house.viser.gui.add_checkbox("operator only", False)
    send_then_mark(house, set_value, wait, set_value(secret, True))
    assert secret.value is False


def test_the_share_tunnel_cannot_be_asked_for(
    house: Any, set_value: Frame, wait: Wait, monkeypatch: Any
) -> None:
    asked: list[str] = []
    monkeypatch.setattr(house.viser, "request_share_url", lambda *a, **k: asked.append("share"))
    monkeypatch.setattr(house.viser, "disconnect_share_url", lambda *a, **k: asked.append("end"))
    share = pack({"type": "ShareUrlRequest"})
    send_then_mark(house, set_value, wait, share, pack({"type": "ShareUrlDisconnect"}), share)
    assert asked == []
    assert house.door.counters.dropped_messages == {"ShareUrlRequest": 2, "ShareUrlDisconnect": 1}


@pytest.mark.parametrize("frame", [b"", b"garbage", pack([]), pack([{"type": "ShareUrlRequest"}]), "text"])
def test_what_is_no_message_ends_that_connection_and_no_other(
    house: Any, set_value: Frame, wait: Wait, frame: bytes | str
) -> None:
    with house.connect() as good, house.connect() as bad:
        bad.send(frame)
        read_to_the_end(bad)
        good.send(set_value(house.slider, 0.25))
        wait(lambda: house.slider.value == 0.25)
    assert house.door.counters.closed_malformed == 1


@pytest.mark.parametrize("size", [MAX_INBOUND_BYTES, 60_000_000, 2**62])
def test_a_message_too_big_is_refused_by_its_first_bytes(
    house: Any, set_value: Frame, wait: Wait, size: int
) -> None:
    bad = house.knock()
    bad.sendall(b"\x82\xff" + struct.pack(">Q", size) + b"mask" + b"start")  # the rest is never sent
    while bad.recv(65536):
        pass
    assert house.door.counters.closed_too_big == 1
    send_then_mark(house, set_value, wait, set_value(house.slider, 0.5))
    assert house.slider.value == 0.5


def test_a_message_too_big_in_pieces_is_refused(house: Any) -> None:
    with house.connect() as bad, pytest.raises(websockets.exceptions.ConnectionClosed):
        bad.send(bytes(1000) for _ in range(100_000))
    assert house.door.counters.closed_too_big == 1


def test_big_messages_of_viser_come_through(house: Any) -> None:
    points = np.arange(6_000_000, dtype=np.float32).reshape(-1, 3)
    with house.connect() as websocket:
        house.viser.scene.add_point_cloud("/big", points, (1, 2, 3), precision="float32")
        while len(frame := websocket.recv(timeout=30)) < points.nbytes:
            pass
        assert points.tobytes() in frame


def test_one_browser_that_never_reads_stalls_nobody_and_little_waits_for_it(house: Any) -> None:
    count = 120  # frames of about a megabyte
    points = np.zeros((80_000, 3), np.float32)
    cloud = house.viser.scene.add_point_cloud("/c", points, (1, 2, 3), precision="float32")
    stalled = house.knock()
    with house.connect() as good:
        newest = threading.Thread(target=_read_until, args=(good, np.full(3, count, np.float32).tobytes()))
        newest.start()
        for number in range(1, count + 1):
            cloud.points = np.full_like(points, number)
            house.viser.flush()
            time.sleep(1 / 60)
        newest.join(30)
        assert not newest.is_alive()
    assert _drain(stalled) < count * points.nbytes / 4


def test_one_that_takes_nothing_is_let_go_and_one_that_is_slow_is_not(
    house: Any, wait: Wait, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bridge, "STALL_SECONDS", 3.0)
    monkeypatch.setattr(bridge, "LOOK_SECONDS", 0.1)
    points = np.zeros((400_000, 3), np.float32)
    cloud = house.viser.scene.add_point_cloud("/c", points, (1, 2, 3), precision="float32")
    stalled, slow = house.knock(), house.knock()
    wait(lambda: house.door.counters.connections == 2)
    ended = threading.Event()

    def keep_sending() -> None:
        number = 0
        while not ended.wait(0.02):
            number += 1
            cloud.points = np.full_like(points, number)
            house.viser.flush()

    def keep_reading() -> None:
        while not ended.wait(0.02) and slow.recv(16 * 1024):
            pass

    threads = [threading.Thread(target=work) for work in (keep_sending, keep_reading)]
    for thread in threads:
        thread.start()
    try:
        began = time.monotonic()
        while house.door.counters.closed_stalled == 0:
            with contextlib.suppress(ConnectionError):
                stalled.send(b"\x89\x80mask")  # to ask for answers is not to take them
            time.sleep(0.05)
            assert time.monotonic() < began + 60.0
        time.sleep(0.5)
        assert (house.door.counters.closed_stalled, house.door.counters.connections) == (1, 1)
    finally:
        ended.set()
        for thread in threads:
            thread.join()
    with contextlib.suppress(ConnectionError):  # its end comes, and not a time-out
        while stalled.recv(1 << 16):
            pass


def test_a_flood_of_messages_is_read_slowly_and_stops_nobody(
    house: Any, set_value: Frame, wait: Wait
) -> None:
    with house.connect() as flooding, house.connect() as good:
        for i in range(450):
            flooding.send(set_value(house.slider, 0.5 + i / 1000))
        for _ in range(50):
            flooding.ping()
        good.send(set_value(house.name, "still here"))
        wait(lambda: house.name.value == "still here")
        wait(lambda: house.door.counters.paced > 10)
        wait(lambda: house.slider.value == 0.5 + 449 / 1000)  # and nothing of it was lost


def test_a_browser_that_leaves_is_forgotten(house: Any, wait: Wait) -> None:
    gone = house.knock()
    wait(lambda: house.door.counters.connections == 1)
    gone.close()
    wait(lambda: house.door.counters.connections == 0)
    wait(lambda: not house.viser._websock_server._live_connections)


def test_when_viser_ends_the_browser_is_told(house: Any) -> None:
    with house.connect() as websocket:
        websocket.recv(timeout=60)
        house.viser.stop()
        read_to_the_end(websocket)


def read_to_the_end(websocket: Any) -> None:
    """Read until the other side has ended the connection."""
    with contextlib.suppress(websockets.exceptions.ConnectionClosed):
        while True:
            websocket.recv(timeout=60)


def _messages(frame: bytes) -> bytes:
    packed = int.from_bytes(frame[8:16], "little")
    return zstandard.ZstdDecompressor().decompress(
        frame[16 : 16 + packed], max_output_size=int.from_bytes(frame[:8], "little")
    )


def _read_until(websocket: Any, content: bytes) -> None:
    while content not in websocket.recv(timeout=30)[-200:]:
        pass


def _drain(connection: Any) -> int:
    """All that waits for a socket: until a second brings nothing."""
    connection.settimeout(1.0)
    total = 0
    try:
        while data := connection.recv(1 << 16):
            total += len(data)
    except TimeoutError:
        pass
    return total
