"""Edge to other processes: where tasks run: in this one, on the cores of this machine, or on a Dask cluster.

A task is seeded by itself and its value does not depend on where or when it ran, so a worker that dies
costs time only: its tasks are done again.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import resource_tracker
from typing import Any

from app.motion.basics import InputError
from app.studies.words import Done, Task

Tell = Callable[[int, int], None]
"""(tasks done, of so many)."""
#: A pool that loses a worker is made anew so often before it counts as a fault of the task.
LIVES = 3
#: A cluster that does not answer for so long is not there.
ANSWERS_S = 10.0


def run_task(task: Task) -> Done:
    """One task, timed."""
    if task.timed:
        task.run(*task.arguments)
    began = time.perf_counter()
    value = task.run(*task.arguments)
    return Done(value, time.perf_counter() - began)


def run_all(tasks: Sequence[Task], jobs: int, cluster: str | None, tell: Tell) -> list[Done]:
    """All tasks, their values in the order asked; ``jobs`` processes, or a cluster's."""
    if cluster is not None:
        return _on_cluster(tasks, cluster, tell)
    if jobs == 1 or len(tasks) < 2:
        return _here(tasks, tell)
    return _in_processes(tasks, jobs, tell)


def cores() -> int:
    """The cores this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # not on macOS
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def _here(tasks: Sequence[Task], tell: Tell) -> list[Done]:
    found = []
    for task in tasks:
        found.append(run_task(task))
        tell(len(found), len(tasks))
    return found


def _in_processes(tasks: Sequence[Task], jobs: int, tell: Tell) -> list[Done]:
    found: dict[int, Done] = {}
    for life in range(LIVES):
        waiting = [number for number in one_of_each_first(tasks) if number not in found]
        try:
            for number, done in _pooled(tasks, waiting, jobs):
                found[number] = done
                tell(len(found), len(tasks))
            break
        except BrokenProcessPool:  # a worker was killed: what it had is done again
            if life == LIVES - 1:
                raise
    return [found[number] for number in range(len(tasks))]


def one_of_each_first(tasks: Sequence[Task]) -> list[int]:
    """The tasks' numbers, one task of each function before all others.

    So workers that begin side by side compile different things, and later find in the cache what the others
    compiled: two would else spend half as much again on compiling the same.
    """
    first = {task.run: number for number, task in reversed(list(enumerate(tasks)))}
    ahead = set(first.values())
    return sorted(ahead) + [number for number in range(len(tasks)) if number not in ahead]


def _pooled(tasks: Sequence[Task], waiting: Sequence[int], jobs: int) -> Iterator[tuple[int, Done]]:
    # spawn, not fork: this process may have threads, and a fork would copy their locks
    spawn = multiprocessing.get_context("spawn")
    with _ended_by_signals(), ProcessPoolExecutor(jobs, spawn, initializer=_end_with_parent) as pool:
        with _deaf_to_ctrl_c():
            numbers = {pool.submit(run_task, tasks[number]): number for number in waiting}
        for future in as_completed(numbers):
            yield numbers[future], future.result()


@contextlib.contextmanager
def _deaf_to_ctrl_c() -> Iterator[None]:
    """Processes begun here never hear Ctrl-C, which a terminal sends to all: only this one."""
    resource_tracker.ensure_running()  # it would undo this, if it were begun within
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def _ended_by_signals() -> Iterator[None]:
    """Ctrl-C, or a wish that this process end, ends the workers first: nothing of the pool is left."""

    def end(number: int, _: object) -> None:
        for worker in multiprocessing.active_children():
            worker.terminate()
        sys.exit(128 + number)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, end) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _end_with_parent() -> None:
    """A worker whose parent has gone, however it ended, has nobody to work for."""
    parent = multiprocessing.parent_process()
    assert parent is not None

    def wait() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=wait, name="parent", daemon=True).start()


def _on_cluster(tasks: Sequence[Task], address: str, tell: Tell) -> list[Done]:
    dask = _dask()
    try:
        client = dask.Client(address, timeout=ANSWERS_S)
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(
            f"--cluster {address}: {error}: expected the address of a running Dask scheduler,"
            " for example tcp://127.0.0.1:8786"
        ) from None
    with client:
        # pure=False: two equal tasks are two tasks; retries: a task lost with its worker runs again
        futures = [client.submit(run_task, task, pure=False, retries=LIVES) for task in tasks]
        for count, _ in enumerate(dask.as_completed(futures), start=1):
            tell(count, len(tasks))
        try:
            found: list[Done] = client.gather(futures)
        except ImportError as error:
            raise InputError(
                f"--cluster {address}: {error}: expected workers with the same stridescope and Python as here"
            ) from None
    return found


def _dask() -> Any:
    try:
        import distributed
    except ImportError:
        raise InputError(
            "--cluster: Dask is not installed, expected the package distributed:"
            " pip install 'stridescope[cluster]'"
        ) from None
    return distributed
