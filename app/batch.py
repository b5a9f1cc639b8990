"""Shell: a recording without a browser: read, estimate, tell, write."""

from __future__ import annotations

import time
from dataclasses import asdict
from pathlib import Path
from typing import NamedTuple

import numpy as np

from app.estimator.smoother import finish
from app.estimator.tracker import Tracker, store
from app.motion import Floats, Recording, Samples
from app.outputs import tables
from app.settings import Settings
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from app.warm import warm_up


class Processed(NamedTuple):
    """A recording with one tracker for each of its sensors, and the seconds spent estimating."""

    recording: Recording
    settings: Settings
    trackers: dict[str, Tracker]
    estimator_s: float


def process(spec: str, settings: Settings) -> Processed:
    """Read and estimate a whole recording: the same compiled steps as live."""
    recording, _ = open_recording(parse_spec(spec))
    warm_up()  # so that the seconds told are the estimator's, not the compiler's
    estimator_s = 0.0
    trackers = {}
    for sensor in recording.sensors:
        samples = store(sensor)
        tracker = Tracker(settings)
        began = time.perf_counter()
        tracker.advance(samples)
        finish(tracker, samples)
        estimator_s += time.perf_counter() - began
        trackers[sensor.sensor] = tracker
    return Processed(recording, settings, trackers, estimator_s)


def summary(done: Processed) -> dict[str, object]:
    """What ``process --json`` prints (contract.md)."""
    sensors = done.recording.sensors
    return {
        "recording": done.recording.name,
        "format": done.recording.format,
        "assumed": list(done.recording.assumed),
        "samples": sum(len(sensor) for sensor in sensors),
        "dropped_rows": done.recording.dropped_rows,
        "duration_s": done.recording.duration_s,
        "rate_hz": sensors[0].rate_hz if sensors else 0.0,
        "estimator_s": done.estimator_s,
        "settings": asdict(done.settings),
        "feet": {sensor: foot_summary(tracker) for sensor, tracker in done.trackers.items()},
    }


def foot_summary(tracker: Tracker) -> dict[str, object]:
    """One foot's figures."""
    rows = tracker.rows.table(tracker.rows.start, tracker.rows.end)
    end = rows[-1, :3].tolist() if len(rows) else [0.0, 0.0, 0.0]
    closure_m = float(np.hypot(end[0], end[1]))
    return {
        "strides": tracker.stride_count,
        "distance_m": tracker.distance_m,
        "end_ned_m": end,
        "closure_m": closure_m,
        "closure_pct": 100.0 * closure_m / tracker.distance_m if tracker.distance_m else None,
        "height_range_m": float(np.ptp(rows[:, 2])) if len(rows) else 0.0,
        "stance_fraction": float(np.mean(rows[:, 10] == 0.0)) if len(rows) else 0.0,
        "segments": 1 + len(tracker.segments),
    }


def write(done: Processed, folder: Path) -> list[Path]:
    """Write trajectory and strides into a folder."""
    first_ns = min((sensor.device_ns for sensor in done.recording.sensors), default=0)
    return tables.write(folder, [_table(sensor, done, first_ns) for sensor in done.recording.sensors])


def _table(sensor: Samples, done: Processed, first_ns: int) -> tables.FootTable:
    tracker = done.trackers[sensor.sensor]
    rows = tracker.rows.table(tracker.rows.start, tracker.rows.end)
    offset_s = (sensor.device_ns - first_ns) * 1e-9
    t_s: Floats = ((sensor.device_ns - first_ns) + sensor.matrix[:, 0]) * 1e-9
    return tables.FootTable(sensor.sensor, t_s, rows, tracker.strides, offset_s)


def lines(done: Processed) -> list[str]:
    """The result for a person."""
    recording = done.recording
    samples = sum(len(sensor) for sensor in recording.sensors)
    text = [
        f"{recording.name} ({recording.format}): {samples} samples, {recording.duration_s:.1f} s at"
        f" {recording.sensors[0].rate_hz:.0f} Hz, {recording.dropped_rows} rows dropped"
    ]
    text += [f"  {sentence}" for sentence in recording.assumed]
    for name, tracker in done.trackers.items():
        foot = foot_summary(tracker)
        percent = "" if foot["closure_pct"] is None else f" ({foot['closure_pct']:.2f} %)"
        text.append(
            f"  {name}: {foot['strides']} strides, {foot['distance_m']:.2f} m, ends {foot['closure_m']:.2f} m"
            f"{percent} from its start, height range {foot['height_range_m']:.2f} m"
        )
    return text
