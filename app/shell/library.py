"""Shell: recordings as files: what is in one, what is left of a damaged one, and as other formats."""

from __future__ import annotations

import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from app.formats import mcap
from app.formats.kept import Kept, kept, lost_seqs
from app.formats.recover import Recovered
from app.formats.recover import recover as recovered
from app.motion.basics import Floats, Role
from app.motion.recording import Journal, Recording
from app.motion.samples import GAP_NS, Samples
from app.outputs.files import beside, write_new
from app.sources.files import read_bytes
from app.sources.opening import open_recording
from app.sources.spec import parse_spec


def recover(text: str) -> tuple[Path, Recovered]:
    """Every whole chunk of a damaged recording in a new file beside it; the damaged one stays."""
    path = Path(text).expanduser()
    made = recovered(path.name, read_bytes(path))
    into = beside(path, "recovered")
    write_new(into, made.data)
    return into, made


def info(spec_text: str) -> dict[str, Any]:
    """What ``info --json`` prints: duration, rates, losses, and for a recording of ours all it knows."""
    spec = parse_spec(spec_text)
    recording, _ = open_recording(spec)
    told: dict[str, Any] = {
        "recording": recording.name,
        "format": recording.format,
        "assumed": list(recording.assumed),
        "duration_s": recording.duration_s,
        "dropped_rows": recording.dropped_rows,
        "sensors": {samples.sensor: _sensor(samples) for samples in recording.sensors},
    }
    data = read_bytes(Path(spec.target).expanduser()) if recording.journal else b""
    if mcap.recognises(data):
        told |= _ours(recording, kept(recording.name, data))
        told["size_bytes"] = len(data)
    return told


def _sensor(samples: Samples) -> dict[str, Any]:
    return {
        "role": samples.role.value,
        "samples": len(samples),
        "dropped": dict(samples.dropped),
        "saturated": int((samples.saturation != 0).sum()),
    } | _missing(samples)


def _missing(samples: Samples) -> dict[str, int | float]:
    """What the stamps tell: the rate, samples missing between two, and gaps that part segments."""
    steps_ns = np.diff(samples.matrix[:, 0])
    usual_ns = _usual_ns(steps_ns) if len(steps_ns) else 0.0
    gaps = steps_ns > GAP_NS
    short = steps_ns[~gaps & (steps_ns > 1.5 * usual_ns)]
    missing = int((np.round(short / usual_ns) - 1.0).sum()) if len(short) else 0
    rate = {"rate_hz": 1e9 / usual_ns if usual_ns else 0.0}
    return rate | {"missing": missing, "gaps": int(gaps.sum()), "gaps_s": float(steps_ns[gaps].sum()) * 1e-9}


def _usual_ns(steps_ns: Floats) -> float:
    """From one sample to the next: where more than half of them are missing, a part of the median."""
    median_ns = float(np.median(steps_ns))
    for parts in (4, 3, 2):
        steps = steps_ns * parts / median_ns
        whole = np.abs(steps - np.round(steps)) < 0.1
        if whole.mean() > 0.9 and (np.round(steps) == 1.0).mean() > 0.1:
            return median_ns / parts
    return median_ns


def _ours(recording: Recording, found: Kept) -> dict[str, Any]:
    journal = recording.journal
    assert journal is not None
    clock_ns = found.about.get("clock_ns")
    firsts = [int(readings.host_ns[0]) for readings in found.readings]
    began = (min(firsts) + clock_ns) * 1e-9 if firsts and isinstance(clock_ns, int) else None
    return {
        "closed": found.closed,
        "began": None if began is None else time.strftime("%Y-%m-%dT%H:%M:%S", time.localtime(began)),
        "about": found.about,
        "temperature_c": _temperatures(journal),
        "lost": {readings.sensor: lost_seqs(readings) for readings in found.readings},
        "messages": found.messages,
        "settings": asdict(journal.settings),
        "changes": [
            {"after_samples": place, "who": order.who, "what": type(order.command).__name__}
            | asdict(order.command)
            for place, order in journal.orders
        ],
        "markers": [{"t_s": t_s, "text": text} for t_s, text in journal.markers],
        "events": list(found.events),
    }


def _warmth(told: dict[str, Any], sensor: str) -> str:
    read = told.get("temperature_c", {}).get(sensor)
    return f", {read['first']:.1f} °C at first, {read['last']:.1f} °C at last" if read else ""


def _temperatures(journal: Journal) -> dict[str, dict[str, float]]:
    """What each sensor's thermometer read, °C; nothing of those that told nothing."""
    read: dict[str, list[float]] = {}
    for _, sensor, celsius in journal.temperatures:
        read.setdefault(sensor, []).append(celsius)
    return {
        sensor: {"first": all_[0], "last": all_[-1], "least": min(all_), "most": max(all_)}
        for sensor, all_ in read.items()
    }


def _named(sensor: str, role: str) -> str:
    """A sensor, and which foot a tap or its source said it is on, where its name does not."""
    return sensor if role in (sensor, Role.OTHER.value) else f"{sensor} ({role})"


def lines(told: dict[str, Any]) -> list[str]:
    """The same for a person."""
    text = [f"{told['recording']} ({told['format']}): {told['duration_s']:.1f} s"]
    for sensor, figures in told["sensors"].items():
        lost = max(told.get("lost", {}).get(sensor, 0), figures["missing"])
        count = figures["gaps"]
        gaps = f", {count} gap{'s' * (count > 1)} of {figures['gaps_s']:.1f} s" if count else ""
        dropped = sum(figures["dropped"].values())
        why = f" ({', '.join(figures['dropped'])})" if dropped else ""
        name = _named(sensor, figures["role"])
        text.append(
            f"  {name}: {figures['samples']} samples at {figures['rate_hz']:.1f} Hz, {lost} lost,"
            f" {dropped} dropped{why}, {figures['saturated']} saturated{gaps}{_warmth(told, sensor)}"
        )
    text += [f"  {sentence}" for sentence in told["assumed"]]
    if "began" in told:
        text.append(f"  began {told['began'] or 'at an unknown time'}, {told['size_bytes'] / 1e6:.2f} MB")
        text.append(f"  settings: {', '.join(f'{key}={value}' for key, value in told['settings'].items())}")
    text += [
        f"  after {change['after_samples']} samples {change['who']}: {change['what']}"
        for change in told.get("changes", ())
    ]
    text += [f"  marker at {mark['t_s']:.1f} s: {mark['text']}" for mark in told.get("markers", ())]
    return [
        " ".join(line.split()) if not line.startswith("  ") else "  " + " ".join(line.split())
        for line in text
    ]
