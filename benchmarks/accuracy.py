"""Benchmarks: accuracy on simulated walks, whose truth is a closed form, and on measured ones."""

from __future__ import annotations

import numpy as np

from app.estimator.tracker import track
from app.settings import Settings
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from benchmarks import measured
from benchmarks.figures import Figure, Section


def accuracy() -> Section:
    """All of it, with one setting: the built-in profile ``papers``."""
    settings = Settings()
    yield from simulated("papers model, 50 Hz, 120 m", "sim:walk?model=papers&rate_hz=50", 0.10, settings)
    yield from simulated("smooth model, 400 Hz, 120 m", "sim:walk?model=smooth&rate_hz=400", 0.05, settings)
    if not measured.DATA.is_dir():
        yield Figure("measured walks", None, note="../shared/data is not there")
        return
    vicon = list(measured.vicon(settings))
    whole = [score for score in vicon if score.name != measured.IN_PLACE]
    yield from spread("Vicon room", whole, 0.85)
    yield Figure("Vicon room: RMSE 3-D, mean", float(np.mean([s.rmse_m for s in vicon])), "m")
    corridor = list(measured.corridor(settings))
    yield from spread("corridor", corridor, 0.90)
    yield Figure("corridor: RMSE 2-D, mean", float(np.mean([s.rmse_m for s in corridor])), "m")
    yield from closures(settings)


def simulated(name: str, spec: str, wanted_m: float, settings: Settings) -> Section:
    """A noise-free straight walk of 100 strides against its truth."""
    recording, truth = open_recording(parse_spec(spec))
    assert truth is not None
    (samples,) = recording.sensors
    tracker = track(samples, settings)
    end = tracker.rows.table(tracker.rows.end - 1, tracker.rows.end)[0, :3]
    true_end = truth(samples.sensor, samples.matrix[-1:, 0] * 1e-9)[0][0]
    away = end - true_end
    yield Figure(f"{name}: horizontal end error", float(np.hypot(away[0], away[1])), "m", wanted_m)
    yield Figure(f"{name}: strides of 100", tracker.stride_count, "", 100, True)
    yield Figure(f"{name}: height at the end, too high by", -float(away[2]), "m")


def spread(name: str, scores: list[measured.Score], wanted: float) -> Section:
    """Median and worst of the recordings' errors, in per cent of the path."""
    if not scores:
        yield Figure(name, None, note="no recordings there")
        return
    percents = [score.percent for score in scores]
    worst = scores[int(np.argmax(percents))]
    note = f"{len(scores)} recordings"
    yield Figure(f"{name}: RMSE / path, median", float(np.median(percents)), "%", wanted, note=note)
    yield Figure(f"{name}: RMSE / path, worst", worst.percent, "%", note=worst.name)


def closures(settings: Settings) -> Section:
    """Walks without a measured path: how far from the start they end, or just how long they are."""
    for folder, wanted in (("xio_ngimu", 1.7), ("hallway_loops", None)):
        for name, foot in measured.closures(folder, settings):
            note = f"{foot['closure_m']:.2f} m of {foot['distance_m']:.1f} m, {foot['strides']} strides"
            yield Figure(f"{folder} {name}: closure", foot["closure_pct"], "%", wanted, note=note)
    for folder in ("xio_ximu", "gaitmap_feet"):
        for name, foot in measured.closures(folder, settings):
            note = f"{foot['strides']} strides, height range {foot['height_range_m']:.2f} m"
            yield Figure(f"{folder} {name}: distance", foot["distance_m"], "m", note=note)
