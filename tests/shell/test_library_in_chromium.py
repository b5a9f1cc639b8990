"""The library as its user meets it: another walk, a GPS track beside it, a new name, a page to share."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from app.formats.keeping import Keeper
from app.simulate.walk import make_walk
from app.sources.timeline import Timeline
from tests.scene.pages import PATIENCE_MS, open_page
from tests.shell.test_run import Program, move_slider

GPX = "<gpx><trk><name>round the block</name><trkseg>{}</trkseg></trk></gpx>"
POINTS = ((48.0, 11.0), (48.00002, 11.0), (48.00002, 11.00003))
DRAWN = "name => window.__viserSceneTree.getState()[name] !== undefined"


def recorded() -> bytes:
    """Six seconds of two feet, as the recorder writes them."""
    recording = make_walk({"path": "square", "feet": "2", "duration_s": "6", "still_s": "1"}).recording
    keeper, timeline = Keeper({"source": "test"}, {}, 10**18), Timeline(recording)
    data = keeper.begin(0)
    for sample in timeline.cut(0, len(timeline), 0):
        keeper.sample(sample)
    return data + keeper.end()


@pytest.fixture
def program(tmp_path: Path) -> Iterator[Program]:
    shelf = tmp_path / "recordings"
    shelf.mkdir()
    (shelf / "corridor.mcap").write_bytes(recorded())
    points = "".join(f'<trkpt lat="{latitude}" lon="{longitude}"/>' for latitude, longitude in POINTS)
    (shelf / "round.gpx").write_text(GPX.format(points))
    running = Program(tmp_path, "--source", "sim:walk?path=oval&loop=1", folder=tmp_path)
    yield running
    assert running.end() == 0
    assert "Traceback" not in running.errors.read_text()


def choose(page: Page, name: str) -> None:
    page.get_by_label("From the library").first.click()
    page.get_by_role("option", name=name).click(timeout=PATIENCE_MS)


def press(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).click(timeout=PATIENCE_MS)


def says(page: Page, words: str) -> None:
    page.get_by_text(words).first.wait_for(timeout=PATIENCE_MS)


def test_a_walk_through_the_library(
    browser: Browser, program: Program, tmp_path: Path, build_dir: Path
) -> None:
    page = open_page(browser, program.address, (1100, 800), coarse=True)
    page.get_by_role("tab", name="Library").click()
    says(page, "corridor.mcap")
    choose(page, "corridor.mcap")
    press(page, "Open")
    for foot in ("/ned/left", "/ned/right"):
        page.wait_for_function(DRAWN, arg=foot, timeout=PATIENCE_MS)
    choose(page, "round.gpx")
    press(page, "Open")
    page.wait_for_function(DRAWN, arg="/ned/reference", timeout=PATIENCE_MS)
    move_slider(page, "Declination", "12.5")
    says(page, "declination +12.5°")
    page.screenshot(path=build_dir / "library.png", timeout=PATIENCE_MS)
    choose(page, "corridor.mcap")
    move_slider(page, "New name", "hall")
    press(page, "Rename")
    says(page, "hall.mcap")
    choose(page, "hall.mcap")
    press(page, "Share")
    link = page.get_by_role("link", name="hall.html")
    link.wait_for(timeout=PATIENCE_MS)
    with page.expect_download(timeout=PATIENCE_MS) as coming:
        link.click()
    shared = tmp_path / "shared.html"
    coming.value.save_as(shared)
    page.close()
    assert shared.read_bytes() == (tmp_path / "recordings" / "hall.html").read_bytes()
    assert b"<html" in shared.read_bytes()[:2000]
    assert sorted(file.name for file in (tmp_path / "recordings").iterdir()) == [
        "hall.html", "hall.mcap", "round.gpx",
    ]  # fmt: skip
