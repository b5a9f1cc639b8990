"""Tool: starts the program on its built-in recording, opens the real page and saves docs/page.png.

Run ``python tools/take_picture.py [PATH]`` after a change of the page; needs a Chromium (CHROMIUM_PATH).
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
from pathlib import Path

from playwright.sync_api import Error, Page, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
PATH = ROOT / "docs" / "page.png"
ARGUMENTS = [
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-sync",
]
DRAWN = "() => window.__viserTestpoints?.rendererInfo.render.triangles > 0"
PATIENCE_MS = 120_000


def free_port() -> int:
    """A port nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def main(path: Path) -> None:
    """Walk for half a minute, move a slider, look."""
    port = free_port()
    command = [sys.executable, "-m", "app", "walk", "--no-open", "--port", str(port)]
    program = subprocess.Popen(command, cwd=ROOT)
    browser_path = (
        os.environ.get("CHROMIUM_PATH") or shutil.which("chromium") or shutil.which("google-chrome")
    )
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=browser_path, args=ARGUMENTS)
            page = browser.new_page(viewport={"width": 1440, "height": 900})
            wait_for(page, f"http://127.0.0.1:{port}/?fixedDpr=1")
            page.wait_for_function(DRAWN, timeout=PATIENCE_MS)
            page.add_style_tag(content=".mantine-Notifications-root{display:none!important}")
            page.wait_for_function(
                "() => /Strides\\s+1[4-9]/.test(document.body.innerText)", timeout=PATIENCE_MS
            )
            label = page.get_by_text(re.compile("Sensor height")).first
            field = label.locator("xpath=ancestor::*[.//input][1]").locator("input").last
            field.fill("0.04")
            field.press("Enter")
            page.wait_for_timeout(6000)
            page.screenshot(path=str(path))
            browser.close()
    finally:
        program.send_signal(signal.SIGINT)
        program.wait(timeout=30)


def wait_for(page: Page, address: str) -> None:
    """Open the page as soon as somebody listens."""
    for _ in range(100):
        try:
            page.goto(address)
            return
        except Error:
            page.wait_for_timeout(300)
    raise SystemExit(f"{address}: nobody answered")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else PATH)
