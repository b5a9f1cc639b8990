"""Benchmarks: from a sample to a websocket client, and to three.js in Chromium beside a bare viser loop."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright

from benchmarks import latency
from benchmarks.client import Client
from benchmarks.figures import Figure, Section
from benchmarks.latency import Arrival, Latency
from benchmarks.processes import first_line, free_port, running
from benchmarks.start import wait_for_samples

#: Noise makes every sample's pose its own.
WALK = "sim:walk?path=oval&rate_hz=100&duration_s=600&noise=1"
NODE = "/ned/foot"
SECONDS, ROUNDS = 12.0, 2
SIZE = (640, 400)
ARGUMENTS = ("--no-sandbox", "--enable-unsafe-swiftshader", "--disable-gpu-sandbox", "--no-first-run")
READY_MS = 60_000

READY = """(node) => window.__viserMutable?.nodeRefFromName?.[node] != null
  && window.__viserTestpoints?.rendererInfo.render.frame > 2"""
WATCH = """(node) => {
  window.seen = [];
  let last = [];
  const look = () => {
    const at = performance.timeOrigin + performance.now(), o = window.__viserMutable.nodeRefFromName[node];
    if (o) {
      const p = o.position, q = o.quaternion, pose = [p.x, p.y, p.z, q.w, q.x, q.y, q.z];
      if (pose.some((x, i) => x !== last[i])) { window.seen.push([at, ...pose]); last = pose; }
    }
    requestAnimationFrame(look);
  };
  look();
}"""
NOW = "() => performance.timeOrigin + performance.now()"


def page() -> Section:
    """One client at a time; the viewer and the bare loop in turns."""
    yield from to_websocket()
    path = chromium_path()
    if os.environ.get("CHROMIUM") == "skip" or path is None:
        yield Figure("sample → three.js", None, note="no Chromium")
        return
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(ARGUMENTS))
        yield from to_three(browser)
        browser.close()


def to_websocket() -> Section:
    """From the release of the sample that a frame shows to the frame's arrival."""
    note = "100 Hz, the shown samples; through the door"
    shown, drawn_ms = through_viewer(read_websocket)
    yield Figure("sample → websocket client, p95", shown.percentile(95), "ms", 10.0, note=note)
    yield Figure("  p50", shown.percentile(50), "ms")
    yield Figure("  of it until the frame is begun, p95", float(np.percentile(drawn_ms, 95)), "ms")
    yield Figure("  frames a second", shown.frames_hz, "", note=f"{shown.unknown} poses were no sample's")
    bare = through_bare(read_websocket)
    yield Figure("bare viser: set → websocket client, p95", bare.percentile(95), "ms", note="the same door")


def to_three(browser: Browser) -> Section:
    """The same until three.js has the pose, seen at every animation frame."""
    ours, bare, shoe = [], [], []
    for _ in range(ROUNDS):
        bare.append(through_bare(lambda port: read_page(browser, port)))
        ours.append(through_viewer(lambda port: read_page(browser, port))[0])
        shoe.append(through_bare(lambda port: read_page(browser, port), "--shoe"))
    p95 = [float(np.percentile(np.concatenate([one.ms for one in all_]), 95)) for all_ in (ours, bare, shoe)]
    yield Figure("sample → three.js, p95", p95[0], "ms", 1.25 * p95[1], note="wanted: 1.25 × the bare loop's")
    yield Figure("  beside the bare loop with our shoe and ground", p95[0] / p95[2], "×")
    for what, all_, at95 in (
        ("viewer", ours, p95[0]),
        ("bare loop", bare, p95[1]),
        ("bare + shoe", shoe, p95[2]),
    ):
        ms = np.concatenate([one.ms for one in all_])
        rate = np.mean([one.frames_hz for one in all_])
        note = f"p50 {np.percentile(ms, 50):.1f} ms, {rate:.0f} poses a second, software rendering"
        yield Figure(f"  {what}: p95", at95, "ms", note=note)


def through_viewer(read: Callable[[int], list[Arrival]]) -> tuple[Latency, np.ndarray]:
    """The walk viewer seen by ``read``; also each frame's age of its newest sample when it was begun."""
    with tempfile.TemporaryDirectory() as folder:
        port, times = free_port(), Path(folder) / "times.npz"
        with running("benchmarks.stopwatch", WALK, str(port), "--samples", str(times)) as viewer:
            first_line(viewer)
            wait_for_samples(port, 300)
            arrivals = read(port)
        return latency.latency(arrivals, latency.released(times)), ages_ms(times)


def ages_ms(times: Path) -> np.ndarray:
    """How old the newest sample was when each frame was begun, where there was a new one."""
    table = np.load(times)
    stamps, begun = table["samples"][:, 0], table["drawn"][:, 0]
    newest = np.searchsorted(stamps, begun) - 1
    fresh = np.flatnonzero(np.diff(newest) > 0) + 1
    return (begun[fresh] - stamps[newest[fresh]]) * 1e-6


def through_bare(read: Callable[[int], list[Arrival]], *options: str) -> Latency:
    """The bare loop seen by ``read``."""
    with tempfile.TemporaryDirectory() as folder:
        port, times = free_port(), Path(folder) / "times.npz"
        with running("benchmarks.bare", str(port), str(times), *options) as loop:
            first_line(loop)
            arrivals = read(port)
        return latency.latency(arrivals, latency.released(times))


def read_websocket(port: int) -> list[Arrival]:
    """Poses as they come to a client; the first second, what was there before, is left out."""
    client = Client(port)
    list(client.frames(1.0))
    frames = list(client.frames(SECONDS))
    client.close()
    return latency.poses(frames, NODE)


def read_page(browser: Browser, port: int, node: str = NODE, settle_s: float = 2.0) -> list[Arrival]:
    """Poses of a node as three.js has them, in the monotonic clock's nanoseconds."""
    tab = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]})
    try:
        offset_ns = clock_offset_ns(tab)
        tab.goto(f"http://127.0.0.1:{port}/?fixedDpr=1")
        tab.wait_for_function(READY, arg=node, timeout=READY_MS)
        tab.wait_for_timeout(1000 * settle_s)
        tab.evaluate(WATCH, node)
        tab.wait_for_timeout(1000 * SECONDS)
        return [(1e6 * at + offset_ns, latency.key(pose)) for at, *pose in tab.evaluate("() => window.seen")]
    finally:
        tab.close()


def clock_offset_ns(tab: Page) -> float:
    """What to add to the browser's clock, asked of an empty page: the question with the quickest answer."""
    best = (float("inf"), 0.0)
    for _ in range(40):
        before_ns = time.monotonic_ns()
        page_ns = 1e6 * tab.evaluate(NOW)
        after_ns = time.monotonic_ns()
        best = min(best, (after_ns - before_ns, (before_ns + after_ns) / 2 - page_ns))
    return best[1]


def chromium_path() -> str | None:
    """The Chromium to drive."""
    named = os.environ.get("CHROMIUM_PATH")
    found = map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))
    return named or next((path for path in found if path), None)
