"""Benchmarks: sixteen sensors by UDP into one receiver, and a forwarder whose network is cut.

The receiver is a process of its own, so that its share of a core is its own; the sender is this one.
"""

from __future__ import annotations

import asyncio
import json
import resource
import socket
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from app.formats.wire.message import encode_binary  # noqa: E402
from app.motion.basics import role_of  # noqa: E402
from app.motion.samples import Sample  # noqa: E402
from app.outputs.forwarder import Links, WsSender  # noqa: E402
from app.session import Session  # noqa: E402
from app.settings import Settings  # noqa: E402
from app.sources.opening import open_source  # noqa: E402
from app.warm import warm_up  # noqa: E402
from benchmarks.figures import Figure, Section  # noqa: E402
from tests.sources.proxies import Cable  # noqa: E402

SENSORS, RATE_HZ = 16, 400.0
STEP_NS = round(1e9 / RATE_HZ)
MOST_OF_A_CORE = 60.0
CUT_S = 10.0
#: The receiver has all when nothing came for so long.
QUIET_S = 2.0


def feeds(seconds: float) -> Section:
    """Both, the cut for ``CUT_S`` of at least three times as long."""
    yield from datagrams(seconds, estimate=False)
    yield from datagrams(seconds, estimate=True)
    yield from cut(max(seconds / 2, 3 * CUT_S), CUT_S)


# --- many sensors ---------------------------------------------------------------------------------


def datagrams(seconds: float, estimate: bool) -> Iterator[Figure]:
    """Sixteen sensors at 400 Hz; with ``estimate`` each of them also walks."""
    found = received(seconds, estimate)
    sent = SENSORS * round(seconds * RATE_HZ)
    name = f"{SENSORS} sensors × {RATE_HZ:g} Hz by UDP" + (", each estimated" if estimate else "")
    yield Figure(f"{name}: lost", sent - found["taken"], f"of {sent}", wanted=0)
    yield Figure(f"{name}: taken twice", found["twice"], "", wanted=0)
    share = 100 * found["cpu_s"] / found["wall_s"]
    wanted = None if estimate else MOST_OF_A_CORE
    yield Figure(f"{name}: of one core", share, "%", wanted, note=f"{found['wall_s']:.0f} s")


def received(seconds: float, estimate: bool) -> dict[str, Any]:
    """What the receiver tells of a run."""
    command = [sys.executable, __file__, "estimate" if estimate else "receive"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stdin=subprocess.PIPE, text=True, cwd=ROOT
    ) as child:
        assert child.stdout
        assert child.stdin
        send(int(child.stdout.readline()), seconds)
        told, _ = child.communicate("end\n", timeout=60)
    found: dict[str, Any] = json.loads(told)
    return found


def send(port: int, seconds: float) -> None:
    """All sensors' samples at their times, each a datagram."""
    senders = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(SENSORS)]
    began = time.perf_counter()
    for i in range(round(seconds * RATE_HZ)):
        time.sleep(max(began + i / RATE_HZ - time.perf_counter(), 0.0))
        swing = 3.0 if i % 400 > 200 else 0.0
        for k, sender in enumerate(senders):
            sample = Sample(
                f"s{k}", i, i * STEP_NS, 0, (swing, 0.0, -9.81), (0.0, swing, 0.0), (20.0, 0.0, 44.0)
            )
            sender.sendto(encode_binary(k + 1, [sample]), ("127.0.0.1", port))
    for sender in senders:
        sender.close()


def receive(estimate: bool) -> None:
    """The receiver's process: tells its port, takes until told to end, tells what it took and its cost."""
    asyncio.run(_receive(estimate))


async def _receive(estimate: bool) -> None:
    source = open_source("udp:0")
    session = Session(Settings(), role_of)
    numbers: dict[str, Counter[int]] = {}
    if estimate:  # compiled before the clock runs
        warm_up(Settings().estimator)

    async def take() -> None:
        async for item in source:
            assert isinstance(item, Sample)
            numbers.setdefault(item.sensor, Counter())[item.seq] += 1
            if estimate:
                session.take(item)

    taking = asyncio.create_task(take())
    print(getattr(source, "port"), flush=True)  # noqa: B009
    began, before = time.monotonic(), resource.getrusage(resource.RUSAGE_SELF)
    await asyncio.to_thread(sys.stdin.readline)
    wall_s, after = time.monotonic() - began, resource.getrusage(resource.RUSAGE_SELF)
    before_count = -1
    while (count := sum(map(len, numbers.values()))) != before_count:  # what still waits
        before_count = count
        await asyncio.sleep(QUIET_S)
    if taking.done():
        taking.result()  # a fault: let it be seen
    taking.cancel()
    source.close()
    helper = resource.getrusage(resource.RUSAGE_CHILDREN)  # the process that takes the datagrams
    taken = sum(map(len, numbers.values()))
    told = {
        "taken": taken,
        "twice": sum(counts.total() for counts in numbers.values()) - taken,
        "cpu_s": sum(each.ru_utime + each.ru_stime for each in (after, helper))
        - before.ru_utime
        - before.ru_stime,
        "wall_s": wall_s,
    }
    print(json.dumps(told), flush=True)


# --- a cut ----------------------------------------------------------------------------------------


def cut(seconds: float, cut_s: float) -> Iterator[Figure]:
    """Two feet at 100 Hz through a cable that is cut in the middle."""
    sent, got, waited_s = asyncio.run(_cut(seconds, cut_s))
    lost = sum(len(set(sent[foot]) - set(got[foot])) for foot in sent)
    doubled = sum(len(got[foot]) - len(set(got[foot])) for foot in sent)
    disordered = sum(a >= b for foot in sent for a, b in zip(got[foot], got[foot][1:], strict=False))
    name = f"forwarder cut off for {cut_s:g} s"
    yield Figure(f"{name}: lost", lost, f"of {sum(map(len, sent.values()))}", wanted=0)
    yield Figure(f"{name}: taken twice", doubled, "", wanted=0)
    yield Figure(f"{name}: out of order", disordered, "", wanted=0)
    yield Figure(f"{name}: all there after", waited_s, "s", note="from plugging in again")


async def _cut(seconds: float, cut_s: float) -> tuple[dict[str, list[int]], dict[str, list[int]], float]:
    source = open_source("ws:0")
    cable = Cable(getattr(source, "port"))  # noqa: B009
    await cable.plug_in()
    sender = WsSender(f"ws://127.0.0.1:{cable.port}", 1, Links(), lambda _: None)
    sent: dict[str, list[int]] = {"left": [], "right": []}
    got: dict[str, list[int]] = {"left": [], "right": []}

    async def take() -> None:
        async for item in source:
            assert isinstance(item, Sample)
            got[item.sensor].append(item.seq)

    async def give(count: int) -> None:
        for _ in range(count):
            for foot, numbers in sent.items():
                i = len(numbers)
                numbers.append(i)
                sender.send(Sample(foot, i, i * 10_000_000, 0, (0.0, 0.0, -9.81), (0.0, 0.0, 0.0)))
            await asyncio.sleep(0.01)

    tasks = [asyncio.create_task(take()), asyncio.create_task(sender.run())]
    around = round(100 * (seconds - cut_s) / 2)
    await give(around)
    cable.cut()
    await give(round(100 * cut_s))
    await cable.plug_in()
    began = time.monotonic()
    backlog = len(sent["left"])
    while len(got["left"]) < backlog and time.monotonic() < began + 30:
        await asyncio.sleep(0.01)
    waited_s = time.monotonic() - began
    await give(around)
    await asyncio.wait_for(sender.finish(), 30)
    await asyncio.sleep(0.2)
    for task in tasks:
        task.cancel()
    cable.cut()
    source.close()
    return sent, got, waited_s


if __name__ == "__main__":
    receive(estimate=sys.argv[1:] == ["estimate"])
