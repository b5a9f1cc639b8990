"""Benchmarks: a long walk of two feet at eight times its pace, one client that reads, one that never does."""

from __future__ import annotations

import json
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats
from benchmarks.client import Client, deaf, health
from benchmarks.figures import Figure, Section
from benchmarks.processes import first_line, free_port, rss_bytes, running
from benchmarks.start import wait_for_page, wait_for_samples

SPEED = 8
WALK = "sim:walk?path=eight&feet=2&rate_hz=100&noise=1&duration_s={seconds:.0f}&speed={speed}"
LOOK_S = 5.0
MB = 1e6


class Look(NamedTuple):
    """Memory at one time: seconds since the start, resident bytes."""

    at_s: float
    rss: int


class Watched(NamedTuple):
    """What was seen of a run."""

    looks: list[Look]
    windows: list[dict[str, float]]  # by ``stopwatch``: what a frame cost
    taken: int
    frames: int  # that the reading client got
    longest_gap_s: float  # between two of them


def hour(clock_s: float) -> Section:
    """Memory beside the stated stores, and the cost of a frame at the start and at the end."""
    run = watch(clock_s)
    windows = run.windows[2:-1]  # the first two: compiling and joining
    if len(windows) < 6:
        yield Figure("long walk", None, note=f"only {len(windows)} windows: give it more minutes")
        return
    stored = np.array([w["stored_bytes"] for w in windows])
    strides = windows[-1]["strides"]
    yield Figure(
        "samples taken", run.taken, "", note=f"{strides:.0f} strides, {windows[-1]['t_s'] / 60:.0f} min"
    )
    yield from memory(run, windows, stored)
    for key, what in (("snapshot_us", "snapshot"), ("draw_us", "draw")):
        cost = np.array([w[key] for w in windows])
        early, late = thirds(cost)
        yield Figure(f"cost of a {what}, first third of the walk", early, "µs")
        yield Figure(f"cost of a {what}, last third ÷ first third", late / early, "×", 1.25)
    rates = np.array([w["frames_hz"] for w in windows])
    yield Figure("frames drawn a second, median", float(np.median(rates)), "", 50.0, True)
    yield Figure("frames that the reading client got a second", run.frames / clock_s, "", 45.0, True)
    yield Figure("longest wait of the reading client", run.longest_gap_s, "s", 1.0)


def thirds(values: Floats) -> tuple[float, float]:
    """Medians of the first and the last third."""
    third = max(1, len(values) // 3)
    return float(np.median(values[:third])), float(np.median(values[-third:]))


def memory(run: Watched, windows: list[dict[str, float]], stored: Floats) -> Section:
    """Resident memory's growth beside that of the stores, as lines through all the looks."""
    looks = [look for look in run.looks if look.at_s > 2 * LOOK_S]
    minutes = (looks[-1].at_s - looks[0].at_s) / 60 * SPEED
    grown = slope([look.at_s for look in looks], [look.rss for look in looks]) * (
        looks[-1].at_s - looks[0].at_s
    )
    kept = float(stored[-1] - stored[0]) * len(looks) / len(stored)
    note = f"over {minutes:.0f} minutes of walk"
    yield Figure("stores at the end, as the page states them", float(stored[-1]) / MB, "MB")
    yield Figure("resident at the end", looks[-1].rss / MB, "MB")
    yield Figure("resident memory grew by", grown / MB, "MB", note=note)
    yield Figure("the stores grew by", kept / MB, "MB")
    yield Figure("  growth that no store explains, an hour", (grown - kept) / MB / minutes * 60, "MB", 40.0)


def slope(x: list[float], y: list[int]) -> float:
    """Of the least-squares line."""
    return float(np.polyfit(np.array(x), np.array(y, float), 1)[0])


def watch(clock_s: float) -> Watched:
    """Run it for so long."""
    spec = WALK.format(seconds=SPEED * clock_s + 60, speed=SPEED)
    with tempfile.TemporaryDirectory() as folder:
        port, windows = free_port(), Path(folder) / "windows.jsonl"
        with running("benchmarks.stopwatch", spec, str(port), "--windows", str(windows)) as viewer:
            first_line(viewer)
            wait_for_page(port)
            wait_for_samples(port, 10)
            silent, client = deaf(port), Client(port)
            looks, frames, gap_s = read(client, viewer.pid, clock_s)
            taken = int(health(port)["taken"])
            client.close()
            silent.close()
        lines = [json.loads(line) for line in windows.read_text().splitlines()]
    return Watched(looks, lines, taken, frames, gap_s)


def read(client: Client, pid: int, clock_s: float) -> tuple[list[Look], int, float]:
    """Read every frame, and look at the memory now and then."""
    looks: list[Look] = []
    frames, gap_s = 0, 0.0
    began = last = time.monotonic()
    while (now := time.monotonic()) < began + clock_s:
        if now >= began + LOOK_S * len(looks):
            looks.append(Look(now - began, rss_bytes(pid)))
        if client.frame(1.0) is not None:
            frames, now = frames + 1, time.monotonic()
            gap_s, last = max(gap_s, now - last), now
    return looks, frames, gap_s
