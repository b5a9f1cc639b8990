"""The shared page: everything is in the file, no network is asked, and it shows phase and figures."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.motion.basics import InputError
from app.scene.share import told
from app.settings import Settings
from app.shell.film import share
from tests.scene.fakes import snapshot
from tests.scene.pages import DRAWN, PATIENCE_MS

WALK = "sim:walk?path=straight&feet=2&duration_s=4&still_s=1"


@pytest.fixture(scope="module")
def page_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return share(WALK, Settings(), tmp_path_factory.mktemp("shared") / "walk.html")


def test_it_plays_from_a_file_without_a_network(page_file: Path, browser: Browser, build_dir: Path) -> None:
    context = browser.new_context(offline=True, viewport={"width": 480, "height": 320})
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    asked: list[str] = []
    page.on("request", lambda r: asked.append(r.url) if r.url.startswith(("http", "ws")) else None)
    page.goto(page_file.as_uri())
    for node in ("/ned/left", "/ned/right", "/ned/figures/left", "/ned/figures/title"):
        page.wait_for_function(DRAWN, arg=node, timeout=PATIENCE_MS, polling=500)
    page.screenshot(path=build_dir / "shared.png", timeout=PATIENCE_MS)
    context.close()
    assert asked == []


def test_a_page_that_exists_is_not_overwritten(page_file: Path) -> None:
    with pytest.raises(InputError, match="exists"):
        share(WALK, Settings(), page_file)


def test_the_label_says_phase_and_figures() -> None:
    text = told(snapshot(5.3).main.feet[0])
    assert ("STANCE" in text) or ("SWING" in text)
    assert "strides" in text
    assert "m/s" in text
