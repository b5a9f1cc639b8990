"""Benchmarks: which sample is the pose that arrived? Found by its value; every sample has its own."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from app.motion.basics import Floats
from benchmarks.client import Frame, messages

Key = tuple[float, ...]
Arrival = tuple[float, Key]  # monotonic ns, pose

DIGITS = 9


class Latency(NamedTuple):
    """Milliseconds from each shown sample's release to its arrival, and poses that were no sample's."""

    ms: Floats
    unknown: int
    frames_hz: float

    def percentile(self, percent: float) -> float:
        """The latency that so many per cent of the shown poses stay below."""
        return float(np.percentile(self.ms, percent))


def key(numbers: Iterable[float]) -> Key:
    """A pose as it can be looked up: position, then a unit quaternion."""
    pose = np.array([*numbers])
    pose[3:] /= np.linalg.norm(pose[3:])
    return tuple((np.round(pose, DIGITS) + 0.0).tolist())


def released(path: Path) -> dict[Key, float]:
    """Pose → when the first sample that led to it was released (``stopwatch`` and ``bare`` write it)."""
    table = np.load(path)["samples"]
    return {key(row[1:]): float(row[0]) for row in table[::-1]}


def latency(arrivals: list[Arrival], releases: dict[Key, float]) -> Latency:
    """Match what arrived with what was released."""
    first: dict[Key, float] = {}
    for at_ns, pose in arrivals:
        first.setdefault(pose, at_ns)
    known = [(at_ns - releases[pose]) * 1e-6 for pose, at_ns in first.items() if pose in releases]
    span_s = (arrivals[-1][0] - arrivals[0][0]) * 1e-9 if len(arrivals) > 1 else 1.0
    return Latency(np.array(known), len(first) - len(known), (len(first) - 1) / span_s)


def poses(frames: list[Frame], node: str) -> list[Arrival]:
    """The pose of a node after each websocket frame that moved it."""
    position, wxyz = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)
    arrivals = []
    for frame in frames:
        moved = False
        for message in messages(frame.data):
            if message.get("name") == node:
                position, wxyz, moved = *_moved(message, position, wxyz), True
        if moved:
            arrivals.append((float(frame.at_ns), key((*position, *wxyz))))
    return arrivals


def _moved(message: dict[str, Any], position: Any, wxyz: Any) -> tuple[Any, Any]:
    return message.get("position", position), message.get("wxyz", wxyz)
