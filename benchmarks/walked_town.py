"""Benchmarks: the town mode, and when each pose of ``/world`` was decided: ``PORT FILE``."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from app.__main__ import main as stridescope
from app.scene.mover_page import MoverScene
from app.scene.mover_view import in_view
from app.visit import Visit

decided: list[tuple[float, ...]] = []


def main() -> None:
    """Walk until SIGINT; then write the log."""
    port, file = sys.argv[1], Path(sys.argv[2])
    move = MoverScene.move

    def logged(scene: MoverScene, visit: Visit) -> None:
        wxyz, position = in_view(visit.north, visit.east, visit.heading_rad, visit.eye_m)
        decided.append((visit.t_s * 1e9, *position, *wxyz))
        move(scene, visit)

    MoverScene.move = logged  # type: ignore[method-assign,assignment]
    stridescope(["mover", "--no-open", "--port", port])
    np.savez(file, samples=np.array(decided))


if __name__ == "__main__":
    main()
