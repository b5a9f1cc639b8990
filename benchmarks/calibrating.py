"""Benchmarks: on an emulated serial port a calibration from start to end, and a crystal's drift recovered."""

from __future__ import annotations

import asyncio
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from app.clocks import LiveClock
from app.motion.samples import Sample
from app.session import Session
from app.settings import Settings
from app.simulate.calibration import make_calibration
from app.sources.opening import open_source
from benchmarks.figures import Figure, Section
from benchmarks.processes import ROOT, first_line, running

SEED = "3"
PATIENCE_S = 300.0
G_MPS2 = 9.80665
DRIFT_PPM, BATCH_MS = 100.0, 16
DRIFT_S = 65.0
LOOK_S = 0.02


def calibrating() -> Section:
    """Both."""
    yield from calibrated()
    yield from drifting()


def calibrated() -> Section:
    """``stridescope calibrate`` on a 3DM-GX1 that a simulated hand turns, beside the errors it has."""
    true = make_calibration({"seed": SEED})
    with (
        tempfile.TemporaryDirectory() as folder,
        running("app", "emulate", "gx1", "--source", f"sim:calibration?seed={SEED}&rate=400") as sensor,
    ):
        out, port = Path(folder) / "found.json", first_line(sensor)
        command = ["calibrate", "--no-save", "--out", str(out), "--field", "48.6"]
        command += ["--source", f"serial:{port}?device=gx1"]
        began_s = time.monotonic()
        done = subprocess.run(
            [sys.executable, "-m", "app", *command],
            cwd=ROOT,
            capture_output=True,
            timeout=PATIENCE_S,
            check=False,
        )
        took_s = time.monotonic() - began_s
        found = json.loads(out.read_text("utf-8")) if out.exists() else None
    yield Figure("calibration by a serial port: ended well", float(done.returncode == 0), "", 1.0, True)
    yield Figure("calibration by a serial port: from start to end", took_s, "s", 120.0)
    if found is not None:
        null = np.abs(np.array(found["force"]["null"]) - true.force.null).max() / G_MPS2 * 1e3
        yield Figure("null of its accelerometer, off by", float(null), "mg", 0.5)
        null = np.degrees(np.abs(np.array(found["rate"]["null"]) - true.rate.null).max())
        yield Figure("null of its gyro, off by", float(null), "°/s", 0.05)


def drifting() -> Section:
    """What the session says of a clock that is too fast, where samples come in batches."""
    told = asyncio.run(_drifting())
    off = None if told is None else abs(told - DRIFT_PPM)
    name = f"clock {DRIFT_PPM:g} ppm off, {BATCH_MS} ms batches, {DRIFT_S:.0f} s: its drift recovered to"
    yield Figure(name, off, "ppm", 5.0)


async def _drifting() -> float | None:
    faults = [f"--fault=drift={DRIFT_PPM:g}", f"--fault=burst={BATCH_MS}"]
    with running("app", "emulate", "mip", "--source", "sim:walk?loop=1", *faults) as sensor:
        source = open_source(f"serial:{first_line(sensor)}?device=mip&baud=115200")
        session = Session(Settings(), clock=lambda _: LiveClock())

        async def take() -> None:
            async for item in source:
                assert isinstance(item, Sample)
                session.take(item)

        task = asyncio.create_task(take())
        while not session.stores or session.stores["foot"].elapsed_s < DRIFT_S:
            await asyncio.sleep(LOOK_S)
        task.cancel()
        source.close()
    recent = session.snapshot().health["foot"].recent
    return None if recent is None else recent.drift_ppm
