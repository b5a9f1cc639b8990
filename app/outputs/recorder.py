"""Edge: a walk onto the disk, in threads of its own: a chunk is closed every fifth of a second, and synced.

Whoever hands something over never waits. What is written survives a kill, what is synced a power cut. When
the disk is full the recording is closed, readable, with the room kept for that; one that does not even take
what is written is waited for in memory.
"""

from __future__ import annotations

import contextlib
import logging
import math
import os
import shutil
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

from app import __version__
from app.formats.journal import Start
from app.formats.keeping import Keeper
from app.motion.basics import InputError, Quaternion, Vector
from app.motion.commands import Order
from app.motion.estimate import Saved, Stride, Way
from app.motion.samples import Sample
from app.motion.source import SourceInfo
from app.motion.status import RecorderState
from app.outputs.syncing import Syncer

log = logging.getLogger(__name__)

CHUNK_S = 0.2
#: Things that may wait for a slow disk: about three minutes of two feet at 400 Hz.
MOST_WAITING = 150_000
#: Room for the end of a recording on a full disk.
RESERVE = 4 * 2**20
#: Between two temperatures of a sensor, as far as they differ.
WARMTH_S = 1.0
#: A write that takes longer is told.
SLOW_S = 1.0

_Waiting = Sample | tuple[Callable[..., None], tuple[Any, ...]]


class Recorder:
    """One recording being made. All but ``close`` return at once and may be called by one thread."""

    def __init__(
        self,
        folder: Path,
        profile: str,
        source: str,
        info: SourceInfo,
        made_by: str | None = None,
        sync: Callable[[int], None] = os.fsync,
        key: bytes = b"",
    ) -> None:
        """Make the file; ``InputError`` if that cannot be done.

        ``source`` is the SPEC, ``made_by`` the simulator's behind a file. ``sync`` takes a file's number.
        Who holds ``key`` believes the estimator's states in the file.
        """
        self._sync = sync
        self._queue: deque[_Waiting] = deque()
        self._pending = b""  # the chunk being written
        self._lost = 0  # samples that found the queue full, and how many of them the file tells
        self._told = 0
        self._handed = self._written = 0  # samples: into the queue, and of those into the file
        self._trouble = ""
        self._free = 0
        self._began_s = time.monotonic()
        self._ended_s: float | None = None
        self._over = threading.Event()
        self._known = _about(info)
        self._warmth: dict[str, tuple[float, float]] = {}  # last recorded: when, °C
        about = self._known | {"profile": profile, "source": source, "spec": made_by or ""}
        self._keeper = Keeper(about, info.sensors, time.time_ns() - time.monotonic_ns(), key)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._reserve = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115  (held open)
            self._reserve.write(bytes(RESERVE))
            self._reserve.flush()
            self.path, self._file = _new_file(folder, _file_name(profile, source))
            self._size = self._write(self._keeper.begin(time.monotonic_ns()), 0)
            self._syncer = Syncer(self._file.fileno(), sync)
        except OSError as error:
            raise InputError(f"--record {folder}: cannot be written: {error.strerror}") from None
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)
        self._thread.start()

    # --- in: any of these costs a microsecond ------------------------------------------------------

    def sample(self, sample: Sample) -> None:
        """A sample as it was taken."""
        if len(self._queue) < MOST_WAITING:
            self._queue.append(sample)
            self._handed += 1
        elif not self._over.is_set():
            self._lost += 1

    def learn(self, info: SourceInfo) -> None:
        """What the source says of itself by now: what a sensor is, is known when it has answered."""
        about = _about(info)
        if about != self._known:
            self._known = about
            self._queue.append((Keeper.learnt, (time.monotonic_ns(), about)))
        for sensor, celsius in info.temperatures.items():
            self._warm(sensor, celsius)

    def _warm(self, sensor: str, celsius: float) -> None:
        now_s, (at_s, before) = time.monotonic(), self._warmth.get(sensor, (-math.inf, math.nan))
        if celsius != before and now_s - at_s >= WARMTH_S:
            self._warmth[sensor] = now_s, celsius
            self._queue.append((Keeper.temperature, (sensor, time.monotonic_ns(), celsius)))

    def order(self, number: int, order: Order) -> None:
        """An order and its number, after it was taken."""
        self._queue.append((Keeper.order, (number, order)))

    def start(self, start: Start) -> None:
        """What the session holds now: at the beginning, and when the source has begun anew."""
        self._queue.append((Keeper.start, (time.monotonic_ns(), start)))

    def marker(self, who: str, text: str) -> None:
        """A moment that somebody marks."""
        self._queue.append((Keeper.marker, (time.monotonic_ns(), who, text)))

    def pose(self, sensor: str, position_n: Vector, q_nb: Quaternion) -> None:
        """Where a foot is drawn; left out while the disk lags."""
        if len(self._queue) < MOST_WAITING // 2:
            self._queue.append((Keeper.pose, (sensor, time.monotonic_ns(), position_n, q_nb)))

    def stride(self, sensor: str, stride: Stride) -> None:
        """A stride that ended."""
        if len(self._queue) < MOST_WAITING // 2:
            self._queue.append((Keeper.stride, (sensor, time.monotonic_ns(), stride)))

    def estimate(self, sensor: str, saved: Saved, way: Callable[[], Way]) -> None:
        """A foot's estimate between two swings; ``way`` is called by the recorder's thread."""
        if len(self._queue) < MOST_WAITING // 2:
            self._queue.append((Keeper.estimate, (sensor, time.monotonic_ns(), saved, way)))

    # --- out ---------------------------------------------------------------------------------------

    @property
    def on(self) -> bool:
        """Whether it still records: a full disk ends it."""
        return not self._over.is_set()

    @property
    def waiting(self) -> int:
        """How many things the disk has not had yet."""
        return len(self._queue)

    @property
    def state(self) -> RecorderState:
        """What the page shows."""
        trouble = self._trouble or (f"{self._lost} samples not recorded" if self._lost else "")
        return RecorderState(
            self.path.name,
            self.on,
            (self._ended_s or time.monotonic()) - self._began_s,
            self._size,
            self._free,
            trouble,
        )

    def close(self, wait_s: float = 1.5) -> None:
        """Write what waits, and the end; what a disk does not take in ``wait_s`` is said."""
        self._over.set()
        self._thread.join(wait_s)
        missing = self._lost + self._handed - self._written
        if self._thread.is_alive() and missing:
            self._trouble = f"the disk was too slow: its last {missing} samples are not recorded"
        if self.state.trouble:
            log.warning("%s: %s", self.path, self.state.trouble)

    # --- the recorder's own thread -----------------------------------------------------------------

    def _run(self) -> None:
        try:
            while not self._over.wait(CHUNK_S):
                self._free = shutil.disk_usage(self.path.parent).free
                self._keep(self._keeper.chunk)
            self._keep(self._keeper.end)
            self._syncer.finish()
        except OSError as error:
            self._close_full(error)
        except Exception:
            log.exception("recording failed")
            self._trouble = "recording stopped by a fault of the program; what was written is whole"
        finally:
            self._ended_s = time.monotonic()
            self._over.set()
            self._queue.clear()
            self._syncer.stop()
            for file in (self._file, self._reserve):
                with contextlib.suppress(OSError):
                    file.close()

    def _keep(self, finish: Callable[[], bytes]) -> None:
        """Everything that waits into one chunk on the disk."""
        samples = 0
        for _ in range(len(self._queue)):
            item = self._queue.popleft()
            if isinstance(item, Sample):
                self._keeper.sample(item)
                samples += 1
            else:
                method, arguments = item
                method(self._keeper, *arguments)
        lost = self._lost  # the other thread goes on counting
        if lost > self._told:
            self._keeper.event(time.monotonic_ns(), "lost", samples=lost - self._told)
            self._told = lost
            self._trouble = "the disk is too slow: samples were not recorded"
        self._syncer.check()
        self._pending = finish()
        began = time.monotonic()
        if self._pending:
            self._size = self._write(self._pending, self._size)
            written, self._pending = self._pending, b""
            self._written += samples
            self._syncer.wrote(written)
        took = max(time.monotonic() - began, self._syncer.slow_s)
        if took > SLOW_S:
            self._trouble = f"the disk is slow: a write took {took:.1f} s"
        elif self._trouble.startswith("the disk is slow"):
            self._trouble = ""

    def _write(self, data: bytes, size: int) -> int:
        """All of it in the file, or none: the file's new size."""
        try:
            rest = memoryview(data)
            while rest:
                rest = rest[self._file.write(rest) :]
        except OSError:
            self._file.truncate(size)
            self._file.seek(size)
            raise
        return size + len(data)

    def _close_full(self, error: OSError) -> None:
        """End the recording with the room that was kept for it; without an end it is readable as well."""
        self._trouble = f"recording stopped: {error.strerror or error}; what was written is whole"
        log.error("%s: %s", self.path, self._trouble)
        try:
            self._reserve.close()
            unsynced = self._syncer.stop()
            self._size -= sum(map(len, unsynced))
            self._file.truncate(self._size)
            self._file.seek(self._size)
            for data in (*unsynced, self._pending):
                self._size = self._write(data, self._size)
            if not self._over.is_set():
                self._keeper.event(time.monotonic_ns(), "stopped", why=error.strerror)
                self._size = self._write(self._keeper.end(), self._size)
            self._sync(self._file.fileno())
        except OSError as second:
            log.error("%s: closed without its summary: %s", self.path, second)


def _about(info: SourceInfo) -> dict[str, object]:
    return {
        "version": __version__,
        "name": info.name,
        "format": info.format,
        "rate_hz": info.rate_hz,
        "device": info.format if info.duration_s is None else "",
        "assumed": list(info.assumed),
        "serials": dict(info.serials),
        "sensors": {sensor: role.value for sensor, role in info.sensors.items()},
    }


def _new_file(folder: Path, name: str) -> tuple[Path, Any]:
    """A file that did not exist, unbuffered, and its name synced."""
    for number in range(1, 1000):
        path = folder / (f"{name}.mcap" if number == 1 else f"{name}_{number}.mcap")
        with contextlib.suppress(FileExistsError):
            file = path.open("xb", buffering=0)
            with contextlib.suppress(OSError):  # some file systems cannot sync a folder
                descriptor = os.open(folder, os.O_RDONLY)
                os.fsync(descriptor)
                os.close(descriptor)
            return path, file
    raise FileExistsError(17, "too many recordings of this second")


def _file_name(profile: str, source: str) -> str:
    """Date, profile and source: letters, digits, dots and dashes only."""
    kind, _, rest = source.partition(":")
    target = (rest or kind).partition("?")[0]
    stem = Path(target).stem if "/" in target or "." in target else target
    words = (time.strftime("%Y-%m-%dT%H-%M-%S"), profile, stem)
    return "_".join(
        "".join(c if (c.isalnum() and c.isascii()) or c == "-" else "-" for c in w)[:40] for w in words
    )
