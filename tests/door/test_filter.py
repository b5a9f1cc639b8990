"""The message filter: what passes is exactly what a rule allows, whatever the bytes."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.door.filter import REFUSED_TYPES, Dropped, Malformed, admit
from app.motion.door import GuiRule

RULES = {
    "slider": GuiRule("number", 0.0, 2.0),
    "any": GuiRule("number"),
    "check": GuiRule("bool"),
    "name": GuiRule("text", max_length=5),
    "pick": GuiRule("choice", choices=("x", "y")),
    "press": GuiRule("button"),
    "odd": GuiRule("unheard of"),
}
CAMERA: dict[str, Any] = {
    "type": "ViewerCameraMessage", "wxyz": [1, 0, 0, 0.5], "position": [3.0, 3, 3], "fov": 1.3, "near": 0.01,
    "far": 1000, "image_height": 720, "image_width": 1280, "look_at": [0, 0, 0], "up_direction": [0, 0, 1],
}  # fmt: skip
pack = msgspec.msgpack.encode
unpack = msgspec.msgpack.decode


def update(uuid: object, value: object, **more: object) -> bytes:
    return pack({"type": "GuiUpdateMessage", "uuid": uuid, "updates": {"value": value, **more}})


@pytest.mark.parametrize(
    ("uuid", "value"),
    [
        ("slider", 0), ("slider", 2.0), ("slider", 1.25), ("any", -1e300), ("any", 2**64 - 1),
        ("check", True), ("check", False), ("name", ""), ("name", "Zoë 3"), ("pick", "y"), ("press", True),
    ],
)  # fmt: skip
def test_what_a_rule_allows_passes_unchanged(uuid: str, value: object) -> None:
    passed = admit(update(uuid, value), RULES)
    assert isinstance(passed, bytes)
    assert unpack(passed) == unpack(update(uuid, value))


@pytest.mark.parametrize(
    ("uuid", "value"),
    [
        ("slider", math.nan), ("slider", math.inf), ("any", math.inf), ("any", -math.inf), ("slider", 2.001),
        ("slider", -0.001), ("slider", "1"), ("slider", True), ("slider", None), ("slider", [1.0]),
        ("slider", {}), ("slider", b"1"), ("check", 1), ("check", "true"), ("name", "sixsix"), ("name", 3),
        ("name", "a\nb"), ("name", "a\u202eb"), ("pick", "z"), ("pick", ""), ("pick", 0), ("press", False),
        ("press", 1), ("odd", 1.0), ("nobody's", 1.0),
    ],
)  # fmt: skip
def test_anything_else_is_dropped(uuid: str, value: object) -> None:
    verdict = admit(update(uuid, value), RULES)
    assert isinstance(verdict, Dropped)
    assert verdict.type == "GuiUpdateMessage"


@pytest.mark.parametrize("field", ["removed", "sync_cb", "update_cb", "props", "is_button", ""])
def test_inner_fields_of_a_control_are_never_written(field: str) -> None:
    assert isinstance(admit(update("slider", 1.0, **{field: True}), RULES), Dropped)
    alone = {"type": "GuiUpdateMessage", "uuid": "slider", "updates": {field: True}}
    assert isinstance(admit(pack(alone), RULES), Dropped)


def test_no_field_may_be_added_or_missing() -> None:
    fields = unpack(update("slider", 1.0))
    assert isinstance(admit(pack({**fields, "excluded_self_client": 0}), RULES), Dropped)
    assert isinstance(admit(pack({"type": "GuiUpdateMessage", "uuid": "slider"}), RULES), Dropped)
    assert isinstance(admit(update(7, 1.0), RULES), Dropped)


def test_the_last_bit_of_a_slider_s_end_is_taken_off() -> None:
    rules = {"s": GuiRule("number", 0.0, 0.3)}
    passed = admit(update("s", 0.1 + 0.2), rules)  # 0.30000000000000004
    assert isinstance(passed, bytes)
    assert unpack(passed)["updates"] == {"value": 0.3}


def test_the_camera_passes_and_stays_the_same() -> None:
    passed = admit(pack(CAMERA), {})
    assert isinstance(passed, bytes)
    assert unpack(passed) == CAMERA


@pytest.mark.parametrize("field", [name for name in CAMERA if name != "type"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, None, "1", [], [0, math.nan, 0], [0, 0, 0, math.inf]])
def test_a_camera_with_one_bad_field_is_dropped(field: str, bad: object) -> None:
    assert isinstance(admit(pack({**CAMERA, field: bad}), {}), Dropped)


def test_a_hotkey_needs_a_button_s_rule() -> None:
    assert isinstance(admit(pack({"type": "CommandTriggerMessage", "uuid": "press"}), RULES), bytes)
    for uuid in ("slider", "nobody's"):
        assert isinstance(admit(pack({"type": "CommandTriggerMessage", "uuid": uuid}), RULES), Dropped)


@pytest.mark.parametrize("name", sorted(REFUSED_TYPES))
def test_other_messages_of_viser_are_dropped_by_name(name: str) -> None:
    assert admit(pack({"type": name, "uuid": "slider"}), RULES)[:1] == (name,)


def test_names_nobody_knows_share_one_counter() -> None:
    verdict = admit(pack({"type": "A" * 1000}), RULES)
    assert isinstance(verdict, Dropped)
    assert verdict.type == "other"


@pytest.mark.parametrize(
    "message",
    [
        b"", b"garbage", b"\xc1", b"\xdd\xff\xff\xff\xff", b"\x91" * 100_000, b"\x81\xa1x" * 100_000,
        pack([]), pack([CAMERA]), pack(3), pack({}), pack({"type": 3}), pack({1: 2}), pack(CAMERA) + b"\x00",
        b"\x81\xa4type\xa3\xff\xfe\xfd", pack(CAMERA)[:-1],
        b"\x82\xa4type\xb0GuiUpdateMessage\xa4uuid\xa3\xff\xfe\xfd",
        b"\x82\xa4type\xb0GuiUpdateMessage\xa7updates" + b"\x91" * 100_000,
    ],
)  # fmt: skip
def test_what_is_no_message_is_malformed(message: bytes) -> None:
    assert isinstance(admit(message, RULES), Malformed)


def test_a_field_named_twice_counts_once() -> None:
    twice = b"\x83\xa4type\xb0GuiUpdateMessage\xa4uuid\xa6slider\xa7updates\x82\xa5value\x01\xa5value\x02"
    assert admit(twice, RULES) == admit(update("slider", 2), RULES)


def is_allowed(message: dict[str, Any]) -> bool:
    """A second opinion on what passed, written from the rules' own words."""
    if message["type"] == "ViewerCameraMessage":
        return set(message) == set(CAMERA)
    if message["type"] == "CommandTriggerMessage":
        return RULES[message["uuid"]].kind == "button"
    (field, value), rule = next(iter(message["updates"].items())), RULES[message["uuid"]]
    fits = {
        "number": type(value) in (int, float) and math.isfinite(value) and rule.low <= value <= rule.high,
        "bool": type(value) is bool,
        "text": type(value) is str and len(value) <= rule.max_length,
        "choice": value in rule.choices,
        "button": value is True,
    }
    return field == "value" and len(message["updates"]) == 1 and fits[rule.kind]


def holds(message: bytes) -> None:
    passed = admit(message, RULES)
    if isinstance(passed, bytes):
        assert admit(passed, RULES) == passed
        assert is_allowed(unpack(passed))
    else:
        assert isinstance(passed, Dropped | Malformed)


scalars = st.none() | st.booleans() | st.integers(-(2**63), 2**64 - 1) | st.floats() | st.text(max_size=8)
values = st.recursive(
    scalars | st.binary(max_size=8) | st.sampled_from(["x", 0.5]),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=8,
)
names = st.sampled_from([*RULES, "updates", "value", "removed", *CAMERA])
types = st.sampled_from(["GuiUpdateMessage", "CommandTriggerMessage", "ViewerCameraMessage", *REFUSED_TYPES])
updates = st.fixed_dictionaries({"value": values}) | st.dictionaries(names, values, max_size=2)
uuids = st.sampled_from([*RULES]) | values
like_messages = st.fixed_dictionaries(
    {"type": types | st.text(max_size=8), "uuid": uuids, "updates": updates | values}
) | st.fixed_dictionaries({k: st.just(v) | values for k, v in CAMERA.items()})


@given(st.binary(max_size=200))
def test_no_bytes_break_it(message: bytes) -> None:
    holds(message)


@given(like_messages)
def test_no_message_breaks_it(message: dict[str, Any]) -> None:
    holds(pack(message))


@given(like_messages, st.data())
def test_no_damaged_message_breaks_it(message: dict[str, Any], data: st.DataObject) -> None:
    damaged = bytearray(pack(message))
    place = data.draw(st.integers(0, len(damaged) - 1))
    damaged[place] = data.draw(st.integers(0, 255))
    holds(bytes(damaged[: data.draw(st.integers(place, len(damaged)))]))


@given(st.floats(), st.floats(allow_nan=False), st.floats(allow_nan=False))
def test_a_number_that_passes_is_in_its_range(value: float, low: float, high: float) -> None:
    passed = admit(update("s", value), {"s": GuiRule("number", low, high)})
    if isinstance(passed, bytes):
        assert low <= unpack(passed)["updates"]["value"] <= high
