"""Text from files, devices and people stays text: in every place the page has for it, in a real Chromium."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from app.motion.estimate import Trust
from app.motion.health import Light, Recent
from app.motion.snapshot import TrailPiece
from app.motion.status import RecorderState, ShelfFile
from app.scene.page import Scene
from app.settings import Settings
from tests.scene import fakes
from tests.scene.pages import PATIENCE_MS, door_to

EVIL = (
    "<img src=x onerror=window.ran=1><script>window.ran=2</script><b onclick=window.ran=3>b</b></style></div>"
    "\"'&lt;i&gt;`${1}` [l](javascript:ran=4) ![m](x) **s** $x^2$ {{7*7}}"
)
UNPRINTABLE = "\u202e\x00\n\ud800"
#: Words of our own, by which a style or a control is found.
OURS = {("Trust", "word"), ("TrackView", "name"), ("Snapshot", "slots"), ("Snapshot", "slot_now")}
#: Names that were looked at when they were read: a file's and a profile's are printable.
NAMES = {("ShelfFile", "name"), ("Status", "profiles")}
MARKUP = """() => Array.from(document.querySelectorAll(
    'img[src="x"], img[src$="/x"], [onerror], [onclick], a[href^="javascript"], script:not([src])'
  )).filter(one => !one.nonce && one.type !== 'module').map(one => one.outerHTML.slice(0, 200))"""


def evil(thing: Any, field: tuple[str, str] = ("", "")) -> Any:
    """The same with markup after every text that is not a word of ours."""
    if field in OURS or thing is None or isinstance(thing, Enum | Settings | TrailPiece):
        return thing
    if isinstance(thing, str):
        return thing + EVIL + ("" if field in NAMES else UNPRINTABLE)
    if isinstance(thing, Mapping):
        return {evil(key): evil(value) for key, value in thing.items()}
    if type(thing) is tuple:
        return tuple(evil(one, field) for one in thing)
    name = type(thing).__name__
    if is_dataclass(thing) and not isinstance(thing, type):
        return replace(thing, **{f.name: evil(getattr(thing, f.name), (name, f.name)) for f in fields(thing)})
    if hasattr(thing, "_fields"):
        return thing._replace(**{key: evil(getattr(thing, key), (name, key)) for key in thing._fields})
    return thing


@pytest.fixture
def page(browser: Browser, scene: Scene) -> Iterator[Page]:
    """A page on which everything that can be said is said in markup."""
    shot = fakes.snapshot(12.0, two=True, candidate=True, truth=True)
    recent = Recent(100.0, 1000, 3, 0, 0, 0, None, None, None, None, None, None, 0.0)
    health = {
        sensor: one._replace(recent=recent, light=Light.RED, reason="lost packets")
        for sensor, one in shot.health.items()
    }
    feet = tuple(foot._replace(trust=Trust(0.1, 0.1, 0.0, "lost", "why")) for foot in shot.main.feet)
    shot = evil(replace(shot, health=health, main=shot.main._replace(feet=feet)))
    status = evil(
        fakes.status(
            message="message", detail="detail", sweep=None,
            recording=RecorderState("walk.mcap", False, 3.0, 1000, 10**9, "trouble"),
            shelf=(ShelfFile("walk.mcap", 1000, "today"),),
        )
    )  # fmt: skip
    over = threading.Event()

    def draw() -> None:
        while not over.wait(0.5):
            scene.draw(shot, status)

    drawing = threading.Thread(target=draw)
    drawing.start()
    with door_to(scene) as address:
        opened = browser.new_context(viewport={"width": 560, "height": 400}).new_page()
        opened.set_default_timeout(PATIENCE_MS)
        opened.goto(f"{address}?fixedDpr=1")
        opened.get_by_text("x-io NGIMU CSV").or_(opened.get_by_text("detail")).first.wait_for(
            timeout=PATIENCE_MS
        )
        yield opened
        opened.context.close()
    over.set()
    drawing.join()


def test_no_text_becomes_markup(page: Page, build_dir: Path) -> None:
    seen = ""
    for tab in page.get_by_role("tab").all():
        tab.click(force=True)
        page.wait_for_timeout(1000)
        seen += page.inner_text("body")
        assert page.evaluate(MARKUP) == []
        for element in page.get_by_text("onerror").all():
            element.dispatch_event("click")
    page.screenshot(path=str(build_dir / "markup.png"))
    assert page.evaluate("window.ran") is None
    for word in ("short_walk.csv", "message", "detail", "trouble", "walk.mcap", "lost packets"):
        assert f"{word}<img src=x" in seen, f"{word} is not shown as it was written"
