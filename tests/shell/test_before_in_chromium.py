"""A calibration by the page, on a sensor that a simulated hand turns: made, kept, used, undone."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, Page

from app.simulate.calibration import make_calibration
from tests.scene.pages import PATIENCE_MS, open_page
from tests.shell.test_run import Program

#: Eight times as fast as a hand, and around again for a page that finds the Start button late.
HAND = "speed=8&first=40&still=4&turn=1&loop=1"


@contextmanager
def before_tab(browser: Browser, tmp_path: Path, source: str) -> Iterator[Page]:
    """The tab Before of a walk's page."""
    program = Program(tmp_path, "--source", source)
    page = open_page(browser, program.address, (800, 800), coarse=True)
    try:
        page.get_by_text("Before", exact=True).first.click(timeout=PATIENCE_MS)
        yield page
    finally:
        page.close()
        assert program.end() == 0
    assert "Traceback" not in program.errors.read_text()


def press(page: Page, label: str) -> None:
    page.get_by_role("button", name=label, exact=True).click(timeout=PATIENCE_MS)


def wait(page: Page, text: str) -> None:
    page.get_by_text(text).first.wait_for(timeout=PATIENCE_MS)


def test_a_calibration_by_the_page_is_used_by_the_next_walk_and_undone_by_one_click(
    browser: Browser, tmp_path: Path, build_dir: Path
) -> None:
    with before_tab(browser, tmp_path, f"sim:calibration?seed=3&{HAND}") as page:
        wait(page, "as it comes")
        press(page, "Start")
        page.get_by_text(re.compile(r"Step \d+ of 10")).wait_for(timeout=PATIENCE_MS)
        page.get_by_role("button", name="Save and use", exact=True).evaluate("it => it.scrollIntoView()")
        page.screenshot(path=build_dir / "calibration_step.png", timeout=PATIENCE_MS)
        wait(page, "Found")
        page.screenshot(path=build_dir / "calibration_found.png", timeout=PATIENCE_MS)
        press(page, "Save and use")
        wait(page, "corrected; calibrated")
    (kept,) = (tmp_path / "config" / "stridescope" / "calibrations").glob("SIM-3-*.json")
    true = make_calibration({"seed": "3"})
    np.testing.assert_allclose(json.loads(kept.read_text())["force"]["null"], true.force.null, atol=0.005)
    with before_tab(browser, tmp_path, "sim:calibration?seed=3&rate=50&first=600") as page:
        wait(page, "corrected; calibrated")
        press(page, "Undo")
        wait(page, "its calibration is undone")
        page.screenshot(path=build_dir / "calibration_undone.png", timeout=PATIENCE_MS)
    assert not kept.exists()
    assert kept.with_suffix(".undone").exists()
