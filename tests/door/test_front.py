"""The door as its user meets it: it opens or says why not, and it always shuts."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable
from typing import Any

import pytest

from app.door.access import Access
from app.door.front import Door
from app.motion.basics import InputError


def door(**more: Any) -> Door:
    options: dict[str, Any] = {"port": 0, **more}
    return Door(Access(**options), viser_port=9, rules=dict, health=dict)


def one_line(error: BaseException) -> str:
    assert "\n" not in str(error)
    return str(error)


def test_a_taken_port_is_one_clear_line_and_never_the_next_port() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        with pytest.raises(InputError) as refused:
            door(port=port).start()
    assert f"port {port} is taken" in one_line(refused.value)
    assert "--port" in str(refused.value)


@pytest.mark.parametrize("host", ["192.0.2.77", "no-such-host.invalid"])
def test_a_host_that_is_not_this_machine_is_said(host: str) -> None:
    with pytest.raises(InputError) as refused:
        door(host=host, operator="secret").start()
    assert host in one_line(refused.value)


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost"])
def test_the_address_is_where_it_listens(host: str) -> None:
    front = door(host=host)
    front.start()
    port = int(front.address.removeprefix("http://127.0.0.1:"))
    socket.create_connection(("127.0.0.1", port)).close()
    front.stop()


def test_the_first_address_carries_the_token_and_others_can_reach_it() -> None:
    front = door(host="0.0.0.0", operator="se cret&")
    front.start()
    assert front.address.endswith("/?token=se%20cret%26")
    assert "0.0.0.0" not in front.address
    front.stop()


def test_stop_frees_the_port_and_may_be_called_again() -> None:
    front = door()
    front.stop()  # before it was started
    front.start()
    port = int(front.address.rpartition(":")[2])
    front.stop()
    front.stop()
    again = door(port=port)
    again.start()
    again.stop()


def test_stop_does_not_wait_for_clients_that_stall(
    open_house: Callable[..., Any], wait: Callable[..., None]
) -> None:
    house = open_house()
    for _ in range(3):
        house.knock()
        house.say(b"GET / HTTP/1.1\r\nHo")  # a request that never ends
    wait(lambda: house.door.counters.connections == 3)
    house.door.stop()
    assert not any(thread.name == "door" for thread in threading.enumerate())
    assert house.door.counters.connections == 0
