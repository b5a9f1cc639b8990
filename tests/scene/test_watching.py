"""A viewer's page in a real Chromium: it says so, shows everything, and none of its controls moves."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.door.access import Access
from app.door.front import Door
from app.motion.commands import Order
from app.scene.page import Scene
from tests.scene import fakes
from tests.scene.browsers import until


@pytest.fixture
def door(scene: Scene) -> Iterator[Door]:
    access = Access(port=0, operator="to operate", viewer="to watch")
    door = Door(access, viser_port=scene.port, rules=scene.rules, health=dict, extra_head=scene.head)
    door.start()
    over = threading.Event()

    def draw() -> None:
        while not over.wait(0.5):
            scene.draw(fakes.snapshot(5.0), fakes.status(replay=True))

    drawing = threading.Thread(target=draw)
    drawing.start()
    yield door
    over.set()
    drawing.join()
    door.stop()


def test_a_viewer_s_controls_are_still_and_an_operator_s_are_not(
    browser: Browser, door: Door, scene: Scene, orders: list[Order], build_dir: Path
) -> None:
    pages = {}
    for token in ("to watch", "to operate"):
        context = browser.new_context(viewport={"width": 1100, "height": 760})
        pages[token] = page = context.new_page()
        page.set_default_timeout(120_000)
        page.goto(door.access.address("127.0.0.1", door.access.port, token) + "&fixedDpr=1")
        page.get_by_role("button", name="Pause", exact=True).wait_for(timeout=120_000)
    watching, operating = pages.values()
    try:
        assert watching.locator("#ss-watching").inner_text() == "Watching only"
        assert operating.locator("#ss-watching").count() == 0
        watching.screenshot(path=str(build_dir / "watching.png"))
        watching.get_by_role("button", name="Pause", exact=True).dispatch_event("click")
        watching.get_by_role("button", name="Pause", exact=True).click(force=True)
        slider = watching.get_by_role("slider").nth(2)
        before = slider.get_attribute("aria-valuenow")
        slider.focus()
        for key in ("End", "ArrowRight", "c", "r", "Escape", " ", "m"):
            watching.keyboard.press(key)
        assert slider.get_attribute("aria-valuenow") == before
        watching.get_by_role("tab", name="View").click(force=True)  # to look around is free
        watching.get_by_text("Dark mode", exact=True).wait_for()
        operating.get_by_role("button", name="Pause", exact=True).dispatch_event("click")
        until(lambda: watching.evaluate("1") and orders)
        assert [type(order.command).__name__ for order in orders] == ["Pause"]
        assert door.counters.dropped_messages == {}  # its page did not even try
    finally:
        for page in pages.values():
            page.context.close()
