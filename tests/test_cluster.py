"""A real Dask scheduler and two workers: the same bits as here, also when one worker is killed."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from app import workers
from app.__main__ import main
from app.studies.monte_carlo import WalkConfig, walk_many
from app.studies.words import Task
from app.workers import run_all

#: Compiling beside other work takes minutes.
pytestmark = pytest.mark.timeout(600)

ROOT = Path(__file__).parent.parent
CONFIG = WalkConfig(walks=1, strides=40)
TASKS = [Task(walk_many, (CONFIG, CONFIG.noise(1.0), 40, 0, range(k, k + 4))) for k in range(0, 160, 4)]


class Cluster(NamedTuple):
    """A scheduler and its workers."""

    address: str
    workers: list[subprocess.Popen[bytes]]


def dask(*arguments: str, folder: Path) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "distributed.cli.dask_" + arguments[0], *arguments[1:]]
    log = (folder / f"{arguments[0]}-{time.monotonic_ns()}.log").open("wb")
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    return subprocess.Popen(command, cwd=folder, stdout=log, stderr=log, env=environment)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    folder = tmp_path_factory.mktemp("dask")
    file = folder / "scheduler.json"
    scheduler = dask(
        "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file),
        folder=folder,
    )  # fmt: skip
    workers = [
        dask(
            "worker", "--scheduler-file", str(file), "--nthreads", "1", "--no-nanny", "--no-dashboard",
            "--host", "127.0.0.1", "--local-directory", str(folder), "--name", f"w{k}", folder=folder,
        )
        for k in range(2)
    ]  # fmt: skip
    try:
        yield Cluster(address_in(file), workers)
    finally:
        for process in (*workers, scheduler):
            process.kill()
            process.wait()


def address_in(file: Path) -> str:
    import json

    from distributed import Client

    deadline = time.monotonic() + 90.0
    while not file.exists() or not file.read_text():
        assert time.monotonic() < deadline, "no scheduler"
        time.sleep(0.1)
    address = str(json.loads(file.read_text())["address"])
    with Client(address, timeout="60s") as client:
        client.wait_for_workers(2, timeout=90)
    return address


def values(jobs: int, address: str | None = None, tell: object = lambda *d: None) -> np.ndarray:
    return np.concatenate([done.value for done in run_all(TASKS, jobs, address, tell)])  # type: ignore[arg-type]


def test_the_cluster_gives_the_same_bits_and_survives_a_kill(cluster: Cluster) -> None:
    here = values(1)
    np.testing.assert_array_equal(values(1, cluster.address), here)

    def kill_one(done: int, of: int) -> None:
        if done == 3:
            cluster.workers[0].kill()

    np.testing.assert_array_equal(values(1, cluster.address, kill_one), here)
    assert cluster.workers[0].wait(90) != 0
    assert cluster.workers[1].poll() is None


def test_no_scheduler_is_one_line(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(workers, "ANSWERS_S", 1.0)
    assert main(["study", "gait", "--json", "--cluster", "tcp://127.0.0.1:9"]) == 2
    error = capsys.readouterr().err.strip().splitlines()[-1]
    assert "--cluster tcp://127.0.0.1:9" in error
    assert "expected the address of a running Dask scheduler" in error
