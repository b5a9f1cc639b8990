"""Tool: starts the town, lets simulated feet walk to the first target and saves docs/mover.png.

Run ``python tools/take_town_picture.py [PATH]`` after a change of the town; needs a Chromium (CHROMIUM_PATH).
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

from tools.take_picture import ARGUMENTS, PATIENCE_MS, ROOT, free_port, wait_for

PATH = ROOT / "docs" / "mover.png"
LIGHT = """() => { let done = 0; window.__viserMutable?.nodeRefFromName?.["/world/goal"]?.traverse(
  (o) => { done += o.material?.userData.mover ? 1 : 0; }); return done === 4; }"""
NEAR = "() => parseInt(document.querySelector('.mv-metres')?.textContent ?? '99') < 11"


def main(path: Path) -> None:
    """Walk until the light is near, look."""
    port = free_port()
    command = [sys.executable, "-m", "app", "mover", "--no-open", "--kiosk", "--port", str(port)]
    program = subprocess.Popen(command, cwd=ROOT)
    browser_path = os.environ.get("CHROMIUM_PATH") or shutil.which("chromium")
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=browser_path, args=ARGUMENTS)
            page = browser.new_page(viewport={"width": 1280, "height": 720})
            wait_for(page, f"http://127.0.0.1:{port}/?fixedDpr=1")
            page.wait_for_selector(".mover.mv-ready", timeout=PATIENCE_MS)
            page.wait_for_function(LIGHT, timeout=PATIENCE_MS)
            page.wait_for_timeout(3000)
            page.wait_for_function(NEAR, timeout=PATIENCE_MS)
            page.screenshot(path=str(path), timeout=PATIENCE_MS)
            browser.close()
    finally:
        program.send_signal(signal.SIGINT)
        program.wait(timeout=30)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else PATH)
