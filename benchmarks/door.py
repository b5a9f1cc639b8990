"""Benchmarks: what the door adds: one viser, clients in turns through the door and at its own port."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from benchmarks import latency
from benchmarks.client import Client
from benchmarks.figures import Figure, Section
from benchmarks.processes import first_line, free_port, running

SECONDS, ROUNDS = 5.0, 3


def door() -> Section:
    """Milliseconds from set to client, p50 and p95, direct and through the door."""
    arrivals: dict[str, list[latency.Arrival]] = {"direct": [], "through the door": []}
    with tempfile.TemporaryDirectory() as folder:
        port, times = free_port(), Path(folder) / "times.npz"
        with running("benchmarks.bare", str(port), str(times)) as loop:
            hidden = int(first_line(loop))
            for _ in range(ROUNDS):
                arrivals["direct"] += read(hidden)
                arrivals["through the door"] += read(port)
        sets = latency.released(times)
    found = {name: latency.latency(seen, sets) for name, seen in arrivals.items()}
    for name, one in found.items():
        yield Figure(f"set → client, {name}: p50", one.percentile(50), "ms", note=f"{len(one.ms)} poses")
        yield Figure(f"set → client, {name}: p95", one.percentile(95), "ms")
    direct, through = (np.median(one.ms) for one in found.values())
    yield Figure("the door adds, p50", float(through - direct), "ms", 2.0, note="design: 0.1 to 0.4 ms")
    late = found["through the door"].percentile(95) - found["direct"].percentile(95)
    yield Figure("the door adds, p95", late, "ms", 2.0)


def read(port: int) -> list[latency.Arrival]:
    """What one client sees for a while."""
    client = Client(port)
    list(client.frames(0.5))
    frames = list(client.frames(SECONDS))
    client.close()
    return latency.poses(frames, "/ned/foot")
