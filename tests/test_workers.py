"""Tasks give the same values in the same order wherever they run, also when a worker is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from app.studies.words import Task
from app.workers import cores, one_of_each_first, run_all, run_task

#: Compiling beside other work takes minutes.
pytestmark = pytest.mark.timeout(600)


def draw(seed: int) -> float:
    return float(np.random.default_rng(seed).normal())


def die_once(marker: str, value: float) -> float:
    if not os.path.exists(marker):
        Path(marker).write_text("")
        os.kill(os.getpid(), signal.SIGKILL)
    return value


def count(path: str) -> None:
    with open(path, "a") as file:
        file.write("x")


def fail() -> None:
    raise ValueError("of its own")


TASKS = [Task(draw, (seed,)) for seed in range(7)]


@pytest.mark.parametrize("jobs", [1, 2, 3])
def test_the_same_to_the_bit_whatever_the_number_of_workers(jobs: int) -> None:
    told: list[tuple[int, int]] = []
    values = [done.value for done in run_all(TASKS, jobs, None, lambda *d: told.append(d))]
    assert values == [draw(seed) for seed in range(7)]
    assert told == [(k, 7) for k in range(1, 8)]


def test_a_killed_worker_costs_only_time(tmp_path: Path) -> None:
    tasks = [*TASKS[:3], Task(die_once, (str(tmp_path / "died"), 5.0)), *TASKS[3:]]
    values = [done.value for done in run_all(tasks, 2, None, lambda *d: None)]
    assert (tmp_path / "died").exists()
    assert values == [*map(draw, range(3)), 5.0, *map(draw, range(3, 7))]


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_task_that_fails_says_so(jobs: int) -> None:
    with pytest.raises(ValueError, match="of its own"):
        run_all([*TASKS, Task(fail)], jobs, None, lambda *d: None)


@pytest.mark.parametrize(("timed", "runs"), [(False, 1), (True, 2)])
def test_a_timed_task_runs_twice_so_that_compiling_does_not_count(
    timed: bool, runs: int, tmp_path: Path
) -> None:
    path = tmp_path / "runs"
    done = run_task(Task(count, (str(path),), timed))
    assert len(path.read_text()) == runs
    assert done.seconds > 0.0


def test_there_is_a_core() -> None:
    assert cores() >= 1


def test_one_task_of_each_function_comes_first_and_none_is_left_out() -> None:
    tasks = [*TASKS[:3], Task(fail), *TASKS[3:], Task(count, ("a",)), Task(fail)]
    order = one_of_each_first(tasks)
    assert sorted(order) == list(range(len(tasks)))
    assert [tasks[number].run for number in order[:3]] == [draw, fail, count]
    assert order[3:] == sorted(order[3:])


def mark_and_sleep(marker: str) -> None:
    Path(marker).write_text("")
    time.sleep(600.0)


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGKILL, -9)]
)
def test_the_workers_end_with_the_program(tmp_path: Path, number: signal.Signals, code: int) -> None:
    """A terminal sends Ctrl-C to the workers as well. None outlives the pipe that all of them have open."""
    script = (
        "from app.workers import run_all, Task; from test_workers import mark_and_sleep\n"
        f"if __name__ == '__main__':\n"
        f"    tasks = [Task(mark_and_sleep, ({str(tmp_path)!r} + f'/{{k}}',)) for k in range(2)]\n"
        "    run_all(tasks, 2, None, lambda *_: None)\n"
    )
    root = Path(__file__).parent
    environment = {**os.environ, "PYTHONPATH": f"{root.parent}:{root}"}
    (tmp_path / "program.py").write_text(script)
    program = subprocess.Popen(
        [sys.executable, str(tmp_path / "program.py")], env=environment, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    while not ((tmp_path / "0").exists() and (tmp_path / "1").exists()):
        assert program.poll() is None
        time.sleep(0.05)
    if number == signal.SIGINT:
        os.killpg(program.pid, number)
    else:
        program.send_signal(number)
    _, said = program.communicate(timeout=300)
    assert program.returncode == code
    assert "Traceback" not in said
