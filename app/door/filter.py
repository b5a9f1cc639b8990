"""Door: which browser messages may pass to viser. Pure: bytes in, bytes or a refusal out.

viser 1.1.1 sends and reads one MessagePack map per websocket frame, ``type`` naming the message.
What passes is decoded into one of the few structs below, checked, and encoded again, so that
nothing of the original bytes reaches viser.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Annotated, Any, NamedTuple

import msgspec

from app.motion.door import GuiRule

#: Messages that viser's page can send and we don't let through, by name so that they are counted.
REFUSED_TYPES = frozenset({
    "FileTransferPart", "FileTransferStartUpload", "GetRenderResponseMessage", "GuiButtonHoldMessage",
    "GuiFormDirtyMessage", "GuiFormSubmitMessage", "LocalStorageGetItemResponseMessage",
    "SceneNodeClickMessage", "SceneNodeDragMessage", "ScenePointerMessage", "ShareUrlDisconnect",
    "ShareUrlRequest", "TransformControlsDragEndMessage", "TransformControlsDragStartMessage",
    "TransformControlsUpdateMessage",
})  # fmt: skip

Value = bool | int | float | str
Rules = Mapping[str, GuiRule]


class Dropped(NamedTuple):
    """A message that is not for us: count it and go on."""

    type: str
    why: str


class Malformed(NamedTuple):
    """Not a message at all: end the connection."""

    why: str


class _Envelope(msgspec.Struct):
    type: str


_Numbers3 = tuple[float, float, float]
_Pixels = Annotated[int, msgspec.Meta(ge=0, le=65535)]


class _Camera(msgspec.Struct, tag="ViewerCameraMessage", forbid_unknown_fields=True):
    wxyz: tuple[float, float, float, float]
    position: _Numbers3
    fov: float
    near: float
    far: float
    image_height: _Pixels
    image_width: _Pixels
    look_at: _Numbers3
    up_direction: _Numbers3


class _Update(msgspec.Struct, forbid_unknown_fields=True):
    value: Value


class _GuiUpdate(msgspec.Struct, tag="GuiUpdateMessage", forbid_unknown_fields=True):
    uuid: str
    updates: _Update


class _Command(msgspec.Struct, tag="CommandTriggerMessage", forbid_unknown_fields=True):
    """A hotkey or an entry of the command palette."""

    uuid: str


def admit(message: bytes, rules: Rules) -> bytes | Dropped | Malformed:
    """The bytes to hand to viser in place of ``message``, or why not. Never raises.

    ``rules`` says what may be written, by the control's uuid; a control it does not name is
    refused. ``admit(admit(m)) == admit(m)``.
    """
    kind = _type_of(message)
    if isinstance(kind, Malformed):
        return kind
    if kind not in _CHECKS:
        return Dropped(kind if kind in REFUSED_TYPES else "other", "this type is not let through")
    decoder, check = _CHECKS[kind]
    try:
        decoded = decoder.decode(message)
    except msgspec.ValidationError as error:
        return Dropped(kind, str(error))
    except (ValueError, RecursionError) as error:
        return Malformed(str(error))
    why = check(decoded, rules)
    return Dropped(kind, why) if why else msgspec.msgpack.encode(decoded)


def _type_of(message: bytes) -> str | Malformed:
    try:
        return _ENVELOPE.decode(message).type
    except (ValueError, RecursionError) as error:  # all of msgspec's are ValueErrors
        return Malformed(str(error))


def _check_camera(camera: _Camera, rules: Rules) -> str:
    numbers = (
        *camera.wxyz, *camera.position, *camera.look_at, *camera.up_direction,
        camera.fov, camera.near, camera.far,
    )  # fmt: skip
    return "" if all(map(math.isfinite, numbers)) else "a number is not finite"


def _check_update(update: _GuiUpdate, rules: Rules) -> str:
    rule = rules.get(update.uuid)
    if rule is None:
        return "unknown control"
    fitting = fit(update.updates.value, rule)
    if fitting is None:
        return f"the value is no {rule.kind} in its range"
    update.updates.value = fitting
    return ""


def _check_command(command: _Command, rules: Rules) -> str:
    rule = rules.get(command.uuid)
    return "" if rule is not None and rule.kind == "button" else "unknown command"


def fit(value: Value, rule: GuiRule) -> Value | None:
    """``value`` as it may be written into the control of ``rule``; None where it may not.

    A kind that isn't known takes nothing. The last bit that a slider adds to its end is taken off.
    """
    if rule.kind == "number":
        return _fit_number(value, rule)
    return value if _OBEYS.get(rule.kind, _never)(value, rule) else None


def _fit_number(value: Value, rule: GuiRule) -> Value | None:
    if isinstance(value, bool | str) or not math.isfinite(value):
        return None
    slack = 1e-9 * max(1.0, abs(value))
    within = rule.low - slack <= value <= rule.high + slack
    return min(max(value, rule.low), rule.high) if within else None


def _never(value: Value, rule: GuiRule) -> bool:
    return False


_OBEYS: dict[str, Callable[[Value, GuiRule], bool]] = {
    "bool": lambda value, rule: isinstance(value, bool),
    "button": lambda value, rule: value is True,
    "choice": lambda value, rule: isinstance(value, str) and value in rule.choices,
    "text": lambda value, rule: (
        isinstance(value, str) and len(value) <= rule.max_length and value.isprintable()
    ),
}
_ENVELOPE = msgspec.msgpack.Decoder(_Envelope)
_CHECKS: dict[str, tuple[msgspec.msgpack.Decoder[Any], Callable[[Any, Rules], str]]] = {
    "ViewerCameraMessage": (msgspec.msgpack.Decoder(_Camera), _check_camera),
    "GuiUpdateMessage": (msgspec.msgpack.Decoder(_GuiUpdate), _check_update),
    "CommandTriggerMessage": (msgspec.msgpack.Decoder(_Command), _check_command),
}
