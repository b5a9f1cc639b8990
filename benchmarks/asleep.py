"""Benchmarks: a real page stopped for minutes, as by a sleeping laptop: until it shows the present."""

from __future__ import annotations

import os
import signal
import time

from playwright.sync_api import Browser, Page, sync_playwright

from benchmarks.figures import Figure, Section
from benchmarks.page import ARGUMENTS, chromium_path
from benchmarks.processes import first_line, free_port, running
from benchmarks.start import wait_for_samples

WALK = "sim:walk?path=eight&rate_hz=100&noise=1&duration_s=7200"
ROUNDS_S = (8.0, 30.0)
BEAT = "() => Number((document.querySelector('[data-ss-beat]') || {dataset: {}}).dataset.ssBeat || 0)"
#: Counts what reaches the page, and when.
COUNT = """() => {
  window.batches = [];
  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (message, ...rest) {
    if (message && message.type === 'set_server')
      this.addEventListener('message', e => e.data.type === 'message_batch' && batches.push(Date.now()));
    return post.call(this, message, ...rest);
  };
}"""


def asleep(clock_s: float) -> Section:
    """Seconds until a page that was stopped shows a second no older than its waking."""
    path = chromium_path()
    if path is None:
        yield Figure("a page that slept", None, note="no Chromium")
        return
    port = free_port()
    with running("app", "walk", "--source", WALK, "--no-open", "--port", str(port)) as viewer:
        first_line(viewer)
        wait_for_samples(port, 100)
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=path, args=list(ARGUMENTS))
            yield from sleeps(browser, port, (*ROUNDS_S, clock_s))
            browser.close()


def sleeps(browser: Browser, port: int, lengths_s: tuple[float, ...]) -> Section:
    """Each length once, in one page."""
    before = renderers(browser)
    page = browser.new_page(viewport={"width": 480, "height": 320})
    page.add_init_script(f"({COUNT})()")
    page.goto(f"http://127.0.0.1:{port}/?fixedDpr=1")
    until_present(page, time.time(), 120.0)
    mine = renderers(browser) - before
    for length_s in lengths_s:
        time.sleep(5.0)
        usual = batches_since(page, time.time() - 2.0) / 2.0
        woke = stop_for(mine, length_s)
        waited = until_present(page, woke, 30.0)
        time.sleep(1.0)
        burst = batches_since(page, woke) - batches_since(page, woke + 1.0)
        note = f"{burst} messages in its first second, {usual:.0f} in a usual one"
        yield Figure(f"asleep for {length_s:.0f} s: until it shows the present", waited, "s", 1.0, note=note)


def renderers(browser: Browser) -> set[int]:
    """The processes that run this browser's pages."""
    told = browser.new_browser_cdp_session().send("SystemInfo.getProcessInfo")
    return {process["id"] for process in told["processInfo"] if process["type"] == "renderer"}


def stop_for(processes: set[int], seconds: float) -> float:
    """Stop them, wait, let them go on; the time when they do."""
    for process in processes:
        os.kill(process, signal.SIGSTOP)
    try:
        time.sleep(seconds)
    finally:
        woke = time.time()
        for process in processes:
            os.kill(process, signal.SIGCONT)
    return woke


def until_present(page: Page, since: float, patience_s: float) -> float:
    """Seconds from ``since`` until the page shows the second in which that was, or a later one."""
    while (now := time.time()) < since + patience_s:
        if page.evaluate(BEAT) >= int(since):
            return time.time() - since
        time.sleep(0.02)
    return now - since


def batches_since(page: Page, since: float) -> int:
    """Messages that reached the page."""
    return int(page.evaluate("since => batches.filter(at => at >= since).length", 1e3 * since))
