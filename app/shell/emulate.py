"""Shell: a recording or a simulation as a sensor on a pseudo-terminal, with the faults of a real one."""

from __future__ import annotations

import asyncio
import contextlib
import json
import math
import signal
from collections import deque
from collections.abc import AsyncIterator, Callable, Coroutine
from dataclasses import dataclass

import numpy as np

from app.formats.mounting import Axes
from app.formats.wire import gx1_talk
from app.formats.wire.catalogue import KINDS, Model
from app.formats.wire.faults import Faults, Line
from app.motion.basics import InputError
from app.motion.recording import Recording
from app.motion.samples import Sample
from app.motion.source import Truth
from app.outputs.terminal import Terminal
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from app.sources.timeline import Timeline

GX1_FAST_BAUD = 115200
#: More than so much waiting to be sent, and a measurement is passed over: the line is too slow for it.
BACKLOG_S = 0.25
#: After the last sample, so that the host can fetch it before the port goes.
LINGER_S = 2.0
#: After a host opened the port, before the first sample: a board boots, and a host empties the port first.
BOOT_S = 0.1
_CHUNK = 64
_TIMER_S = 0.001  # a timer may ring this much early
NO_FAULTS = Faults()


@dataclass(frozen=True)
class Wanted:
    """What the command line says. ``baud`` None: the usual one, and every speed of the host agrees."""

    device: str
    source: str
    baud: int | None = None
    axes: Axes | None = None
    foot: str | None = None
    faults: Faults = NO_FAULTS
    seed: int = 0


def emulate(wanted: Wanted, tell: Callable[[str], None]) -> None:
    """Serve until the source ends or Ctrl-C; the path is told first, what was sent at the end."""
    spec = parse_spec(wanted.source)
    recording, truth = open_recording(spec)
    recording = of_one_foot(recording, wanted.foot)
    emulator = Emulator(wanted, recording, truth, spec.loop)
    tell(emulator.path)
    try:
        asyncio.run(until_signalled(emulator.run()))
    finally:
        emulator.close()
    tell(json.dumps(emulator.sent()))


class Emulator:
    """One sensor. It boots when a host first opens the port, then begins to measure."""

    def __init__(self, wanted: Wanted, recording: Recording, truth: Truth | None, loop: bool) -> None:
        kind = KINDS[wanted.device]
        self._axes = wanted.axes or kind.axes
        self._device, self._strict = wanted.device, wanted.baud is not None
        self._baud = wanted.baud or kind.bauds[0]
        self._faults = wanted.faults
        self._timeline, self._truth, self._loop = Timeline(recording), truth, loop
        self._line = Line(wanted.faults, wanted.seed)
        self._model: Model | None = self._made()
        self._zero_ns: int | None = None  # the source's time at which its clock was 0
        self._free_s = self._now_s = 0.0  # of the line, and of the newest sample: a busy machine lags
        self._next_s = math.inf  # when the next sample is due
        self._unanswered = b""
        self._under_way: deque[tuple[float, bytes]] = deque()
        self._messages = self._bytes = self._passed_over = self._unheard = 0
        self._terminal = Terminal(wanted.device, self._baud, self._receive, bool(wanted.faults.unplugs))
        self.path = self._terminal.path

    async def run(self) -> None:
        """Measure at the source's pace until it ends."""
        loop = asyncio.get_running_loop()
        tasks = [loop.create_task(self._terminal.watch())]
        try:
            while not self._terminal.hosted:
                await asyncio.sleep(0.01)
            self._now_s = loop.time()
            await asyncio.sleep(BOOT_S)
            tasks += [loop.create_task(self._unplug(o.at_s, o.seconds)) for o in self._faults.unplugs]
            tasks += [loop.create_task(self._brown_out(o.at_s, o.seconds)) for o in self._faults.brownouts]
            async for sample, due_s in self._samples():
                self._measure(sample, due_s)
            await asyncio.sleep(max(self._free_s - loop.time(), 0.0) + self._faults.burst_s)
            await self._terminal.emptied()
            await asyncio.sleep(LINGER_S)
        finally:
            for task in tasks:
                task.cancel()

    def sent(self) -> dict[str, int]:
        """What left the sensor, and what the line did to it."""
        line, terminal = self._line, self._terminal
        told = {"messages": self._messages, "bytes": self._bytes, "passed_over": self._passed_over}
        told["unheard"] = self._unheard  # while no host was there
        damage = {"lost": line.lost, "flipped": line.flipped, "strays": line.strays}
        return told | damage | {"not_fetched": terminal.overrun}

    def close(self) -> None:
        """Take the port away."""
        self._terminal.close()

    # --- the sensor ---

    def _made(self) -> Model:
        if self._device == "gx1" and self._baud == GX1_FAST_BAUD:
            return gx1_talk.Gx1Device(self._axes, gx1_talk.FASTEST)
        return KINDS[self._device].model(self._axes)

    async def _samples(self) -> AsyncIterator[tuple[Sample, float]]:
        """Each sample when it is due, and when that was; around again, with its clock going on."""
        loop, timeline = asyncio.get_running_loop(), self._timeline
        began_s, around_ns = loop.time(), 0
        while True:
            for first in range(0, len(timeline), _CHUNK):
                chunk = timeline.cut(first, min(first + _CHUNK, len(timeline)), 0)
                for index, sample in enumerate(self._oriented(chunk, first), start=first):
                    elapsed_ns = timeline.elapsed_ns(index) + around_ns
                    self._next_s = due_s = began_s + elapsed_ns * 1e-9
                    if due_s > loop.time():
                        self._obey()
                        await asyncio.sleep(due_s - loop.time())
                    yield sample._replace(device_ns=elapsed_ns), due_s
            if not self._loop:
                self._next_s = math.inf
                self._obey()
                return
            around_ns += timeline.duration_ns + timeline.interval_ns

    def _oriented(self, samples: list[Sample], first: int) -> list[Sample]:
        """With the orientation that a good sensor would tell: a simulator's truth."""
        if self._truth is None or samples[0].device_q_nb is not None:
            return samples
        t_s = np.array([self._timeline.elapsed_ns(first + i) * 1e-9 for i in range(len(samples))])
        _, q_nb = self._truth(samples[0].sensor, t_s)
        rows = [(w, x, y, z) for w, x, y, z in q_nb.tolist()]
        return [s._replace(device_q_nb=q) for s, q in zip(samples, rows, strict=True)]

    def _measure(self, sample: Sample, due_s: float) -> None:
        self._now_s = due_s
        if self._model is None:
            return
        if self._zero_ns is None:
            self._zero_ns = sample.device_ns
        elapsed_ns = sample.device_ns - self._zero_ns
        drift_ns = round(elapsed_ns * self._faults.drift_ppm * 1e-6)
        message = self._model.measure(sample._replace(device_ns=elapsed_ns + drift_ns))
        if message and self._free_s - due_s > BACKLOG_S:
            self._passed_over += 1
        elif message:
            self._messages += self._terminal.hosted
            self._unheard += not self._terminal.hosted
            self._send(message, due_s)

    def _receive(self, data: bytes) -> None:
        """Obeyed after what was due before it came: a process held up has that still to measure."""
        self._unanswered += data
        if self._next_s > asyncio.get_running_loop().time():
            self._obey()

    def _obey(self) -> None:
        data, self._unanswered = self._unanswered, b""
        if data and self._model is not None and self._agrees():
            self._send(self._model.receive(data), self._now_s)

    def _agrees(self) -> bool:
        return not self._strict or self._terminal.baud_agrees

    # --- the line ---

    def _send(self, data: bytes, due_s: float) -> None:
        """Written when its last bit would have left a real one; by a machine that lags, later."""
        if not data:
            return
        self._bytes += len(data)
        self._free_s = max(due_s, self._free_s) + 10 * len(data) / self._baud
        arrives_s, burst_s = self._free_s, self._faults.burst_s
        if burst_s > 0.0:
            arrives_s = (arrives_s // burst_s + 1) * burst_s
        arrived = self._line.carry(data) if self._agrees() else self._line.garbled(data)
        self._under_way.append((arrives_s, arrived))
        asyncio.get_running_loop().call_at(arrives_s, self._arrive)

    def _arrive(self) -> None:
        """In the order sent: timers of one instant have none."""
        now_s, arrived = asyncio.get_running_loop().time(), b""
        while self._under_way and self._under_way[0][0] <= now_s + _TIMER_S:
            arrived += self._under_way.popleft()[1]
        if arrived:
            self._terminal.write(arrived)

    async def _unplug(self, at_s: float, seconds: float) -> None:
        await asyncio.sleep(at_s)
        self._terminal.unplug()
        await asyncio.sleep(seconds)
        self._terminal.plug()

    async def _brown_out(self, at_s: float, seconds: float) -> None:
        await asyncio.sleep(at_s)
        self._model = None
        await asyncio.sleep(seconds)
        self._model, self._zero_ns = self._made(), None


def of_one_foot(recording: Recording, foot: str | None) -> Recording:
    """A sensor is on one foot; ``InputError`` where nobody says on which."""
    names = [samples.sensor for samples in recording.sensors]
    chosen = tuple(s for s in recording.sensors if foot is None or s.sensor == foot)
    if len(chosen) != 1:
        came = f"{foot!r}" if foot else f"a walk of {len(names)} sensors"
        raise InputError(f"--foot: {came}, expected one of {', '.join(names)}")
    return Recording(recording.name, recording.format, chosen)


async def until_signalled(work: Coroutine[None, None, None]) -> None:
    """Run it until it ends or somebody ends the program."""
    task = asyncio.create_task(work)
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, task.cancel)
    with contextlib.suppress(asyncio.CancelledError):
        await task
