"""Edge to the operating system: what the process uses, and the walk's numbers, for who runs it."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from app.motion.door import Measure
from app.motion.health import Health
from app.motion.snapshot import Snapshot
from app.motion.source import Link
from app.motion.status import RecorderState, Status

PREFIX = "stridescope"
STATM = Path("/proc/self/statm")  # Linux only


def measures(snapshot: Snapshot | None, status: Status | None, frames: int) -> Iterator[Measure]:
    """Everything by name, from what was drawn last; nothing of the walk before the first frame."""
    yield _measure("frames_total", "Frames drawn", frames)
    yield from _process()
    if snapshot is None or status is None:
        return
    for sensor, health in snapshot.health.items():
        yield from _sensor(sensor, health)
    yield _measure("stored_bytes", "Samples and rows kept in memory", snapshot.stored_bytes)
    yield _measure(
        "stored_budget_bytes", "What they may take; beyond it the oldest go", snapshot.budget_bytes
    )
    for link in Link:
        words = (("state", link.value),)
        yield _measure("link", "1 for the state that the source is in", status.link is link, words)
    yield _measure("stale_seconds", "Since the last sample, while live", status.stale_s)
    yield from _recording(status.recording)


def _sensor(sensor: str, health: Health) -> Iterator[Measure]:
    labels = (("sensor", sensor),)
    yield _measure("samples_total", "Samples taken", health.taken, labels)
    yield _measure("sample_rate_hertz", "Samples a second, lately", health.rate_hz, labels)
    yield _measure("saturated_total", "Samples at the end of a sensor's range", health.saturated, labels)
    yield _measure("segments_total", "Stretches without an interruption", health.segments, labels)
    for why, count in health.dropped.items():
        yield _measure("dropped_total", "Samples dropped", count, (*labels, ("why", why)))
    if health.recent is not None:
        yield _measure("lost_10s", "Samples missing in the last ten seconds", health.recent.lost, labels)


def _recording(state: RecorderState | None) -> Iterator[Measure]:
    yield _measure("recording", "1 while a recording is written", state is not None and state.on)
    if state is not None:
        yield _measure("recording_seconds", "Length of the newest recording", state.seconds)
        yield _measure("recording_bytes", "Its size", state.size_bytes)
        yield _measure("disk_free_bytes", "Free on its disk", state.free_bytes)
        yield _measure("recording_trouble", "1 when it cannot be written", bool(state.trouble))


def _process() -> Iterator[Measure]:
    yield Measure("process_cpu_seconds_total", "Processor time of the program", time.process_time())
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield _measure(
        "memory_peak_bytes", "Most memory ever used", peak * (1 if sys.platform == "darwin" else 1024)
    )
    if STATM.exists():
        pages = int(STATM.read_text("ascii").split()[1])
        what = "Memory used now"
        yield Measure("process_resident_memory_bytes", what, pages * resource.getpagesize())


def _measure(name: str, what: str, value: float, labels: tuple[tuple[str, str], ...] = ()) -> Measure:
    return Measure(f"{PREFIX}_{name}", what, float(value), labels)
