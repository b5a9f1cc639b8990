"""Benchmarks: the walk viewer in a process of its own, with a stopwatch in it.

``python -m benchmarks.stopwatch SPEC PORT [--samples FILE] [--windows FILE]``. It is the real viewer; only
what goes in (``Session.take``) and what goes out (``Scene.draw``) is timed on the way.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import statistics
import time
from pathlib import Path

import numpy as np

from app.door.access import Access
from app.motion.estimate import ATTITUDE, POSITION
from app.motion.samples import Sample
from app.motion.snapshot import Snapshot
from app.motion.status import Status
from app.scene.page import Scene
from app.session import Session
from app.settings import Settings
from app.shell import run
from app.sources.opening import open_source

WINDOW_S = 5.0


class TimedScene(Scene):
    """Notes when each frame is drawn, and every few seconds what a frame costs."""

    drawn: list[tuple[int, int]] = []  # noqa: RUF012  (one scene a process)
    windows: Path | None = None
    session: Session
    _began_s = 0.0
    _spent_s: list[float] = []  # noqa: RUF012
    _snapshots_s: list[float] = []  # noqa: RUF012

    def draw(self, snapshot: Snapshot, status: Status) -> None:
        """Draw, timed."""
        began_ns, began_s = time.monotonic_ns(), time.thread_time()
        super().draw(snapshot, status)
        self._spent_s.append(time.thread_time() - began_s)
        if self.windows is None:
            self.drawn.append((began_ns, time.monotonic_ns()))
        elif time.monotonic() > self._began_s + WINDOW_S:
            self._note(snapshot)

    def _note(self, snapshot: Snapshot) -> None:
        window = {
            "t_s": snapshot.t_s,
            "stored_bytes": snapshot.stored_bytes,
            "strides": sum(foot.strides for foot in snapshot.main.feet),
            "frames_hz": len(self._spent_s) / (time.monotonic() - self._began_s),
            "draw_us": 1e6 * statistics.median(self._spent_s),
            "snapshot_us": 1e6 * statistics.median(self._snapshots_s or [0.0]),
            "processor_s": time.process_time(),
        }
        assert self.windows is not None
        with self.windows.open("a") as file:
            file.write(json.dumps(window) + "\n")
        self._began_s = time.monotonic()
        self._spent_s.clear()
        self._snapshots_s.clear()


def note_samples(session: Session, noted: list[tuple[float, ...]]) -> None:
    """After each sample: when its source released it, and the pose it led to."""
    take = session.take

    def timed(sample: Sample) -> None:
        take(sample)
        rows = session.main.feet[sample.sensor].tracker.rows
        block, place = rows.block(rows.end - 1)
        noted.append((sample.host_ns, *block[place, POSITION].tolist(), *block[place, ATTITUDE].tolist()))

    session.take = timed  # type: ignore[method-assign]


def note_snapshots(session: Session) -> None:
    """What a snapshot costs."""
    snapshot = session.snapshot

    def timed() -> Snapshot:
        began_s = time.thread_time()
        result = snapshot()
        TimedScene._snapshots_s.append(time.thread_time() - began_s)
        return result

    session.snapshot = timed  # type: ignore[method-assign]


def main() -> None:
    """Serve until SIGINT or SIGTERM; then write the samples' times."""
    parser = argparse.ArgumentParser()
    parser.add_argument("spec")
    parser.add_argument("port", type=int)
    parser.add_argument("--samples", type=Path)
    parser.add_argument("--windows", type=Path)
    asked = parser.parse_args()
    viewer = run.Viewer(
        run.Options(asked.spec, Settings(), Access(port=asked.port), open_browser=False),
        open_source(asked.spec),
    )
    noted: list[tuple[float, ...]] = []
    if asked.samples:
        note_samples(viewer.walk.session, noted)
    if asked.windows:
        TimedScene.windows = asked.windows
        note_snapshots(viewer.walk.session)
    setattr(run, "Scene", TimedScene)  # noqa: B010  (the shell makes its own)
    asyncio.run(viewer.serve(lambda line: print(line, flush=True)))
    if asked.samples:
        np.savez(asked.samples, samples=np.array(noted), drawn=np.array(TimedScene.drawn))


if __name__ == "__main__":
    main()
