"""Benchmarks: from the decision of a frame of the town to a websocket client, beside a bare viser loop."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from benchmarks import latency
from benchmarks.client import Client, health
from benchmarks.figures import Figure, Section
from benchmarks.latency import Arrival, Latency
from benchmarks.page import read_websocket, through_bare
from benchmarks.processes import first_line, free_port, running

SECONDS = 12.0
NODE = "/world"


def town() -> Section:
    """Each twice, the better of the two: another load on the machine is nobody's fault."""
    ours = min((through_town() for _ in range(2)), key=lambda one: one.percentile(95))
    bare = min((through_bare(read_websocket) for _ in range(2)), key=lambda one: one.percentile(95))
    most, note = 1.25 * bare.percentile(95), "wanted: 1.25 × the bare loop's"
    yield Figure("town: decision → websocket client, p95", ours.percentile(95), "ms", most, note=note)
    yield Figure("  p50", ours.percentile(50), "ms")
    yield Figure("  poses a second", ours.frames_hz, "", note=f"{ours.unknown} poses were no frame's")
    yield Figure("bare viser: set → websocket client, p95", bare.percentile(95), "ms", note="the same door")


def through_town() -> Latency:
    """The town walked by simulated feet."""
    with tempfile.TemporaryDirectory() as folder:
        port, times = free_port(), Path(folder) / "times.npz"
        with running("benchmarks.walked_town", str(port), str(times)) as program:
            first_line(program)
            end = time.monotonic() + 120.0
            while health(port).get("motion") in (None, "none") and time.monotonic() < end:
                time.sleep(0.2)
            arrivals = read(port)
        return latency.latency(arrivals, latency.released(times))


def read(port: int) -> list[Arrival]:
    """Poses as they come; the first two seconds, the town itself, are left out."""
    client = Client(port)
    list(client.frames(2.0))
    frames = list(client.frames(SECONDS))
    client.close()
    return latency.poses(frames, NODE)
