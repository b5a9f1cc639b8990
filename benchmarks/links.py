"""Benchmarks: two emulated 3DM-GX1 at their fastest, serial ports to the scene; and one that is unplugged."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

from benchmarks.client import Client, health
from benchmarks.figures import Figure, Section
from benchmarks.processes import first_line, free_port, running

BAUD = 115200
RATE_HZ = 1000 / 3
WALK = "sim:walk?path=eight&feet=2&noise=1&rate_hz={rate:.6f}&duration_s={seconds:.0f}"
#: What waits on the way when a source has ended.
REST_S = 5.0
AWAY_S = 5.0
LOOK_S = 0.02
PATIENCE_S = 300.0


def links(clock_s: float) -> Section:
    """Serial to scene for ``clock_s``, then a sensor unplugged for five seconds."""
    yield from two_feet(clock_s)
    yield from unplugged()


def two_feet(clock_s: float) -> Section:
    """What the sensors sent beside what the walk took."""
    source = WALK.format(rate=RATE_HZ, seconds=clock_s)
    port = free_port()
    with contextlib.ExitStack() as stack:
        sensors = [stack.enter_context(emulated(source, side)) for side in ("left", "right")]
        paths = [first_line(sensor) for sensor in sensors]
        spec = f"serial:{paths[0]},{paths[1]}?device=gx1&baud={BAUD}"
        viewer = stack.enter_context(walking(spec, port))
        first_line(viewer)
        frames = stack.enter_context(watched(port))
        sent = [told_at_the_end(sensor, clock_s + PATIENCE_S) for sensor in sensors]
        time.sleep(REST_S)
        told = health(port)
        drawn = frames()
    messages = [each["messages"] for each in sent]
    line = told["line"]
    packets = sum(each["packets"] for each in line.values())
    note = f"{sum(messages)} sent in {clock_s / 60:.1f} min, {RATE_HZ:.0f} Hz a foot, {drawn} frames shown"
    yield Figure("samples lost, serial to walk", sum(messages) - told["taken"], "", 0.0, note=note)
    yield Figure("packets read less those sent", abs(packets - sum(messages)), "", 0.0)
    skipped = sum(each["bytes_skipped"] + each["bad_checksum"] for each in line.values())
    yield Figure("bytes skipped and packets that did not hold", skipped, "", 0.0)
    apart = sum(
        abs(c["bytes_fed"] - c["bytes_good"] - c["bytes_skipped"] - c["bytes_pending"]) for c in line.values()
    )
    yield Figure("bytes fed less those counted", apart, "", 0.0)
    passed = sum(each["passed_over"] + each["not_fetched"] for each in sent)
    yield Figure("measurements that the line or the host had no time for", passed, "", 0.0)
    segments = sum(foot["segments"] - 1 for foot in told["sensors"].values())
    unheard = sum(each["unheard"] for each in sent)
    yield Figure("times a link was lost", segments, "", 0.0, note=f"{unheard} sent meanwhile")


def unplugged() -> Section:
    """How long after the plug is in again samples come, and what became of the walk before."""
    port = free_port()
    source = WALK.format(rate=100, seconds=60)
    with contextlib.ExitStack() as stack:
        sensor = stack.enter_context(emulated(source, "left", f"--fault=unplug={AWAY_S:g}@12", baud=38400))
        path = first_line(sensor)
        first_line(stack.enter_context(walking(f"serial:{path}?device=gx1&baud=38400", port)))
        wait_for(lambda: health(port)["link"] == "live")
        wait_for(lambda: not os.path.exists(path))
        wait_for(lambda: health(port)["link"] == "lost")
        before = health(port)["taken"]
        wait_for(lambda: os.path.exists(path))
        plugged_s = time.monotonic()
        wait_for(lambda: health(port)["link"] == "live")
        back_s = time.monotonic() - plugged_s
        time.sleep(2.0)
        told = health(port)
    (foot,) = told["sensors"].values()
    yield Figure("unplugged 5 s: live again after it is plugged in", back_s, "s", 2.0)
    yield Figure("unplugged 5 s: segments", foot["segments"], "", 2.0)
    yield Figure("unplugged 5 s: samples of the walk before and after", told["taken"], "", before + 1, True)


def wait_for(true: Callable[[], bool]) -> None:
    """Until it is true, within patience."""
    ends_s = time.monotonic() + PATIENCE_S
    while not true():
        if time.monotonic() > ends_s:
            raise TimeoutError("the program does not do what is waited for")
        time.sleep(LOOK_S)


def emulated(source: str, foot: str, *more: str, baud: int = BAUD) -> Any:
    """A sensor in a process of its own."""
    return running(
        "app", "emulate", "gx1", "--source", source, "--foot", foot, "--baud", str(baud), *more
    )  # fmt: skip


def walking(spec: str, port: int) -> Any:
    """The walk viewer."""
    return running("app", "walk", "--no-open", "--port", str(port), "--source", spec)


def told_at_the_end(sensor: subprocess.Popen[str], patience_s: float) -> dict[str, int]:
    """What an emulator says it sent, once its source is at its end."""
    sensor.wait(patience_s)
    assert sensor.stdout is not None
    told: dict[str, int] = json.loads(sensor.stdout.readline())
    return told


@contextlib.contextmanager
def watched(port: int) -> Iterator[Callable[[], int]]:
    """A browser that reads all the while; how many frames it was shown so far."""
    client, ending = Client(port), threading.Event()
    count = 0

    def read() -> None:
        nonlocal count
        while not ending.is_set():
            count += client.frame(0.5) is not None

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    try:
        yield lambda: count
    finally:
        ending.set()
        thread.join(2.0)
        client.close()
