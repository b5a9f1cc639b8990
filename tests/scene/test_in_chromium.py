"""The page in a real Chromium, through the real door; pictures are kept under build/."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from app.motion import ApplyCandidate, Order, SetCandidate, Snapshot, Status
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
def drawing(scene: Scene) -> Iterator[Shown]:
    """Draw what the test says, as the shell would."""
    shown, end = Shown(), threading.Event()

    def draw() -> None:
        while not end.wait(0.05):
            scene.draw(shown.snapshot, shown.status)

    thread = threading.Thread(target=draw)
    thread.start()
    try:
        yield shown
    finally:
        end.set()
        thread.join()


@pytest.fixture
def shown(scene: Scene) -> Iterator[Shown]:
    with drawing(scene) as what:
        yield what


@pytest.fixture
def visit(scene: Scene, shown: Shown, browser: Browser) -> Iterator[Callable[..., Page]]:
    """Opens pages through a door and closes them."""
    pages: list[Page] = []
    with door_to(scene) as address:

        def go(**how: Any) -> Page:
            pages.append(open_page(browser, address, **how))
            return pages[-1]

        yield go
        for page in pages:
            page.close()


def blue(page: Page) -> int:
    """How many sampled pixels have the blue shoe's colour, lit or shaded."""
    rgb = np.array(pixels(page), dtype=int)
    red, green, strong = rgb.T
    return int(((strong > 90) & (strong > 1.25 * green) & (strong > 2.2 * red)).sum())


def orange(page: Page) -> int:
    rgb = np.array(pixels(page), dtype=int)
    red, green, low = rgb.T
    return int(((red > 110) & (red > 1.15 * green) & (green > 1.6 * low)).sum())


def slider(page: Page, uuid: str) -> Any:
    return page.locator(f'[id="{uuid}"]').first


def number_beside(page: Page, uuid: str) -> str:
    return str(page.evaluate(
        """(id) => document.getElementById(id).parentElement.querySelector('.mantine-NumberInput-input').value""", uuid
    ))  # fmt: skip


def test_the_shoe_is_drawn_and_the_trail_grows(visit: Callable[..., Page], shown: Shown, build_dir: Path) -> None:
    shown.snapshot = fakes.snapshot(0.0)
    page = visit()
    assert page.title() == "Stridescope"
    until(lambda: blue(page) > 100, 60)  # the shoe's own pixels: there is no trail yet
    points = "() => window.__viserSceneTree.getState()['/ned/trail/foot/growing'].message.props.points.byteLength"
    before = page.evaluate(points)
    shown.snapshot = fakes.snapshot(5.0)
    page.wait_for_function(f"(before) => ({points})() > before", arg=before, timeout=PATIENCE_MS)
    place = "() => window.__viserMutable.nodeRefFromName['/ned/foot'].position.toArray()"
    page.wait_for_function(f"() => ({place})()[0] > 4", timeout=PATIENCE_MS)
    assert np.allclose(page.evaluate(place), fakes.pose(5.0)[0], atol=1e-6)
    page.wait_for_timeout(3000)
    until(lambda: blue(page) > 100, 60)
    page.screenshot(path=build_dir / "scene_one_foot.png", timeout=PATIENCE_MS)


def test_two_feet_two_colours(visit: Callable[..., Page], shown: Shown, build_dir: Path) -> None:
    shown.snapshot = fakes.snapshot(0.4, two=True)
    page = visit(size=(1920, 1080), node="/ned/right")
    until(lambda: blue(page) > 100 and orange(page) > 100, 60)
    assert "Feet not linked" in page.inner_text("body")
    page.screenshot(path=build_dir / "scene_two_feet.png", timeout=PATIENCE_MS)


def test_a_dragged_slider_makes_a_candidate_and_the_other_browser_agrees(
    visit: Callable[..., Page], shown: Shown, scene: Scene, orders: list[Order], build_dir: Path
) -> None:
    shown.snapshot = fakes.snapshot(9.7)
    one, two = visit(), visit()
    gain = scene.panel.tuned()["gain_stance"].id
    box = slider(one, gain).bounding_box()
    assert box
    one.mouse.move(box["x"] + 0.35 * box["width"], box["y"] + 5)
    one.mouse.down()
    one.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 5, steps=3)
    one.mouse.up()
    until(lambda: orders)
    one.wait_for_timeout(500)
    command = orders[-1].command
    assert isinstance(command, SetCandidate)
    ((name, value),) = command.changes
    assert name == "gain_stance"
    assert 1.5 < float(value) < 2.1
    # The session answers with a candidate: both browsers show its ghost and its value.
    shown.snapshot = fakes.snapshot(
        9.7, candidate=True, candidate_settings=shown.snapshot.candidate_settings.with_changes({name: value})
    )
    for page in (one, two):
        page.wait_for_function(
            "() => '/ned/ghost/foot' in window.__viserSceneTree.getState()", timeout=PATIENCE_MS
        )  # fmt: skip
        page.get_by_text("Candidate", exact=True).wait_for(timeout=PATIENCE_MS)
        until(lambda page=page: float(number_beside(page, gain)) == pytest.approx(float(value)))  # type: ignore[misc]
    two.wait_for_timeout(3000)
    two.screenshot(path=build_dir / "scene_candidate.png", timeout=PATIENCE_MS)


def test_keys_press_and_typing_does_not(visit: Callable[..., Page], shown: Shown, orders: list[Order]) -> None:
    shown.snapshot = fakes.snapshot(3.0, candidate=True)
    page = visit()
    page.keyboard.press("c")
    until(lambda: orders)
    assert orders[0].command == ApplyCandidate()
    page.get_by_text("Source", exact=True).first.click()
    field = page.locator("input.mantine-TextInput-input").last
    field.click()
    page.keyboard.type("crb")
    page.wait_for_timeout(1000)
    assert len(orders) == 1
    assert field.input_value() == "crb"


def test_stale_wins_the_eye_and_markup_stays_text(visit: Callable[..., Page], shown: Shown, build_dir: Path) -> None:
    evil = '<img src=x onerror="document.title=1">'
    page = visit()
    shown.status = fakes.status(stale_s=3.2, message=evil)
    page.get_by_text("STALE").wait_for(timeout=PATIENCE_MS)
    assert evil in page.inner_text("body")
    assert page.title() == "Stridescope"


def test_a_sweep_is_a_picture_in_light_mode(
    visit: Callable[..., Page], shown: Shown, scene: Scene, build_dir: Path
) -> None:
    shown.snapshot = fakes.snapshot(9.7)
    shown.status = fakes.status(sweep=fakes.sweep())
    scene._set_view("dark", False)
    page = visit()
    page.get_by_text("Gains", exact=True).first.click()
    picture = page.locator(".ss-surface svg")
    picture.wait_for(timeout=PATIENCE_MS)
    box = picture.bounding_box()
    assert box
    assert box["width"] > 300
    page.wait_for_timeout(1500)
    page.screenshot(path=build_dir / "scene_sweep_light.png", timeout=PATIENCE_MS)


def test_graphs_have_the_data(visit: Callable[..., Page], shown: Shown) -> None:
    shown.snapshot = fakes.snapshot(31.4)
    page = visit()
    page.wait_for_selector(".uplot canvas", timeout=PATIENCE_MS)
    newest = """() => Object.values(window.__viserTestpoints.uplots).map(u => {
      const x = u.chart.data[0]; return x[x.length - 1]; })"""
    until(lambda: all(abs(t - 31.4) < 1e-6 for t in page.evaluate(newest)) and len(page.evaluate(newest)) == 3)


def test_a_late_joiner_sees_the_present(visit: Callable[..., Page], shown: Shown) -> None:
    shown.snapshot = fakes.snapshot(31.4)
    time.sleep(1.0)
    page = visit()
    place = "() => window.__viserMutable.nodeRefFromName['/ned/foot'].position.toArray()"
    until(lambda: np.allclose(page.evaluate(place), fakes.pose(31.4)[0], atol=1e-6))
    pieces = "() => Object.keys(window.__viserSceneTree.getState()).filter(n => n.includes('/piece_')).length"
    assert page.evaluate(pieces) == len(shown.snapshot.main.feet[0].trail.pieces)
