"""The page says when nothing reaches it, and comes back to the present by itself, in a real Chromium."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

import pytest
from playwright.sync_api import Browser, Page

from app.door.access import Access
from app.door.front import Door
from app.scene.beat import beat
from app.scene.page import Scene
from tests.scene import fakes
from tests.scene.browsers import until
from tests.scene.pages import PATIENCE_MS, open_page

SIGN = "() => { const sign = document.querySelector('#ss-cut-off'); return !!sign && !sign.hidden }"
AGE_S = """() => {
  const beat = document.querySelector('[data-ss-beat]');
  return beat ? Date.now() / 1000 - Number(beat.dataset.ssBeat) : 1e9;
}"""
ASLEEP_S = 7.0


@dataclass
class Walk:
    """A walk that is drawn in a thread, and can be made to stand still."""

    scene: Scene
    door: Door
    still: threading.Event = field(default_factory=threading.Event)
    over: threading.Event = field(default_factory=threading.Event)

    def draw(self) -> None:
        number = 0
        while not self.over.wait(0.05):
            if not self.still.is_set():
                number += 1
                self.scene.draw(fakes.snapshot(5.0 + 0.05 * number), fakes.status())


@pytest.fixture
def walk(scene: Scene) -> Iterator[Walk]:
    door = Door(Access(port=0), viser_port=scene.port, rules=scene.rules, health=dict, extra_head=scene.head)
    door.start()
    walk = Walk(scene, door)
    drawing = threading.Thread(target=walk.draw)
    drawing.start()
    yield walk
    walk.over.set()
    drawing.join()
    door.stop()


def processes_of(browser: Browser) -> set[int]:
    """What draws this browser's pages."""
    told = browser.new_browser_cdp_session().send("SystemInfo.getProcessInfo")
    return {process["id"] for process in told["processInfo"] if process["type"] == "renderer"}


def open_walk(browser: Browser, walk: Walk) -> Page:
    page = open_page(browser, walk.door.address, (480, 320), coarse=True)
    page.wait_for_function(f"() => ({AGE_S})() < 2", timeout=PATIENCE_MS)
    return page


def test_a_page_that_nothing_reaches_says_so_and_knocks_again(browser: Browser, walk: Walk) -> None:
    page = open_walk(browser, walk)
    try:
        assert not page.evaluate(SIGN)
        walk.still.set()
        page.wait_for_function(SIGN, timeout=PATIENCE_MS)
        assert "STALE" in page.inner_text("#ss-cut-off")
        until(lambda: page.evaluate("1") and walk.door.counters.connections_total >= 2, 60.0)
        walk.still.clear()
        page.wait_for_function(f"() => !({SIGN})() && ({AGE_S})() < 2", timeout=PATIENCE_MS)
    finally:
        page.close()


def test_after_a_sleep_the_page_shows_the_present(browser: Browser, walk: Walk) -> None:
    before = processes_of(browser)
    page = open_walk(browser, walk)
    asleep = processes_of(browser) - before
    assert asleep
    try:
        for process in asleep:
            os.kill(process, signal.SIGSTOP)
        time.sleep(ASLEEP_S)
    finally:
        for process in asleep:
            os.kill(process, signal.SIGCONT)
    try:
        page.wait_for_function(f"() => ({AGE_S})() < 2", timeout=PATIENCE_MS)
        until(lambda: page.evaluate("1") and walk.door.counters.connections_total >= 2)
        until(lambda: page.evaluate("1") and walk.door.counters.connections == 1)
    finally:
        page.close()


def test_the_beat_is_invisible_and_a_number() -> None:
    assert beat(1234.9) == '<i hidden data-ss-beat="1234"></i>'
