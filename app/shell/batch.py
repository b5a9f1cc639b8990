"""Shell: a recording without a browser: read, estimate, tell, write."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from app.estimator.bias import learnt
from app.estimator.feet import Worn, link_worn
from app.estimator.linking import link_walked
from app.estimator.smoother import finish
from app.estimator.tracker import Tracker, store, track
from app.gestures.default import DefaultDecoder
from app.gestures.merge import changes, decode
from app.gestures.papers import PapersDecoder
from app.gestures.words import Decision
from app.motion.basics import Floats, InputError, Role
from app.motion.commands import KnowBias
from app.motion.estimate import ATTITUDE, Trust
from app.motion.recording import Recording
from app.motion.samples import ClockLine, GyroBias, Samples
from app.outputs import tables
from app.settings import Settings
from app.sources.files import load, printable
from app.sources.opening import open_recording
from app.sources.spec import Spec, parse_spec
from app.studies.words import Task
from app.warm import warm_hindsight, warm_up
from app.workers import Tell, run_all


class Processed(NamedTuple):
    """A recording with one tracker for each of its sensors, and the seconds spent estimating."""

    recording: Recording
    settings: Settings
    trackers: dict[str, Tracker]
    estimator_s: float
    linked: bool = False  # two feet have one heading


def process(spec: str, settings: Settings, bias_from: str | None = None) -> Processed:
    """Read and estimate a whole recording: the same compiled steps as live.

    ``bias_from`` is another recording of the same sensors, whose gyro biases this one begins with.
    """
    recording, _ = open_recording(parse_spec(spec))
    biases = biases_of(bias_from, recording, settings) if bias_from else {}
    return estimate(recording, settings, biases)


def biases_of(spec: str, wanted: Recording, settings: Settings) -> dict[str, GyroBias]:
    """The gyro biases that a recording tells, for the sensors of ``wanted``."""
    recording, _ = open_recording(parse_spec(spec))
    told = {}
    for samples in recording.sensors:
        name = samples.sensor
        serials = [source.serials.get(name) for source in (recording, wanted)]
        if None not in serials and serials[0] != serials[1]:
            raise InputError(f"{spec}: sensor {serials[0]}, expected {serials[1]}, the one of {wanted.name}")
        bias = learnt(track(samples, replace(settings, estimator="kalman")))
        if bias is not None:
            told[name] = bias
    if not set(told) & {samples.sensor for samples in wanted.sensors}:
        raise InputError(
            f"{spec}: tells no gyro bias of {wanted.name}: expected the same sensor, at rest for a second"
        )
    return told


def estimate(
    recording: Recording, settings: Settings, biases: Mapping[str, GyroBias] | None = None
) -> Processed:
    """Estimate a whole recording that has been read; its own remembered biases hold where none is given."""
    known = remembered(recording) | dict(biases or {})
    warm_up(settings.estimator)  # so that the seconds told are the estimator's, not the compiler's
    if settings.looks_back:
        warm_hindsight()
    estimator_s = 0.0
    trackers: dict[str, Tracker] = {}
    stores = {}
    for sensor in recording.sensors:
        samples = stores[sensor.sensor] = store(sensor)
        tracker = Tracker(settings, known=known.get(sensor.sensor))
        began = time.perf_counter()
        tracker.advance(samples)
        finish(tracker, samples)
        estimator_s += time.perf_counter() - began
        trackers[sensor.sensor] = tracker
    began = time.perf_counter()
    if settings.looks_back:
        linked = link_worn(trackers, worn(recording), stores, settings.feet_apart_m)
    else:
        linked = link_walked(trackers, worn(recording), settings)
    estimator_s += time.perf_counter() - began
    return Processed(recording, settings, trackers, estimator_s, linked)


def remembered(recording: Recording) -> dict[str, GyroBias]:
    """The gyro biases that a recorded walk of ours began with."""
    orders = recording.journal.orders if recording.journal else ()
    commands = [order.command for _, order in orders]
    told = [command for command in commands if isinstance(command, KnowBias)]
    return {known.sensor: GyroBias(known.rate_b, known.doubt_radps) for known in told}


def worn(recording: Recording) -> dict[str, Worn]:
    """Where each sensor is worn, and its clock beside the others'."""
    found = {}
    for sensor in recording.sensors:
        line = recording.clocks.get(sensor.sensor) or ClockLine(sensor.device_ns, sensor.device_ns)
        found[sensor.sensor] = Worn(sensor.role, line.host(sensor.device_ns) * 1e-9, 1.0 + line.slope)
    return found


def summary(done: Processed) -> dict[str, object]:
    """What ``process --json`` prints."""
    sensors = done.recording.sensors
    return {
        "recording": done.recording.name,
        "format": done.recording.format,
        "assumed": list(done.recording.assumed),
        "samples": sum(len(sensor) for sensor in sensors),
        "dropped_rows": done.recording.dropped_rows,
        "dropped": done.recording.dropped,
        "duration_s": done.recording.duration_s,
        "rate_hz": sensors[0].rate_hz if sensors else 0.0,
        "estimator_s": done.estimator_s,
        "settings": asdict(done.settings),
        "feet_linked": done.linked,
        "feet": {sensor: foot_summary(tracker) for sensor, tracker in done.trackers.items()},
    }


class OfFolder(NamedTuple):
    """What became of the files of a folder, in order of their names."""

    folder: str
    summaries: tuple[dict[str, object], ...]
    skipped: tuple[tuple[str, str], ...]  # name, why
    seconds: float  # of all workers together: reading, estimating, writing


def process_folder(
    spec: Spec, settings: Settings, out: Path | None, jobs: int, cluster: str | None, tell: Tell
) -> OfFolder:
    """Every recording of a folder; a file that is none is skipped, and said."""
    folder = Path(spec.target).expanduser()
    try:
        files = sorted(path for path in folder.resolve().iterdir() if path.is_file())
    except OSError as error:
        raise InputError(f"{folder}: cannot be read ({error.strerror}), expected a folder") from None
    place = out.resolve() if out else None
    tasks = [Task(process_file, (path, spec.options, settings, place)) for path in files]
    done = run_all(tasks, jobs, cluster, tell)
    found = [(path.name, d.value) for path, d in zip(files, done, strict=True)]
    if not any(isinstance(value, dict) for _, value in found):
        raise InputError(f"{folder}: no recording among the {len(files)} files of this folder, expected one")
    return OfFolder(
        str(folder),
        tuple(value for _, value in found if isinstance(value, dict)),
        tuple((printable(name), value) for name, value in found if isinstance(value, str)),
        sum(d.seconds for d in done),
    )


def process_file(
    path: Path, options: Mapping[str, str], settings: Settings, out: Path | None
) -> dict[str, object] | str:
    """One file of a folder: its summary, or why there is none; with ``out`` its tables too."""
    try:
        done = estimate(load(path, options), settings)
        if out is not None:
            write(done, out / path.name)
    except InputError as error:
        return str(error)
    return summary(done)


def folder_summary(done: OfFolder) -> dict[str, object]:
    """What ``process FOLDER --json`` prints."""
    return {
        "folder": done.folder,
        "recordings": list(done.summaries),
        "skipped": [{"file": name, "why": why} for name, why in done.skipped],
        "seconds": done.seconds,
        "estimator_s": sum(float(str(one["estimator_s"])) for one in done.summaries),
    }


def folder_lines(done: OfFolder) -> list[str]:
    """A folder for a person: a line a foot."""
    text = [f"{done.folder}: {len(done.summaries)} recordings, {len(done.skipped)} files skipped"]
    width = max((len(str(one["recording"])) for one in done.summaries), default=0)
    for one in done.summaries:
        feet: Any = one["feet"]
        for sensor, foot in feet.items():
            share = "" if foot["closure_pct"] is None else f" {foot['closure_pct']:7.2f} %"
            closes = f"closes {foot['closure_m']:8.2f} m{share}"
            word = foot["trust"]["word"] if foot["trust"] else "good"
            doubt = "" if word == "good" else f"  {word}"
            text.append(
                f"  {one['recording']!s:<{width}}  {sensor:<6} {one['duration_s']:7.1f} s"
                f" {foot['strides']:5d} strides {foot['distance_m']:9.2f} m, {closes}{doubt}"
            )
    return text + [f"  skipped {name}: {why}" for name, why in done.skipped]


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
        "trust": sureness(tracker.trust),
    }


def sureness(trust: Trust | None) -> dict[str, object] | None:
    """How sure an estimator is of where its walk ended; None where it does not know."""
    if trust is None:
        return None
    half_axes_m = [trust.major_m, trust.minor_m] if math.isfinite(trust.major_m) else None
    return {"word": trust.word, "why": trust.why, "within_m": half_axes_m}


def write(done: Processed, folder: Path) -> list[Path]:
    """Write trajectory and strides into a folder."""
    return tables.write(folder, foot_tables(done))


def foot_tables(done: Processed) -> list[tables.FootTable]:
    """Every foot's result, its times from the recording's first sample."""
    found = []
    for sensor in done.recording.sensors:
        tracker, offset_ns = done.trackers[sensor.sensor], done.recording.offset_ns(sensor)
        rows = tracker.rows.table(tracker.rows.start, tracker.rows.end)
        t_s: Floats = (offset_ns + sensor.matrix[:, 0]) * 1e-9
        found.append(tables.FootTable(sensor.sensor, t_s, rows, tracker.strides, offset_ns * 1e-9))
    return found


class Decoded(NamedTuple):
    """A recording of two feet and what they asked for: the changes of motion or speed, since it began."""

    recording: Recording
    decoder: str
    decisions: list[Decision]


def decode_gestures(spec: str, name: str) -> Decoded:
    """Read a recording of two feet and decode it; ``InputError`` if a foot is missing."""
    recording, _ = open_recording(parse_spec(spec))
    feet = {samples.role: samples for samples in recording.sensors}
    if not {Role.LEFT, Role.RIGHT} <= set(feet):
        came = ", ".join(samples.sensor for samples in recording.sensors) or "no sensor"
        raise InputError(
            f"{recording.name}: {came}: expected the sensors left and right, for gestures take two feet"
        )
    both = {role: feet[role] for role in (Role.LEFT, Role.RIGHT)}
    both = {role: replace(foot, device_ns=recording.offset_ns(foot)) for role, foot in both.items()}
    if name == "papers":  # the only one that looks at the heading
        found = decode(PapersDecoder(), both, {role: _orientation(samples) for role, samples in both.items()})
    else:
        found = decode(DefaultDecoder(), both)
    return Decoded(recording, name, changes(found))


def _orientation(samples: Samples) -> Floats:
    rows = track(samples, Settings()).rows
    return rows.table(rows.start, rows.end)[:, ATTITUDE]


def gestures_summary(done: Decoded) -> dict[str, object]:
    """What ``gestures --json`` prints."""
    return {
        "recording": done.recording.name,
        "format": done.recording.format,
        "assumed": list(done.recording.assumed),
        "duration_s": done.recording.duration_s,
        "decoder": done.decoder,
        "decisions": [
            {
                "t_s": decision.t_ns * 1e-9,
                "motion_id": int(decision.motion),
                "motion": decision.motion.name.lower(),
                "speed_mps": decision.speed_mps,
                "turn_radps": decision.turn_radps,
                "confidence": decision.confidence,
                "certain": decision.certain,
                "cadence_hz": decision.cadence_hz,
                "reason": decision.reason,
            }
            for decision in done.decisions
        ],
    }


def gestures_lines(done: Decoded) -> list[str]:
    """The decisions for a person."""
    recording = done.recording
    text = [f"{recording.name} ({recording.format}): {recording.duration_s:.1f} s, decoder {done.decoder}"]
    for d in done.decisions:
        doubt = "" if d.certain else ", not yet certain"
        what = f"{d.motion.name.lower()} {d.speed_mps:.2f} m/s{doubt}: {d.reason}"
        text.append(f"  {d.t_ns * 1e-9:8.2f} s  {what}")
    return text


def in_words(trust: Trust | None) -> str:
    """How sure it is, behind a foot's line."""
    if trust is None:
        return ""
    return f"; ± {trust.major_m:.2f} m, {trust.word}" + (f": {trust.why}" if trust.why else "")


def reasons(dropped: Mapping[str, int]) -> str:
    """`` (499 time went backward)``, behind how many."""
    listed = ", ".join(f"{count} {reason}" for reason, count in dropped.items() if count)
    return f" ({listed})" if listed else ""


def lines(done: Processed) -> list[str]:
    """The result for a person."""
    recording = done.recording
    samples = sum(len(sensor) for sensor in recording.sensors)
    text = [
        f"{recording.name} ({recording.format}): {samples} samples, {recording.duration_s:.1f} s at"
        f" {recording.sensors[0].rate_hz:.0f} Hz, {recording.dropped_rows} rows"
        f" dropped{reasons(recording.dropped)}"
    ]
    text += [f"  {sentence}" for sentence in recording.assumed]
    for name, tracker in done.trackers.items():
        foot = foot_summary(tracker)
        percent = "" if foot["closure_pct"] is None else f" ({foot['closure_pct']:.2f} %)"
        text.append(
            f"  {name}: {foot['strides']} strides, {foot['distance_m']:.2f} m, ends {foot['closure_m']:.2f} m"
            f"{percent} from its start, height range {foot['height_range_m']:.2f} m{in_words(tracker.trust)}"
        )
    return text
