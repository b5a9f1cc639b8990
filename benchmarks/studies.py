"""Benchmarks: the papers' studies: fifty walks at four scales, all studies, a folder of 200 recordings."""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from app.formats.plain import encode
from app.simulate.walk import make_walk
from app.studies.monte_carlo import WalkConfig, walk_many
from app.studies.walks import SCALES, noise_tasks
from app.studies.words import Task
from benchmarks.figures import Figure, Section
from benchmarks.processes import ROOT

RECORDINGS, DIFFERENT = 200, 4
CORES = 2


def studies() -> Section:
    """All of it."""
    yield from fifty_walks()
    yield from all_studies()
    yield from folder()


def fifty_walks() -> Section:
    """50 walks of 100 strides at 50 Hz, four scales of noise, once compiled."""
    config = WalkConfig()
    walk_many(config, config.noise(1.0), 2, 0, range(1))
    tasks = noise_tasks(config)[: len(SCALES) * 5]
    began = time.perf_counter()
    with ThreadPoolExecutor(CORES) as pool:
        spent = sum(pool.map(_processor_s, tasks))
    wall = time.perf_counter() - began
    yield Figure("50 walks × 100 strides × 4 scales, two threads", wall, "s", 2.0)
    yield Figure("of it processor time, over two cores", spent / CORES, "s", 2.0)


def _processor_s(task: Task) -> float:
    began = time.thread_time()
    task.run(*task.arguments)
    return time.thread_time() - began


def all_studies() -> Section:
    """``study all`` in a process of its own."""
    with tempfile.TemporaryDirectory() as out:
        began, spent = time.perf_counter(), _children_s()
        subprocess.run([*_stridescope(), "study", "all", "--out", out, "--jobs", str(CORES)],
                       cwd=ROOT, check=True, stdout=subprocess.DEVNULL)  # fmt: skip
        yield Figure("study all", time.perf_counter() - began, "s", 180.0)
        yield Figure("of it processor time, over two cores", (_children_s() - spent) / CORES, "s", 180.0)
        yield Figure("its report", (Path(out) / "report.html").stat().st_size / 1e6, "MB", 5.0)
        rows = json.loads((Path(out) / "rows.json").read_text("utf-8"))["rows"]
    told = [row for row in rows if row["study"] == "integrators" and row["item"].endswith("position error")]
    reproduced = sum(row["verdict"] == "reproduced" for row in told)
    yield Figure("Tables 4–7: position errors reproduced of 24", reproduced, "", 24.0, True)


def folder() -> Section:
    """A folder of five-minute recordings, CSV at 100 Hz."""
    with tempfile.TemporaryDirectory() as place:
        made = Path(place) / "made"
        walks = Path(place) / "walks"
        made.mkdir()
        walks.mkdir()
        for k in range(DIFFERENT):
            walk = make_walk({"duration_s": "300", "noise": "1", "seed": str(k)})
            (made / f"{k}.csv").write_bytes(encode(walk.recording))
        for k in range(RECORDINGS):
            (walks / f"{k:03}.csv").symlink_to(made / f"{k % DIFFERENT}.csv")
        began, spent = time.perf_counter(), _children_s()
        done = subprocess.run([*_stridescope(), "process", str(walks), "--json", "--jobs", str(CORES)],
                              cwd=ROOT, check=True, capture_output=True, text=True)  # fmt: skip
        wall, spent = time.perf_counter() - began, _children_s() - spent
    told = json.loads(done.stdout)
    assert len(told["recordings"]) == RECORDINGS
    share = 100 * told["estimator_s"] / told["seconds"]
    yield Figure("a folder of 200 five-minute recordings", wall, "s")
    yield Figure("of it processor time, over two cores", spent / CORES, "s")
    yield Figure("of it the estimator's share", share, "%", 30.0, note="the rest is reading")


def _children_s() -> float:
    """Processor seconds of every process that was started and has ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _stridescope() -> list[str]:
    return [sys.executable, "-m", "app"]
