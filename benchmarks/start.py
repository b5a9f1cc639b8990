"""Benchmarks: from the command to the page: the first start ever, with nothing compiled, and the second."""

from __future__ import annotations

import contextlib
import re
import resource
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.client import Client, get, health
from benchmarks.figures import Figure, Section
from benchmarks.processes import free_port, running

SHOES = ("/ned/foot", "/ned/left", "/ned/right")
ROUNDS = 3


class Start(NamedTuple):
    """Seconds to the page and to the shoe, the processor's share of them, and what it said meanwhile."""

    page_s: float
    shoe_s: float
    processor_s: float
    told: set[str]


def start() -> Section:
    """Seconds until the port answers, and until a websocket client is sent a shoe that stands somewhere."""
    with tempfile.TemporaryDirectory() as folder:
        first = one_start(Path(folder))
        later = [one_start(Path(folder)) for _ in range(ROUNDS)]
    best = f"best of {ROUNDS}"
    yield Figure("first start ever → HTTP 200", first.page_s, "s", 15.0, note="nothing compiled yet")
    yield Figure("first start ever → the shoe", first.shoe_s, "s", 15.0)
    yield Figure("  processor time of it, all threads", first.processor_s, "s")
    yield Figure("  parts it says it prepares meanwhile", len(first.told), "", 1, True)
    yield Figure("second start → HTTP 200", min(s.page_s for s in later), "s", 4.0, note=best)
    yield Figure("second start → the shoe", min(s.shoe_s for s in later), "s", 4.0, note=best)
    yield Figure("  the worst of them", max(s.shoe_s for s in later), "s")
    yield Figure("  processor time of it, all threads", min(s.processor_s for s in later), "s")


def one_start(cache: Path) -> Start:
    """Start the viewer with this cache folder, see the shoe, stop it."""
    port, told = free_port(), set[str]()
    spent_s = children_s()
    began = time.monotonic()

    def is_shoe(message: dict[str, Any]) -> bool:
        told.update(re.findall(r"Preparing ([\w ]+) \(", str(message)))
        return message["type"] == "FrameMessage" and message["name"] in SHOES

    arguments = ("app", "walk", "--no-open", "--port", str(port))
    with running(*arguments, environment={"XDG_CACHE_HOME": str(cache)}):
        wait_for_page(port)
        page_s = time.monotonic() - began
        client = Client(port)
        at_ns, _ = client.until(is_shoe, 120.0)
        client.close()
    return Start(page_s, at_ns * 1e-9 - began, children_s() - spent_s, told)


def children_s() -> float:
    """Processor time of all processes that were started here and have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def wait_for_page(port: int, seconds: float = 60.0) -> None:
    """Until the port answers with a page."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        with contextlib.suppress(OSError):
            if get(port, "/")[0] == 200:
                return
        time.sleep(0.02)
    raise TimeoutError(f"no page within {seconds:.0f} s")


def wait_for_samples(port: int, count: int, seconds: float = 120.0) -> None:
    """Until so many samples are in."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if int(health(port)["taken"]) >= count:
            return
        time.sleep(0.05)
    raise TimeoutError(f"{count} samples did not come in within {seconds:.0f} s")
