"""Benchmarks: the town mode, when each place was decided, and how long new ones waited: ``PORT FILE …``."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from app.__main__ import main as stridescope
from app.motion.samples import Sample
from app.scene.mover_page import MoverScene
from app.scene.mover_view import in_view
from app.visiting import Visiting

decided: list[tuple[float, ...]] = []
waits_ns: list[int] = []


class Watch:
    """When the newest decision was taken: by a frame, and by a sensor's sample that no frame has shown."""

    frame_ns = 0
    sample_ns: int | None = None


def note_decisions(watch: Watch) -> None:
    """In the real visit, as it goes on."""
    decide, take = Visiting.decide, Visiting.take

    def taken(visiting: Visiting, sample: Sample) -> None:
        take(visiting, sample)
        if visiting.news and watch.sample_ns is None:
            watch.sample_ns = time.monotonic_ns()

    def by_frame(visiting: Visiting, now_ns: int) -> None:
        decide(visiting, now_ns)
        watch.frame_ns = time.monotonic_ns()
        if watch.sample_ns is not None:
            waits_ns.append(watch.frame_ns - watch.sample_ns)
            watch.sample_ns = None

    Visiting.decide, Visiting.take = by_frame, taken  # type: ignore[method-assign, assignment]


def note_places(watch: Watch) -> None:
    """Where each decision led to."""
    move = MoverScene.move

    def moved(scene: MoverScene, north: float, east: float, heading_rad: float, eye_m: float) -> None:
        wxyz, position = in_view(north, east, heading_rad, eye_m)
        decided.append((watch.frame_ns, *position, *wxyz))
        move(scene, north, east, heading_rad, eye_m)

    MoverScene.move = moved  # type: ignore[method-assign, assignment]


def main() -> None:
    """Walk until SIGINT; then write the log. What follows port and file goes to ``stridescope mover``."""
    port, file, *more = sys.argv[1:]
    watch = Watch()
    note_decisions(watch)
    note_places(watch)
    stridescope(["mover", "--no-open", "--port", port, *more])
    np.savez(Path(file), samples=np.array(decided), waits_ns=np.array(waits_ns, dtype=np.int64))


if __name__ == "__main__":
    main()
