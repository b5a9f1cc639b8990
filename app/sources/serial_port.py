"""Edge: a sensor on a serial port as a live source: found, started, read, and waited for when it goes.

It is read on a loop of its own, in a thread, so that it is stamped when it comes, not when the page is drawn.
"""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import math
import os
import threading
import time
from collections.abc import AsyncIterator, Callable, Mapping
from dataclasses import dataclass

from serial.tools.list_ports import comports

from app.formats.mounting import Axes, describe
from app.formats.wire.catalogue import Decoder
from app.formats.wire.identify import Found
from app.formats.wire.stream import Counters
from app.motion.basics import InputError, role_of
from app.motion.samples import GAP_NS, Sample
from app.motion.source import Link, SourceInfo
from app.sources.inbox import Inbox
from app.sources.port import Port, PortLostError, open_port, refusal
from app.sources.source import Item, Live
from app.sources.starting import Started, UnansweredError, Wish, start, start_known

log = logging.getLogger(__name__)

#: Between tries to open a port that is gone: they grow, but a sensor plugged in again is soon back.
WAITS_S = (0.1, 0.2, 0.4, 0.8, 1.0)
#: A sensor that was heard and is silent for so long has lost its power, or its mind.
SILENT_S = 2.0
#: Where it did not answer, it is asked again so much later, so often, before the port is opened anew: what a
#: slow sensor had to say meanwhile would be lost with the port.
AGAIN_S = 1.0
ASKED_AGAIN = 2
#: Just opened, or just started, it may take longer: a board boots, a GX1's clock is measured.
SILENT_AT_FIRST_S = 8.0
#: Bytes that make no sample for so long: it was set to something else. Where samples came it lost its
#: settings meanwhile, with its power; at first a clock may still be measured.
FRUITLESS_S, FRUITLESS_AT_FIRST_S = 3.0, 10.0
FIRST_BAUD = 115200
#: A port that hangs is left behind after so long.
CLOSE_S = 1.5
#: Between the questions to a sensor that tells its temperature only when asked.
ASK_S = 10.0


@dataclass(frozen=True)
class PortSpec:
    """One port as the SPEC says it. ``axes`` None: as is usual for the device; ``columns`` of lines without
    a header.
    """

    path: str
    wish: Wish
    foot: str = "foot"
    axes: Axes | None = None
    columns: str | None = None


class SerialPort(Live):
    """One sensor. Its decoder is kept over a loss, so that numbers and stamps go on behind a gap."""

    def __init__(self, spec: PortSpec) -> None:
        """Nothing is opened yet; ``InputError`` if there is no such port or it may not be opened."""
        self._spec = spec
        _demand_port(spec.path)
        self._inbox = Inbox(f"serial:{spec.path}", "")
        self._thread: threading.Thread | None = None
        self._closed = False
        self._end: Callable[[], None] = _nothing
        self._started: Started | None = None
        self._decoder: Decoder | None = None
        self._seam = Seam()
        self._link = Link.WAITING
        self._detail = f"opening {spec.path}"
        self._losses = 0
        self._asked_s = -math.inf

    @property
    def info(self) -> SourceInfo:
        """What is known: after the sensor answered, what it is and what is assumed of it."""
        spec, started, decoder = self._spec, self._started, self._decoder
        name = f"serial:{spec.path}"
        roles = {spec.foot: role_of(spec.foot)}
        if started is None or decoder is None:
            return SourceInfo(name, "not known yet", roles)
        kind = started.kind
        mounting = f"mounting {describe(spec.axes or kind.axes)}"
        assumed = () if spec.axes else (f"{mounting}: as is usual for it (axes= says otherwise)",)
        what = f"{kind.title} at {started.baud} baud"
        found = f"{started.device}: {started.evidence}"
        serial = str(getattr(started.setup, "serial", "") or "")
        serials = {spec.foot: f"{kind.title} {serial}"} if serial else {}
        warm = decoder.temperature_c
        warmth = {} if warm is None else {spec.foot: warm}
        firmware = str(getattr(started.setup, "firmware", "") or "")
        told = (found, *([f"firmware {firmware}"] if firmware else []), *assumed, *decoder.notes)
        line = _line(decoder)
        return SourceInfo(name, what, roles, assumed=told, line=line, serials=serials, temperatures=warmth)

    @property
    def link(self) -> Link:
        """WAITING before the first sample, LOST while the sensor is gone, else LIVE."""
        return self._link

    @property
    def detail(self) -> str:
        """What is being tried, or what was found."""
        return self._detail

    @property
    def counters(self) -> Mapping[str, Counters]:
        """What became of the bytes."""
        return {self._spec.foot: self._decoder.counters} if self._decoder else {}

    def __aiter__(self) -> AsyncIterator[Item]:
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="serial", daemon=True)
            self._thread.start()
        return aiter(self._inbox)

    def close(self) -> None:
        """Let go of the port."""
        self._closed = True
        self._end()
        if self._thread is not None:
            self._thread.join(CLOSE_S)

    def unread(self) -> list[Sample]:
        """What came and was not read."""
        return self._inbox.unread()

    # --- the port's life, in its thread ---

    def _run(self) -> None:
        try:
            asyncio.run(self._until_closed())
        except Exception:
            log.exception("reading %s failed", self._spec.path)
            self._link, self._detail = Link.LOST, f"{self._spec.path}: given up, by a fault of the program"

    async def _until_closed(self) -> None:
        loop = asyncio.get_running_loop()
        task = loop.create_task(self._serve())

        def end() -> None:
            with contextlib.suppress(RuntimeError):  # it has ended already
                loop.call_soon_threadsafe(task.cancel)

        self._end = end
        if self._closed:
            task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task

    async def _serve(self) -> None:
        waits = iter(WAITS_S)
        while True:
            taken, port = self._seam.taken, None
            try:
                port = await open_port(self._spec.path, self._first_baud())
                await self._start(port)
                await self._read(port)
            except PortLostError as error:
                if self._seam.taken > taken:
                    waits = iter(WAITS_S)
                    self._losses += self._link is not Link.LOST
                    log.info("%s (after %d samples)", error, self._seam.taken)
                wait_s = next(waits, WAITS_S[-1])
                self._link = Link.LOST if self._seam.taken else Link.WAITING
                again = f"again in {wait_s:g} s" if wait_s >= 1.0 else "again now"
                self._detail = f"{error}; trying {again}"
            finally:
                if port is not None:
                    await port.close()
            await asyncio.sleep(wait_s)

    def _first_baud(self) -> int:
        """The rate that is known, so that nothing said at once is lost by changing to it."""
        known = self._started
        return known.baud if known else self._spec.wish.baud or FIRST_BAUD

    async def _start(self, port: Port) -> None:
        known = self._started
        if known is None:
            started = await start(port, self._spec.wish, self._tell)
        else:
            try:
                port.set_baud(known.baud)
                found = Found(known.device, known.evidence)
                started = await start_known(port, known.baud, found, self._spec.wish.rate_hz, self._tell)
            except PortLostError:
                await port.read(0.0)  # gone altogether? else it may be another sensor by now
                started = await start(port, self._spec.wish, self._tell)
        self._adopt(started)
        self._take(time.monotonic_ns(), started.heard)

    def _adopt(self, started: Started) -> None:
        """It sends: its decoder goes on, or another sensor's begins."""
        if self._decoder is None or _another(self._started, started):
            axes = self._spec.axes or started.kind.axes
            self._decoder = started.kind.decoder(self._spec.foot, axes, started.setup or self._spec.columns)
            self._seam.cut()
        self._started = started

    async def _wake(self, port: Port, known: Started, silence: str) -> bool:
        """Start a sensor that fell silent, on the open port: one that merely lagged loses nothing by it.

        Whether it answered.
        """
        log.info("%s (after %d samples)", silence, self._seam.taken)
        self._losses += self._link is not Link.LOST
        self._link, self._detail = Link.LOST, f"{silence}; asking it"
        found = Found(known.device, known.evidence)
        rate_hz = self._spec.wish.rate_hz
        try:
            self._adopt(await start_known(port, known.baud, found, rate_hz, self._tell, tap=self._take))
        except UnansweredError:
            return False
        return True

    async def _read(self, port: Port) -> None:
        """Decode what comes, until it ends in ``PortLostError``."""
        patience_s, tries = SILENT_AT_FIRST_S, 0
        sample_s, fruitless_s = time.monotonic(), FRUITLESS_AT_FIRST_S
        while True:
            arrived = await port.read(patience_s)
            if not arrived:
                silence = f"{port.path}: nothing came for {patience_s:g} s: check its power"
                if tries == 0 or self._started is None:
                    raise PortLostError(silence)
                awake = await self._wake(port, self._started, silence)
                patience_s, tries = (SILENT_AT_FIRST_S, 0) if awake else (AGAIN_S, tries - 1)
                continue
            patience_s, tries = SILENT_S, 1 + ASKED_AGAIN
            for host_ns, data in arrived:
                if self._take(host_ns, data):
                    sample_s, fruitless_s = time.monotonic(), FRUITLESS_S
            self._ask_its_temperature(port)
            if time.monotonic() - sample_s > fruitless_s:
                why = f" ({self._decoder.notes[-1]})" if self._decoder and self._decoder.notes else ""
                raise PortLostError(
                    f"{port.path}: what comes makes no samples{why}: starting the sensor anew"
                )

    def _ask_its_temperature(self, port: Port) -> None:
        """Now and then, where it tells it only when asked."""
        question = self._started.kind.question if self._started else b""
        if question and time.monotonic() - self._asked_s > ASK_S:
            self._asked_s = time.monotonic()
            port.write(question)

    def _take(self, host_ns: int, data: bytes) -> bool:
        started, decoder = self._started, self._decoder
        samples = decoder.feed(data, host_ns) if decoder and data else []
        if not samples or started is None:
            return False
        self._link = Link.LIVE
        again = f", {self._losses} time{'' if self._losses == 1 else 's'} lost" if self._losses else ""
        self._detail = f"{started.kind.title} at {started.baud} baud{again}"
        self._inbox.put([self._seam.join(sample) for sample in samples])
        return True

    def _tell(self, what: str) -> None:
        self._detail = f"{self._spec.path}: {what}"


def _line(decoder: Decoder) -> dict[str, int]:
    """What became of the bytes, in words."""
    counters = decoder.counters
    counted = {
        "packets": counters.packets,
        "that did not hold": counters.bad_checksum,
        "bytes of rubbish": counters.bytes_skipped,
        "unusable readings": counters.dropped,
        "lost by the sensor's own count": counters.lost,
    }
    return {words: count for words, count in counted.items() if count}


def _nothing() -> None:
    """Nothing is open."""


class Seam:
    """Joins the samples of one decoder to those of the one before it: numbers and stamps only increase."""

    def __init__(self) -> None:
        self.taken = 0
        self._last: Sample | None = None
        self._shift: tuple[int, int] | None = (0, 0)  # of seq and of device_ns; None: with the next sample

    def cut(self) -> None:
        """The next sample is another decoder's first."""
        self._shift = None if self._last else (0, 0)

    def join(self, sample: Sample) -> Sample:
        """The sample in the run of all."""
        if self._shift is None and self._last is not None:
            silence_ns = max(sample.host_ns - self._last.host_ns, GAP_NS + 1)
            stamp_ns = self._last.device_ns + silence_ns
            self._shift = (self._last.seq + 1 - sample.seq, stamp_ns - sample.device_ns)
        seq, shift_ns = self._shift or (0, 0)
        self._last = sample._replace(seq=sample.seq + seq, device_ns=sample.device_ns + shift_ns)
        self.taken += 1
        return self._last


def _another(known: Started | None, started: Started) -> bool:
    """Whether this is not the sensor that was there before."""
    if known is None or known.device != started.device:
        return True
    before, now = (getattr(each.setup, "serial", "") for each in (known, started))
    return bool(before and now and before != now)


def _demand_port(path: str) -> None:
    """A port that cannot be opened is the user's to know at once, before any page opens."""
    if not os.path.exists(path):
        there = ", ".join(port.device for port in comports()) or "none"
        raise InputError(f"serial:{path}: no such port, expected one that is there: {there}")
    if not os.access(path, os.R_OK | os.W_OK):
        raise InputError(f"serial:{refusal(path, PermissionError(errno.EACCES, ''))}")
