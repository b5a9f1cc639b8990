"""Benchmarks: accuracy on simulated walks, whose truth is a closed form, and on measured ones."""

from __future__ import annotations

import numpy as np

from app.estimator.together import BESIDE_M
from app.estimator.tracker import track
from app.settings import BUILT_IN, Settings
from app.shell import batch
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from benchmarks import honesty, kinds, measured, mocap, north, peers
from benchmarks import insoles as soles
from benchmarks.figures import Figure, Section

#: What each profile is held to: Vicon mean m, median %, worst m, PyShoe's own metric m; corridor mean %,
#: worst %; closure of the short walk %.
WANTED = {
    "papers": (None, 0.85, None, None, None, None, 1.7),
    "default": (0.085, 0.30, 0.27, 0.054, 0.33, 0.7, 0.3),
    "hindsight": (0.07, 0.25, 0.20, 0.045, 0.30, 0.6, 0.2),
}


def accuracy() -> Section:
    """All of it: the papers' profile on simulated walks, every built-in profile on every measured walk."""
    settings = BUILT_IN["papers"]
    yield from simulated("papers model, 50 Hz, 120 m", "sim:walk?model=papers&rate_hz=50", 0.10, settings)
    yield from simulated("smooth model, 400 Hz, 120 m", "sim:walk?model=smooth&rate_hz=400", 0.05, settings)
    if not measured.DATA.is_dir():
        yield Figure("measured walks", None, note="../shared/data is not there")
        return
    for profile, wanted in WANTED.items():
        yield from walked(profile, BUILT_IN[profile], wanted)
        yield from gait(profile, BUILT_IN[profile])
        yield from loops(profile, BUILT_IN[profile])
    for profile in ("default", "hindsight"):
        yield from together(profile, BUILT_IN[profile])
    covered = honesty.coverage(BUILT_IN["default"])
    yield Figure(
        "default: Vicon room: truth inside the 95 % ellipse", covered, "%", 90.0, True, "wanted: 90 to 99"
    )
    yield from beside("imufusion with ZUPT", peers.with_imufusion)
    if peers.has_gaitmap():
        yield from beside("gaitmap RtsKalman", peers.with_gaitmap)
    else:
        yield Figure("gaitmap RtsKalman", None, note=f"not installed: {peers.GAITMAP} is not there")


def gait(profile: str, settings: Settings) -> Section:
    """Strides: their length beside motion capture's, and whether each that an insole feels is found."""
    limit = {"default": 35.0, "hindsight": 30.0}.get(profile)
    away = [length.found_m - length.true_m for length in mocap.lengths(settings)]
    note = f"{len(away)} strides, {1000 * float(np.mean(away)):+.1f} mm on average"
    mean_mm = 1000 * float(np.mean(np.abs(away)))
    yield Figure(f"{profile}: stride length beside motion capture, mean", mean_mm, "mm", limit, note=note)
    feet = list(soles.insoles(settings))
    true, found, both = (
        sum(int(count) for count in counts) for counts in zip(*(foot[1:] for foot in feet), strict=True)
    )
    wanted = None if limit is None else 99.0
    for name, whole in (("recall", true), ("precision", found)):
        share = 100.0 * both / max(whole, 1)
        what = f"{profile}: strides that insoles feel, {name}"
        yield Figure(what, share, "%", wanted, True, f"{both} of {whole}")


#: A walk of the loops' sensor, on another occasion, that starts still.
TAUGHT_BY = "hallway_gcp/SensorConnectData_31.csv"


def loops(profile: str, settings: Settings) -> Section:
    """The corridor loops together, with no bias given and with one remembered from another recording."""
    if settings.estimator != "kalman":
        return
    for how, taught, wanted in (("no bias given", None, 1.5), (f"bias of {TAUGHT_BY}", TAUGHT_BY, 0.6)):
        percents = [foot["closure_pct"] for _, foot in measured.closures("hallway_loops", settings, taught)]
        note = ", ".join(f"{percent:.2f}" for percent in percents)
        mean = float(np.mean(percents))
        yield Figure(f"{profile}: hallway_loops, {how}: closure, mean", mean, "%", wanted, note=note)


def together(profile: str, settings: Settings) -> Section:
    """Two feet of one walk: how far apart they come, side by side at the start."""
    path = measured.DATA / "gaitmap_feet" / "imu_sample.csv"
    done = batch.process(str(path), settings)
    left, right = (done.trackers[name].rows for name in ("left", "right"))
    count = min(left.end, right.end)
    away = right.table(0, count)[:, :2] + np.array([0.0, BESIDE_M]) - left.table(0, count)[:, :2]
    note = "linked" if done.linked else "not linked"
    far = float(np.hypot(away[:, 0], away[:, 1]).max())
    yield Figure(f"{profile}: gaitmap_feet imu_sample: feet at most apart", far, "m", note=note)


def beside(name: str, peer: measured.How) -> Section:
    """A peer on the same recordings, scored the same."""
    vicon = [score for score in measured.vicon(peer) if score.name != measured.IN_PLACE]
    corridor = list(measured.corridor(peer))
    mean = float(np.mean([score.rmse_m for score in vicon]))
    yield Figure(f"{name}: Vicon room: RMSE 3-D, mean", mean, "m")
    yield from spread(f"{name}: Vicon room", vicon, None, None)
    yield from spread(f"{name}: corridor", corridor, None, None)


def simulated_kinds() -> Section:
    """10,000 strides of every kind under ``default``: the errors, and whether failures are known."""
    for kind in kinds.kinds(BUILT_IN["default"]):
        percents = [walk.percent for walk in kind.walks]
        p95, failed = float(np.quantile(percents, 0.95)), len(kind.failed)
        note = f"p95 {p95:.2f} %, {failed} of {len(kind.walks)} walks failed"
        yield Figure(f"{kind.name}: RMSE / path, median", float(np.median(percents)), "%", note=note)
        yield Figure(f"{kind.name}: failed and called good", len(kind.unnoticed), "", 0)
    for drift_radps in (north.DRIFT_RADPS, 0.0):
        drifts = f"gyro drifts by {drift_radps:g} rad/s"
        for name, gyro, field, lost in north.held(BUILT_IN["default"], drift_radps):
            note = f"{gyro:.3f} % by the gyro alone; a walk loses {lost:+.3f} % at most"
            yield Figure(f"{name}, {drifts}: RMSE / path, mean", field, "%", note=note)


def walked(profile: str, settings: Settings, wanted: tuple[float | None, ...]) -> Section:
    """Every measured walk under one profile."""
    mean_m, median, worst_m, pyshoe_m, corridor_mean, corridor_worst, closure = wanted
    vicon = list(measured.vicon(settings))
    whole = [score for score in vicon if score.name != measured.IN_PLACE]
    yield from spread(f"{profile}: Vicon room", whole, median, None)
    worst = max(vicon, key=lambda score: score.rmse_m)
    rmse = [score.rmse_m for score in vicon]
    yield Figure(f"{profile}: Vicon room: RMSE 3-D, mean", float(np.mean(rmse)), "m", mean_m)
    yield Figure(f"{profile}: Vicon room: RMSE 3-D, worst", worst.rmse_m, "m", worst_m, note=worst.name)
    own = float(np.mean([score.pyshoe_m for score in vicon]))
    yield Figure(f"{profile}: Vicon room: PyShoe's own metric, mean", own, "m", pyshoe_m)
    corridor = list(measured.corridor(settings))
    yield from spread(f"{profile}: corridor", corridor, None, corridor_worst)
    mean = float(np.mean([score.percent for score in corridor]))
    yield Figure(f"{profile}: corridor: RMSE / path, mean", mean, "%", corridor_mean)
    true, found = sum(s.true_strides for s in corridor), sum(s.strides for s in corridor)
    exact = None if profile == "papers" else float(true)
    yield Figure(f"{profile}: corridor: strides", found, "", exact, True, f"of {true}")
    rise = max(corridor, key=lambda score: abs(score.rise_m / score.path_m))
    height_limit = {"default": 0.5, "hindsight": 0.3}.get(profile)
    percent = 100.0 * abs(rise.rise_m) / rise.path_m
    yield Figure(f"{profile}: corridor: height at the end, worst", percent, "%", height_limit, note=rise.name)
    if settings.estimator == "kalman":
        free = list(measured.corridor(settings.with_changes({"same_floor_m": 0.0})))
        percent = max(100.0 * abs(score.rise_m) / score.path_m for score in free)
        yield Figure(f"{profile}: the same with no floor in mind (same_floor_m 0)", percent, "%")
    length = max(corridor, key=lambda score: abs(score.length_percent))
    yield Figure(
        f"{profile}: corridor: path too long by, worst", length.length_percent, "%", note=length.name
    )
    yield from closures(profile, settings, closure)


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


def spread(name: str, scores: list[measured.Score], median: float | None, worst: float | None) -> Section:
    """Median and worst of the recordings' errors, in per cent of the path."""
    if not scores:
        yield Figure(name, None, note="no recordings there")
        return
    percents = [score.percent for score in scores]
    last = scores[int(np.argmax(percents))]
    note = f"{len(scores)} recordings"
    yield Figure(f"{name}: RMSE / path, median", float(np.median(percents)), "%", median, note=note)
    yield Figure(f"{name}: RMSE / path, worst", last.percent, "%", worst, note=last.name)


def closures(profile: str, settings: Settings, wanted: float | None) -> Section:
    """Walks without a measured path: how far from the start they end, or just how long they are."""
    for folder, limit in (("xio_ngimu", wanted), ("hallway_loops", None)):
        for name, foot in measured.closures(folder, settings):
            note = f"{foot['closure_m']:.2f} m of {foot['distance_m']:.1f} m, {foot['strides']} strides"
            yield Figure(f"{profile}: {folder} {name}: closure", foot["closure_pct"], "%", limit, note=note)
    for folder in ("xio_ximu", "gaitmap_feet"):
        for name, foot in measured.closures(folder, settings):
            note = f"{foot['strides']} strides, height range {foot['height_range_m']:.2f} m"
            yield Figure(f"{profile}: {folder} {name}: distance", foot["distance_m"], "m", note=note)
