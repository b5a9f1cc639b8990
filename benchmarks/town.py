"""Benchmarks: from a decision in the town to a websocket client and to three.js, beside bare viser loops."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
from playwright.sync_api import Browser, sync_playwright

from benchmarks import latency
from benchmarks.client import Client, health
from benchmarks.figures import Figure, Section
from benchmarks.latency import Arrival, Latency
from benchmarks.page import ARGUMENTS, chromium_path, read_page, through_bare
from benchmarks.processes import first_line, free_port, running

SECONDS, ROUNDS = 12.0, 2
NODE = "/world"
#: Feet whose samples come by themselves, as sensors' do, and often ask for something else.
SCRIPT = "sim:gestures?script=none:1,forward:2,turn_cw:2,forward:2,turn_ccw:2,backward:2&loop=1"
LOAD_S = 10.0
Read = Callable[[int], list[Arrival]]


class Walk(NamedTuple):
    """What a client saw of the town, the poses meanwhile [n, 7], and how long new decisions waited, ms."""

    seen: Latency
    poses: np.ndarray
    waits_ms: np.ndarray


def town() -> Section:
    """Ours and the bare loop in turns, the better of two each: another load is nobody's fault."""
    ours, bare = [], []
    with poses_file() as file:
        for _ in range(ROUNDS):
            walk = through_town(read_websocket)
            np.savez(file, poses=walk.poses)
            ours.append(walk)
            bare.append(through_bare(read_websocket, "--walk", str(file)))
        yield from websocket_figures(ours, bare)
        yield from news_figures(through_town(read_websocket, "--source", SCRIPT))
        if path := chromium_path():
            with sync_playwright() as playwright:
                browser = playwright.chromium.launch(executable_path=path, args=list(ARGUMENTS))
                yield from page_figures(browser, file)
                browser.close()


def websocket_figures(ours: list[Walk], bare: list[Latency]) -> Section:
    """Until a client has it."""
    our, their = min((one.seen for one in ours), key=p95), min(bare, key=p95)
    note = f"wanted: 1.25 × the bare loop's; {p95(our) / p95(their):.2f} ×"
    yield Figure("town: decision → websocket client, p95", p95(our), "ms", 1.25 * p95(their), note=note)
    yield Figure("  p50", our.percentile(50), "ms")
    yield Figure("  poses a second", our.frames_hz, "", note=f"{our.unknown} poses were no frame's")
    note = "the same poses, pace, door and client; empty scene"
    yield Figure("bare viser: set → websocket client, p95", p95(their), "ms", note=note)
    yield Figure("  p50", their.percentile(50), "ms")


def news_figures(walk: Walk) -> Section:
    """Feet that come as samples: when they ask for something else, a frame is begun at once."""
    waits = walk.waits_ms
    yield Figure("town: a sensor's new decision → its frame, p95", float(np.percentile(waits, 95)), "ms",
                 note=f"{len(waits)} decisions; a frame has 16.7 ms")  # fmt: skip
    yield Figure("  its pose → websocket client, p95", p95(walk.seen), "ms")


def page_figures(browser: Browser, file: Path) -> Section:
    """Until three.js has it: our page, the same town and poses moved by a bare loop, and an empty scene."""

    def read(port: int) -> list[Arrival]:
        return read_page(browser, port, NODE, LOAD_S)

    ours, same, empty = [], [], []
    for _ in range(ROUNDS):
        walk = through_town(read)
        np.savez(file, poses=walk.poses)
        ours.append(walk.seen)
        same.append(through_bare(read, "--walk", str(file), "--town"))
        empty.append(through_bare(read, "--walk", str(file)))
    our, their, none = (min(each, key=p95) for each in (ours, same, empty))
    note = f"wanted: 1.25 × a bare loop's with the same town; {p95(our) / p95(their):.2f} ×"
    yield Figure("town: decision → three.js, p95", p95(our), "ms", 1.25 * p95(their), note=note)
    for what, one in (("town", our), ("bare loop, same town and poses", their), ("bare loop, empty", none)):
        note = f"p50 {one.percentile(50):.1f} ms, {one.frames_hz:.0f} poses a second, in software"
        yield Figure(f"  {what}: p95", p95(one), "ms", note=note)


def p95(one: Latency) -> float:
    """The latency that 95 of 100 shown poses stay below, ms."""
    return one.percentile(95)


@contextmanager
def poses_file() -> Iterator[Path]:
    """Where the bare loop finds the poses that it shall move by."""
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder) / "poses.npz"


def through_town(read: Read, *options: str) -> Walk:
    """The town walked by simulated feet."""
    with tempfile.TemporaryDirectory() as folder:
        port, times = free_port(), Path(folder) / "times.npz"
        with running("benchmarks.walked_town", str(port), str(times), *options) as program:
            first_line(program)
            end = time.monotonic() + 120.0
            while health(port).get("motion") in (None, "none") and time.monotonic() < end:
                time.sleep(0.2)
            arrivals = read(port)
        table = np.load(times)
        return Walk(
            latency.latency(arrivals, latency.released(times)),
            during(table["samples"], arrivals),
            table["waits_ns"] * 1e-6,
        )


def during(decided: np.ndarray, arrivals: list[Arrival]) -> np.ndarray:
    """The poses decided while a client looked."""
    from_ns, to_ns = arrivals[0][0], arrivals[-1][0]
    return np.asarray(decided[(decided[:, 0] >= from_ns) & (decided[:, 0] <= to_ns), 1:])


def read_websocket(port: int) -> list[Arrival]:
    """Poses as they come; the first two seconds, the town itself, are left out."""
    client = Client(port)
    list(client.frames(2.0))
    frames = list(client.frames(SECONDS))
    client.close()
    return latency.poses(frames, NODE)
