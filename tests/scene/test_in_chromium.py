"""The page in a real Chromium, through the real door; pictures are kept under build/."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from app.motion.commands import ApplyCandidate, Order, SetCandidate
from app.motion.snapshot import Snapshot
from app.motion.status import Status
from app.scene.page import Scene
from tests.scene import fakes
from tests.scene.browsers import until
from tests.scene.pages import PATIENCE_MS, door_to, open_page, pixels

pytestmark = pytest.mark.timeout(400)


class Shown:
    """What the drawing thread shows; set from the test."""

    def __init__(self) -> None:
        self.snapshot: Snapshot = fakes.snapshot(0.0)
        self.status: Status = fakes.status()


@contextmanager
def drawing(scene: Scene, shown: Shown) -> Iterator[None]:
    """Draw what the test says, as the shell would."""
    end = threading.Event()

    def draw() -> None:
        while not end.wait(0.05):
            scene.draw(shown.snapshot, shown.status)

    thread = threading.Thread(target=draw)
    thread.start()
    try:
        yield
    finally:
        end.set()
        thread.join()


class House:
    """A scene, what it shows, a door, and one page that all tests share: a page costs seconds."""

    def __init__(self, browser: Browser) -> None:
        self.orders: list[Order] = []
        self.scene = Scene(self.orders.append)
        self.shown = Shown()
        self._browser, self._pages, self.address = browser, list[Page](), ""

    def open(self, size: tuple[int, int] = (1280, 800), coarse: bool = False) -> Page:
        """Another browser's page."""
        self._pages.append(open_page(self._browser, self.address, size, coarse=coarse))
        return self._pages[-1]

    def close(self) -> None:
        for page in self._pages:
            page.close()
        self.scene.close()


@pytest.fixture(scope="module")
def furnished(browser: Browser) -> Iterator[tuple[House, Page]]:
    house = House(browser)
    with drawing(house.scene, house.shown), door_to(house.scene) as house.address:
        yield house, house.open()
    house.close()


@pytest.fixture
def house(furnished: tuple[House, Page]) -> House:
    """With nothing asked and a foot at the start."""
    made, _ = furnished
    made.shown.snapshot, made.shown.status = fakes.snapshot(0.0), fakes.status()
    made.scene._set_view("dark", True)
    time.sleep(0.2)
    made.orders.clear()
    return made


@pytest.fixture
def page(furnished: tuple[House, Page]) -> Page:
    return furnished[1]


def blue(page: Page) -> int:
    """How many sampled pixels have the blue shoe's colour, lit or shaded."""
    rgb = np.array(pixels(page), dtype=int)
    red, green, strong = rgb.T
    return int(((strong > 90) & (strong > 1.25 * green) & (strong > 2.2 * red)).sum())


def orange(page: Page) -> int:
    rgb = np.array(pixels(page), dtype=int)
    red, green, low = rgb.T
    return int(((red > 110) & (red > 1.15 * green) & (green > 1.6 * low)).sum())


def number_beside(page: Page, uuid: str) -> str:
    return str(page.evaluate(
        """(id) => document.getElementById(id).parentElement
             .querySelector('.mantine-NumberInput-input').value""", uuid
    ))  # fmt: skip


def wait_for_node(page: Page, name: str) -> None:
    page.wait_for_function("(n) => n in window.__viserSceneTree.getState()", arg=name, timeout=PATIENCE_MS)


PLACE = "() => window.__viserMutable.nodeRefFromName['/ned/foot'].position.toArray()"


#: Whether what the page's script does to a ribbon's material has taken hold.
WIDENED = """() => Object.entries(window.__viserMutable.nodeRefFromName).some(([name, node]) => {
    let widened = false;
    if (node && name.startsWith('/ned/trail/')) node.traverse(object => {
        widened ||= Boolean(object.geometry?.attributes._side)
            && String(object.material.onBeforeCompile).includes('ssPixel');
    });
    return widened;
})"""


def is_at(page: Page, t_s: float) -> bool:
    return np.allclose(page.evaluate(PLACE), fakes.pose(t_s)[0], atol=1e-6)


def test_the_shoe_is_drawn_and_the_trail_grows(house: House, page: Page, build_dir: Path) -> None:
    assert page.title() == "Stridescope"
    until(lambda: blue(page) > 100, 90)  # the shoe's own pixels: there is no trail yet
    points = (
        "() => window.__viserSceneTree.getState()['/ned/trail/foot/growing'].message.props.points.byteLength"
    )
    before = page.evaluate(points)
    house.shown.snapshot = fakes.snapshot(5.0)
    until(lambda: is_at(page, 5.0), 90)
    until(lambda: page.evaluate(points) > before, 90)
    page.wait_for_function(WIDENED)
    until(lambda: blue(page) > 100, 90)
    page.screenshot(path=build_dir / "scene_one_foot.png", timeout=PATIENCE_MS)


def test_two_feet_two_colours(house: House, page: Page, build_dir: Path) -> None:
    house.shown.snapshot = fakes.snapshot(0.4, two=True)
    wait_for_node(page, "/ned/right")
    until(lambda: blue(page) > 100 and orange(page) > 100, 90)
    assert "Feet not linked" in page.inner_text("body")
    page.screenshot(path=build_dir / "scene_two_feet.png", timeout=PATIENCE_MS)


#: Of each foot's card: its width, its top, and the figures that are cut off.
CARDS = """() => [...document.querySelectorAll(".ss-card.ss-left, .ss-card.ss-right")].map((e) => {
    const b = e.getBoundingClientRect();
    const cut = [...e.querySelectorAll(".ss-tile")].filter((t) => t.scrollWidth > t.clientWidth + 1);
    return [b.width, b.top, cut.map((t) => t.textContent)];
})"""


def test_on_a_phone_the_cards_are_whole_and_below_the_shoe(house: House, build_dir: Path) -> None:
    phone = house.open((390, 844), coarse=True)
    house.shown.snapshot = fakes.snapshot(0.4, two=True)
    until(lambda: len(phone.evaluate(CARDS)) == 2, 90)
    for width, top, cut in phone.evaluate(CARDS):
        assert width > 350
        assert top > 844 / 2
        assert not cut
    phone.screenshot(path=build_dir / "scene_on_a_phone.png", timeout=PATIENCE_MS)
    phone.close()


def test_a_dragged_slider_makes_a_candidate_and_another_browser_agrees(
    house: House, page: Page, build_dir: Path
) -> None:
    house.shown.snapshot = fakes.snapshot(9.7)
    gain = house.scene.panel.tuned()["gain_stance"].id
    box = page.locator(f'[id="{gain}"]').first.bounding_box()
    assert box
    page.mouse.move(box["x"] + 0.35 * box["width"], box["y"] + 5)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 5, steps=3)
    page.mouse.up()
    until(lambda: house.orders, 60)
    page.wait_for_timeout(700)
    command = house.orders[-1].command
    assert isinstance(command, SetCandidate)
    ((name, value),) = command.changes
    assert name == "gain_stance"
    assert 1.5 < float(value) < 2.1
    # The session answers with a candidate; a browser that comes only now sees the same.
    settings = fakes.snapshot(9.7).candidate_settings.with_changes({name: value})
    house.shown.snapshot = fakes.snapshot(9.7, candidate=True, candidate_settings=settings)
    late = house.open()
    for seen in (page, late):
        wait_for_node(seen, "/ned/ghost/foot")
        seen.get_by_text("k_s 1.05 → 1.6 1/s").wait_for(timeout=PATIENCE_MS)
        assert is_at(seen, 9.7)
        assert float(number_beside(seen, gain)) == pytest.approx(float(value))
    # Dropped: both sliders go back.
    house.shown.snapshot = fakes.snapshot(9.7)
    for seen in (page, late):
        until(lambda seen=seen: float(number_beside(seen, gain)) == 1.05, 60)  # type: ignore[misc]
    late.screenshot(path=build_dir / "scene_late_joiner.png", timeout=PATIENCE_MS)
    late.close()


def test_a_candidate_and_the_truth(house: House, page: Page, build_dir: Path) -> None:
    house.shown.snapshot = fakes.snapshot(2.2, candidate=True, truth=True)
    for node in ("/ned/ghost/foot", "/ned/trail/foot_ghost/growing", "/ned/trail/foot_truth/growing"):
        wait_for_node(page, node)
    page.wait_for_timeout(2000)
    page.screenshot(path=build_dir / "scene_candidate.png", timeout=PATIENCE_MS)


def test_keys_press_and_typing_does_not(house: House, page: Page) -> None:
    page.locator("canvas[data-engine]").click(position={"x": 300, "y": 100})
    page.keyboard.press("c")
    until(lambda: house.orders, 60)
    assert house.orders[0].command == ApplyCandidate()
    page.get_by_text("Source", exact=True).first.click()
    field = page.locator("input.mantine-TextInput-input").last
    field.click()
    page.keyboard.type("crb")
    page.wait_for_timeout(1000)
    assert len(house.orders) == 1
    assert field.input_value() == "crb"
    page.get_by_text("Tune", exact=True).first.click()


def test_stale_wins_the_eye_and_markup_stays_text(house: House, page: Page) -> None:
    evil = '<img src=x onerror="document.title=1">'
    house.shown.status = fakes.status(stale_s=3.2, message=evil)
    page.get_by_text(re.compile(r"^STALE [\d.]+ s$")).wait_for(timeout=PATIENCE_MS)
    assert evil in page.inner_text("body")
    assert page.title() == "Stridescope"


def test_what_the_style_sheet_speaks_of_is_marked(house: House, page: Page) -> None:
    for what in ("[data-ss-graphs] .uplot-container", "[data-ss-named] label", "[data-ss-reset] > button"):
        page.locator(what).first.wait_for(state="attached", timeout=PATIENCE_MS)
    buttons = page.locator("[data-ss-reset] > button").evaluate_all("(all) => all.map((one) => one.id)")
    assert set(buttons) <= set(house.scene.panel.resets())  # those of the open tab
    assert page.locator("[data-ss-resettable]").count() == len(buttons)


def test_graphs_have_the_data(house: House, page: Page) -> None:
    house.shown.snapshot = fakes.snapshot(31.4)
    newest = """() => Object.values(window.__viserTestpoints.uplots ?? {}).map(u => {
      const x = u.chart.data[0]; return x[x.length - 1]; })"""
    until(lambda: page.evaluate(newest) == pytest.approx([31.4] * 3), 60)


def test_a_sweep_is_a_picture_in_light_mode(house: House, page: Page, build_dir: Path) -> None:
    house.shown.snapshot = fakes.snapshot(9.7)
    house.shown.status = fakes.status(sweep=fakes.sweep())
    house.scene._set_view("dark", False)
    page.get_by_text("Gains", exact=True).first.click()
    picture = page.locator(".ss-surface svg")
    picture.wait_for(timeout=PATIENCE_MS)
    box = picture.bounding_box()
    assert box
    assert box["width"] > 300
    page.wait_for_timeout(1500)
    page.screenshot(path=build_dir / "scene_sweep_light.png", timeout=PATIENCE_MS)
