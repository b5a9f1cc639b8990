"""Benchmarks: what others make of the same recordings: imufusion with zero-velocity updates, and gaitmap."""

from __future__ import annotations

import functools
import os
import subprocess
import tempfile
from pathlib import Path
from typing import IO

import imufusion
import numpy as np

from app.motion.basics import Floats
from app.motion.samples import Column, Samples

G = 9.80665
#: As in x-io's Gait-Tracking script: moving is an acceleration beyond 3 m/s², 100 ms before and after too.
MOVING_MPS2, MARGIN_S = 3.0, 0.1
#: gaitmap needs numpy and pandas of its own, so an environment of its own:
#: ``python -m venv .venv-gaitmap && .venv-gaitmap/bin/pip install gaitmap``; or say where it is.
GAITMAP = Path(
    os.environ.get(
        "STRIDESCOPE_GAITMAP", Path(__file__).resolve().parent.parent / ".venv-gaitmap" / "bin" / "python"
    )
)
SCRIPT = Path(__file__).with_name("gaitmap_peer.py")


def x_forward(samples: Samples) -> tuple[Floats, Floats, Floats]:
    """Seconds [n], force m/s² and rate rad/s [n, 3] with x forward, y left, z up."""
    m = samples.matrix
    flip = np.array([1.0, -1.0, -1.0])
    force, rate = m[:, Column.FX : Column.FZ + 1] * flip, m[:, Column.WX : Column.WZ + 1] * flip
    return m[:, 0] * 1e-9, force, rate


def with_imufusion(samples: Samples) -> Floats:
    """Positions [n, 3] (x, y, z up): imufusion's attitude, ZUPT and linear de-drifting as x-io's script."""
    t_s, force, rate = x_forward(samples)
    dt_s = np.diff(t_s, prepend=2.0 * t_s[0] - t_s[1])
    ahrs = imufusion.Ahrs()
    motion = np.empty((len(t_s), 3))
    for i in range(len(t_s)):
        ahrs.set_sample_period(float(dt_s[i]))
        ahrs.update_no_magnetometer(np.degrees(rate[i]), force[i] / G)
        motion[i] = np.asarray(ahrs.get_earth_acceleration()) * G
    loud = np.linalg.norm(motion, axis=1) > MOVING_MPS2
    margin = max(1, round(MARGIN_S / float(np.median(dt_s))))
    moving = np.convolve(loud, np.ones(2 * margin + 1), "same") > 0
    velocity = np.zeros_like(motion)
    for begin, end in runs(moving):
        v = np.cumsum(motion[begin:end] * dt_s[begin:end, None], axis=0)
        velocity[begin:end] = v - np.linspace(0.0, 1.0, end - begin)[:, None] * v[-1]
    path: Floats = np.cumsum(velocity * dt_s[:, None], axis=0)
    return path


def runs(flags: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> list[tuple[int, int]]:
    """Beginnings and ends of the stretches that are true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def has_gaitmap() -> bool:
    """Whether its environment is there."""
    return GAITMAP.is_file()


@functools.cache
def gaitmap() -> tuple[IO[str], IO[str]]:
    """Its process, which ends with this one: where to say what, and where it answers."""
    process = subprocess.Popen(
        [GAITMAP, SCRIPT], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    assert process.stdin is not None
    assert process.stdout is not None
    return process.stdin, process.stdout


def with_gaitmap(samples: Samples) -> Floats:
    """Positions [n, 3]: gaitmap's Kalman smoother over the whole walk, in its own environment."""
    t_s, force, rate = x_forward(samples)
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder) / "in.npz", Path(folder) / "out.npy"
        np.savez(given, t_s=t_s, force=force, rate=rate)
        said, told = gaitmap()
        said.write(f"{given} {made}\n")
        said.flush()
        if told.readline() != "done\n":
            raise RuntimeError(f"gaitmap failed on {samples.sensor}: run {SCRIPT} by hand")
        found: Floats = np.load(made)
    return found[-len(t_s) :]
