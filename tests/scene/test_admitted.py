"""Whatever the door lets through, the controls and the session take: an order, one line, or nothing."""

from __future__ import annotations

import logging
import random
from typing import Any

import msgspec
import pytest

from app.door.filter import admit
from app.motion.basics import InputError
from app.motion.commands import Order
from app.motion.door import GuiRule
from app.scene.page import Scene
from app.session import Session
from app.settings import Settings
from tests.scene import fakes
from tests.scene.browsers import client, until

MESSAGES = 600


def anything(chance: random.Random, rule: GuiRule) -> object:
    """A value that the rule allows, or one that it should not."""
    low, high = max(rule.low, -1e300), min(rule.high, 1e300)
    text = "".join(chance.choice("aé/.<&\"'\\ ßΩ🙂%{}$\u200b\0\n\ud83d") for _ in range(chance.randrange(90)))
    numbers = [
        low,
        high,
        0.0,
        -0.0,
        5e-324,
        chance.uniform(low, high) if high - low < 1e300 else 1e300,
        2**63,
    ]
    return chance.choice([*numbers, *rule.choices, text, True, False, float("nan"), None, [], {"a": 1}])


def message(chance: random.Random, uuid: str, rule: GuiRule) -> bytes:
    """As a browser could send it; what MessagePack has no letters for comes as rubbish."""
    kind = chance.choice(["GuiUpdateMessage"] * 9 + ["CommandTriggerMessage"])
    whole: dict[str, Any] = {"type": kind, "uuid": uuid}
    if kind == "GuiUpdateMessage":
        whole["updates"] = {"value": anything(chance, rule)}
    try:
        return msgspec.msgpack.encode(whole)
    except UnicodeEncodeError:
        return b"\x81\xa4type\xa1\xed"


def test_every_message_that_comes_through_is_taken(
    scene: Scene, orders: list[Order], caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    chance = random.Random(4)
    scene.draw(fakes.snapshot(5.0, two=True, candidate=True), fakes.status(replay=True))
    rules = sorted(scene.rules().items())
    passed = 0
    with client(scene.port) as browser:
        until(lambda: len(scene._server.get_clients()) == 1)
        for _ in range(MESSAGES):
            verdict = admit(message(chance, *chance.choice(rules)), scene.rules())
            if isinstance(verdict, bytes):
                browser.send(msgspec.msgpack.decode(verdict))
                passed += 1
        pause = next(uuid for uuid, rule in rules if "Pause" in rule.choices)
        before = len(orders)
        browser.write(pause, "Pause")
        until(lambda: any(type(order.command).__name__ == "Pause" for order in orders[before:]))
    assert passed > MESSAGES / 10
    session = Session(Settings())
    for order in orders:
        try:
            session.apply(order)
        except InputError as error:
            assert "\n" not in str(error)
    scene.draw(fakes.snapshot(6.0), fakes.status())
    assert [record for record in caplog.records if record.levelno >= logging.ERROR] == []
