"""The town in a real Chromium: a wall without seams, a kiosk without a panel, tiles that come back."""

from __future__ import annotations

import io
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page

from app.door.access import Access
from app.door.front import Door
from app.motion.basics import MotionId
from app.motion.commands import Order
from app.scene.mover_page import MoverScene
from app.visit import Steer, Visit
from app.visiting import Visiting
from app.world import make_town
from tests.scene.browsers import until
from tests.scene.pages import PATIENCE_MS

pytestmark = pytest.mark.timeout(400)

TOWN = make_town()
TILE = (360, 180)
#: The town is there, its light map and the sky are finished, the state is shown, nothing is left to draw, and
#: the picture that stood before it is gone.
SETTLED = """() => {
  const nodes = window.__viserMutable?.nodeRefFromName, drawn = window.__viserTestpoints?.rendererInfo.render;
  const finished = (name) => {
    let all = 0, done = 0;
    nodes?.[name]?.traverse((o) => { if (o.material) { all++; done += o.material.userData.mover ? 1 : 0; } });
    return all > 0 && all === done;
  };
  return finished("/world/town") && finished("/world/sky") && drawn.frame > 4 &&
    document.querySelector(".mover.mv-ready") !== null && document.querySelector(".mover-loading") === null;
}"""
#: What a page says while it waits for the town.
NOTED = """window.noted = []; setInterval(() => {
  const words = document.querySelector(".ml-words")?.textContent;
  if (words && !window.noted.includes(words)) window.noted.push(words);
}, 20);"""
#: No panel lies over a foot, over the map or over words, and all of them are in the window.
CLEAR = """(size) => {
  if (innerWidth !== size[0] || innerHeight !== size[1]) return false;
  const boxes = (what) => [...document.querySelectorAll(what)].map((e) => e.getBoundingClientRect());
  const all = boxes('[data-floating-window], .mantine-Paper-root[style*="max-height: 60%"]');
  const panels = all.filter((panel) => panel.width);
  const words = boxes(".mv-foot, .mv-said, .mv-score, .mv-map");
  const apart = (a, b) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
  const inside = (a) => a.left >= 0 && a.top >= 0 && a.right <= innerWidth && a.bottom <= innerHeight;
  const clear = (a) => inside(a) && panels.every((panel) => apart(a, panel));
  return panels.length > 0 && words.length === 5 && words.every(clear);
}"""
#: What is going on, in words.
SAYS = "(words) => document.querySelector('.mv-reason').textContent === words"


class House:
    """A scene, a door, and pages."""

    def __init__(self, browser: Browser) -> None:
        self.browser, self.orders = browser, list[Order]()
        self.scene = MoverScene(self.orders.append, TOWN)
        self.door = self.open_door(0)
        self.visit = Visiting(TOWN).still(0, "")
        self.visit = replace(self.visit, heading_rad=0.35, reason="both feet march", motion=MotionId.FORWARD)
        self._beating = threading.Event()
        self._heart = threading.Thread(target=self._beat, daemon=True)
        self._heart.start()

    def _beat(self) -> None:
        """As the program does: a page that hears nothing would say STALE."""
        while not self._beating.wait(0.3):
            self.show(self.visit)

    def open_door(self, port: int) -> Door:
        scene = self.scene
        door = Door(
            Access(port=port), viser_port=scene.port, rules=scene.rules, health=dict, extra_head=scene.head
        )
        door.start()
        return door

    def show(self, visit: Visit) -> None:
        """Whatever the pace of words is, all is sent."""
        self.scene._next_hud = self.scene._next_text = 0.0
        self.scene.draw(visit)

    def open(self, query: str, size: tuple[int, int]) -> Page:
        page = self.browser.new_page(viewport={"width": size[0], "height": size[1]})
        page.set_default_timeout(PATIENCE_MS)
        page.add_init_script(NOTED)
        page.goto(f"{self.door.address}/?fixedDpr=1&{query}")
        page.wait_for_function(SETTLED, timeout=PATIENCE_MS)
        page.wait_for_function(SAYS, arg=self.visit.reason, timeout=PATIENCE_MS)
        return page

    def close(self) -> None:
        self._beating.set()
        self._heart.join()
        self.door.stop()
        self.scene.close()


@pytest.fixture(scope="module")
def house(browser: Browser) -> Iterator[House]:
    made = House(browser)
    yield made
    made.close()


def pixels(page: Page) -> np.ndarray:
    return np.asarray(
        Image.open(io.BytesIO(page.screenshot(timeout=PATIENCE_MS, animations="disabled"))).convert("RGB"),
        dtype=int,
    )


def at_rest(page: Page) -> np.ndarray:
    """The page once nothing on it moves any more: no sign is still to come, no bar to glide."""
    before, now = pixels(page), pixels(page)
    while (before != now).any():
        page.wait_for_timeout(300)
        before, now = now, pixels(page)
    return now


def test_three_tiles_are_one_wide_window(house: House, build_dir: Path) -> None:
    tiles = []
    for name in ("left", "centre", "right"):
        page = house.open(f"tile={name}", TILE)
        tiles.append(at_rest(page))
        page.close()
    wide_page = house.open("kiosk=1", (3 * TILE[0], TILE[1]))
    wide = at_rest(wide_page)
    wide_page.screenshot(path=build_dir / "mover_wall.png", timeout=PATIENCE_MS)
    wide_page.close()
    stitched = np.concatenate(tiles, axis=1)
    assert len(np.unique(wide.reshape(-1, 3), axis=0)) > 1000  # a town, not an empty window
    assert np.count_nonzero((stitched != wide).any(axis=2)) == 0


def test_a_kiosk_shows_no_panel_and_the_operator_has_one(house: House, build_dir: Path) -> None:
    kiosk = house.open("kiosk=1", (800, 450))
    kiosk.get_by_text("both feet march").first.wait_for(timeout=PATIENCE_MS)
    assert kiosk.evaluate("window.noted")  # until it was there, and no longer
    assert not kiosk.get_by_text("Next visitor").first.is_visible()
    kiosk.screenshot(path=build_dir / "mover_kiosk.png", timeout=PATIENCE_MS)
    kiosk.close()
    operator = house.open("", (1280, 760))
    for said in ("Next visitor", "yaw since the action began"):
        operator.get_by_text(said).first.wait_for(timeout=PATIENCE_MS)
    house.orders.clear()
    operator.keyboard.down("ArrowUp")
    operator.keyboard.down("ArrowRight")
    until(lambda: any(o.command == Steer("fr") for o in house.orders), 30)
    operator.keyboard.up("ArrowUp")
    operator.keyboard.up("ArrowRight")
    until(lambda: house.orders[-1].command == Steer(""), 30)
    camera = """() => {
      const c = window.__viserMutable.camera;
      return [...c.position.toArray(), ...c.quaternion.toArray()];
    }"""
    before = operator.evaluate(camera)
    operator.mouse.move(640, 500)
    operator.mouse.down()
    operator.mouse.move(800, 600, steps=3)
    operator.mouse.up()
    operator.mouse.wheel(0, 400)
    operator.wait_for_timeout(800)
    np.testing.assert_allclose(operator.evaluate(camera), before, atol=1e-9)
    for width, height in ((390, 844), (640, 800), (1000, 620), (1440, 900)):
        operator.set_viewport_size({"width": width, "height": height})
        operator.wait_for_function(CLEAR, arg=[width, height], timeout=PATIENCE_MS)
    operator.close()


def test_a_tile_that_lost_its_connection_comes_back(house: House) -> None:
    page = house.open("tile=left", TILE)
    port = house.door.access.port
    house.door.stop()
    page.wait_for_timeout(1500)
    house.door = house.open_door(port)
    said = "it has come back"
    before, house.visit = house.visit, replace(house.visit, reason=said)
    page.wait_for_function(SAYS, arg=said, timeout=PATIENCE_MS)
    house.visit = before
    page.close()
