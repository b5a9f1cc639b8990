"""Two kinds of visitors: what a viewer's browser says moves nothing, however it is said."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import pytest

from app.door.access import Visitor
from app.motion.door import GuiRule
from tests.door.test_filter import CAMERA

pack = msgspec.msgpack.encode


@pytest.fixture
def house(open_house: Callable[..., Any]) -> Any:
    return open_house(operator="secret-token", viewer="look-only-token")


def cookie(house: Any, token: str) -> dict[str, str]:
    """The header by which a browser that opened the address with this token is known."""
    return {"Cookie": house.get(f"/?token={token}")[1]["set-cookie"].split(";")[0]}


def enter(house: Any, token: str) -> Any:
    return house.connect(additional_headers=cookie(house, token))


def test_a_viewer_sees_what_an_operator_does_and_moves_nothing(
    house: Any, set_value: Callable[..., bytes], wait: Callable[..., None]
) -> None:
    button, hotkey = house.viser.gui.add_button("record"), house.viser.gui.add_command("mark", hotkey="M")
    pressed: list[str] = []
    button.on_click(lambda event: pressed.append("button"))
    hotkey.on_trigger(lambda event: pressed.append("key"))
    house.rules.update({handle._impl.uuid: GuiRule("button") for handle in (button, hotkey)})
    forged = [
        set_value(house.slider, 1.5), set_value(house.name, "mine"), set_value(button, True),
        pack({"type": "CommandTriggerMessage", "uuid": hotkey._impl.uuid}), pack({"type": "ShareUrlRequest"}),
        pack({"type": "FileTransferStartUpload", "source_component_uuid": "x", "transfer_uuid": "y"}),
        pack({"type": "FileTransferPart", "content": b"x", "part_index": 0}),
    ]  # fmt: skip
    with enter(house, "look-only-token") as viewer, enter(house, "secret-token") as operator:
        for frame in (pack(CAMERA), *forged, set_value(house.slider, 0.1)):
            viewer.send(frame)
        wait(lambda: sum(house.door.counters.dropped_messages.values()) == len(forged) + 1)
        assert (house.slider.value, house.name.value, pressed) == (1.0, "", [])
        operator.send(set_value(house.slider, 0.75))
        wait(lambda: house.slider.value == 0.75)
        assert viewer.recv(timeout=60)


def test_the_page_says_who_looks(house: Any) -> None:
    for token, visitor in (("secret-token", Visitor.OPERATOR), ("look-only-token", Visitor.VIEWER)):
        assert f'<html data-visitor="{visitor}"' in house.get("/", **cookie(house, token))[2]


def test_a_viewer_s_cookie_makes_no_operator(house: Any) -> None:
    value = cookie(house, "look-only-token")["Cookie"].partition("=")[2]
    assert house.get(f"/?token={value}")[0] == 401
    both = {"Cookie": f"{cookie(house, 'look-only-token')['Cookie']}; stridescope-1={value}"}
    assert '<html data-visitor="viewer"' in house.get("/", **both)[2]
