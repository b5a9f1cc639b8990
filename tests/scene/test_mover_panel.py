"""What the town's operator asks for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from app.motion.commands import Order
from app.scene import private
from app.scene.mover_page import MoverScene
from app.scene.mover_panel import SAVE, header
from app.visit import LoadVisitor, SaveVisitor
from app.visiting import Visiting
from app.world import make_town
from tests.scene.browsers import client, until

TOWN = make_town()


@pytest.fixture
def orders() -> list[Order]:
    return []


@pytest.fixture
def scene(orders: list[Order]) -> Iterator[MoverScene]:
    made = MoverScene(orders.append, TOWN)
    yield made
    made.close()


def control(scene: MoverScene, label: str) -> str:
    """A control by its label, or by its one button."""
    named = {
        uuid: (getattr(handle, "label", ""), *getattr(handle, "options", ()))
        for uuid, handle in private.inputs(scene._server).items()
    }
    return next(uuid for uuid, words in named.items() if label in words)


def test_a_visitor_is_saved_once_the_name_is_whole(scene: MoverScene, orders: list[Order]) -> None:
    """A page sends a text letter by letter: each is no visitor."""
    scene.draw(replace(Visiting(TOWN).still(0, ""), visitors=("ben",)))
    with client(scene.port) as browser:
        browser.write(control(scene, SAVE), SAVE)
        until(lambda: len(orders) == 1)
        for name in ("a", "an", "ann", "anna "):
            browser.write(control(scene, "Name"), name)
        browser.write(control(scene, SAVE), SAVE)
        until(lambda: len(orders) == 2)
        browser.write(control(scene, "Load"), "ben")
        until(lambda: len(orders) == 3)
    assert [o.command for o in orders] == [SaveVisitor(""), SaveVisitor("anna"), LoadVisitor("ben")]


def test_the_operator_reads_what_is_wrong_with_a_line_and_why_nothing_moves() -> None:
    visiting = Visiting(TOWN)
    visiting.trouble = "left foot: 12 % of packets damaged"
    told = header(visiting.step(0))
    assert "12 % of packets damaged" in told
    assert "no sensor is heard yet" in told
    visiting.message = "visitor anna saved"
    assert "anna saved" in header(visiting.step(1))
