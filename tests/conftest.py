"""What many tests share: the measured walks, a real Chromium, a place for pictures."""

from __future__ import annotations

import asyncio
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest
from playwright.sync_api import Browser, sync_playwright

ROOT = Path(__file__).parent.parent
MAC_CHROMIUMS = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
)
CHROMIUM_ARGUMENTS = [
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]

#: A test machine draws in software, perhaps beside other work: a hang is what takes longer than this.
BROWSER_TIMEOUT_S = 400
#: And a page may need so long for one thing.
PATIENCE_MS = 120_000

# The same examples on every run, so that a red test is a change's fault and not luck's;
# HYPOTHESIS_PROFILE=search looks for new ones.
hypothesis.settings.register_profile("same", deadline=None, derandomize=True, max_examples=60)
hypothesis.settings.register_profile("search", deadline=None, max_examples=1000)
hypothesis.settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))


def chromium_path() -> str | None:
    """The Chromium to drive, by tools/chromium.sh's order; None where there is none."""
    if "CHROMIUM_PATH" in os.environ:
        return os.environ["CHROMIUM_PATH"]
    found = map(shutil.which, ("chromium", "chromium-browser", "google-chrome", *MAC_CHROMIUMS))
    return next((path for path in found if path), None)


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of measured walks beside the checkout; skips where it is absent."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("needs the measured walks in ../shared/data")
    return folder


@pytest.fixture(scope="session")
def build_dir() -> Path:
    """Where tests leave pictures for a person to look at."""
    folder = ROOT / "build"
    folder.mkdir(exist_ok=True)
    return folder


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One real Chromium for the whole run: ask it for a new context in each test."""
    if os.environ.get("CHROMIUM") == "skip":
        pytest.skip("CHROMIUM=skip")
    path = chromium_path()
    assert path, "no Chromium found: make test says what to install; CHROMIUM=skip leaves these tests out"
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, args=CHROMIUM_ARGUMENTS)
        yield chromium
        chromium.close()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what drives a browser, so that ``-m "not browser"`` leaves it out."""
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.browser)
            item.add_marker(pytest.mark.timeout(BROWSER_TIMEOUT_S))


@pytest.fixture(autouse=True)
def no_running_loop(request: pytest.FixtureRequest) -> Iterator[None]:
    """Lets a test without a browser call ``asyncio.run`` while Playwright's own loop is suspended.

    Playwright's sync face leaves its loop marked as running in this thread between its calls, and
    needs that mark at its next one. A test with a browser runs its server in a thread or a process.
    """
    marked = None if "browser" in request.fixturenames else asyncio._get_running_loop()
    if marked is not None:
        asyncio._set_running_loop(None)
    yield
    if marked is not None:
        asyncio._set_running_loop(marked)
