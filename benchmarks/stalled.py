"""Benchmarks: one browser that never reads, and four that do: acquisition, memory, what the four see."""

from __future__ import annotations

import re
import threading
import time
from typing import NamedTuple

from benchmarks.client import Client, deaf, get, health
from benchmarks.figures import Figure, Section
from benchmarks.hour import MB
from benchmarks.processes import first_line, free_port, rss_bytes, running
from benchmarks.start import wait_for_samples

RATE_HZ = 200.0  # two feet
WALK = "sim:walk?path=eight&feet=2&rate_hz=100&noise=1&duration_s=7200"
GOOD = 4
LOOK_S = 5.0


class Stalled(NamedTuple):
    """Samples taken of those due, memory, the four's longest waits, how often the deaf one was let go."""

    taken: float
    rss: list[int]
    gaps_s: list[float]
    frames_hz: float
    let_go: int


def stalled(clock_s: float) -> Section:
    """Acquisition untouched, memory bounded, the four undisturbed."""
    seen = watch(clock_s)
    half = len(seen.rss) // 2
    grown = max(seen.rss[half:]) - max(seen.rss[:half])
    yield Figure("samples taken of those due", 100 * seen.taken, "%", 99.5, True)
    yield Figure("resident at the end", seen.rss[-1] / MB, "MB")
    yield Figure("  the second half's most over the first half's", grown / MB, "MB", 40.0)
    yield Figure(f"longest wait of any of the {GOOD}", max(seen.gaps_s), "s", 1.0)
    yield Figure("frames a second that they got", seen.frames_hz, "", 45.0, True)
    yield Figure("times the deaf one was let go (it came back each time)", seen.let_go, "", 1, True)


def watch(clock_s: float) -> Stalled:
    """Run it for so long."""
    port = free_port()
    with running("app", "walk", "--source", WALK, "--no-open", "--port", str(port)) as viewer:
        first_line(viewer)
        wait_for_samples(port, 400)
        readers = [Reader(port, clock_s) for _ in range(GOOD)]
        came, began = int(health(port)["taken"]), time.monotonic()
        rss, silent = [rss_bytes(viewer.pid)], [deaf(port)]
        while time.monotonic() < began + clock_s:
            time.sleep(LOOK_S)
            rss.append(rss_bytes(viewer.pid))
            if let_go(port) == len(silent):  # it does not notice itself: it reads nothing
                silent.append(deaf(port))
        taken, clock_s = int(health(port)["taken"]) - came, time.monotonic() - began
        gone = let_go(port)
        for reader in readers:
            reader.join()
        for connection in silent:
            connection.close()
    frames = sum(reader.frames for reader in readers) / GOOD / clock_s
    return Stalled(taken / clock_s / RATE_HZ, rss, [reader.gap_s for reader in readers], frames, gone)


def let_go(port: int) -> int:
    """How many browsers were let go for taking nothing."""
    return int(re.findall(rb'door_closed_total\{why="stalled"\} (\d+)', get(port, "/metrics")[1])[0])


class Reader(threading.Thread):
    """A browser that reads everything at once."""

    def __init__(self, port: int, clock_s: float) -> None:
        super().__init__(daemon=True)
        self._client, self._clock_s = Client(port), clock_s
        self.frames, self.gap_s = 0, 0.0
        self.start()

    def run(self) -> None:
        """Note the longest time without a frame, once the first second has brought what was there."""
        for _ in self._client.frames(2.0):
            pass
        last = time.monotonic()
        for frame in self._client.frames(self._clock_s):
            now = frame.at_ns * 1e-9
            self.frames, self.gap_s, last = self.frames + 1, max(self.gap_s, now - last), now
        self._client.close()
