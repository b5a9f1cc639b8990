"""The recorder on a real disk: what was synced is there, whatever happens next."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from app.formats import kept
from app.formats.journal import Start
from app.formats.keeping import Keeper
from app.motion.basics import InputError, Role
from app.motion.source import SourceInfo
from app.outputs import recorder as recorder_module
from app.outputs.recorder import Recorder
from app.settings import Settings
from tests.formats.walks import random_samples

INFO = SourceInfo("demo.csv", "plain CSV", {"left": Role.LEFT, "right": Role.RIGHT}, 400.0)


def a_recorder(folder: Path, **rest) -> Recorder:
    made = Recorder(folder, "papers", "replay:walks/demo.csv?speed=2", INFO, **rest)
    made.start(Start(Settings(), Settings(), False))
    return made


def found_in(path: Path) -> kept.Kept:
    return kept.kept(path.name, path.read_bytes())


def wait_for(condition, seconds: float = 90.0) -> None:
    until = time.monotonic() + seconds
    while not condition() and time.monotonic() < until:
        time.sleep(0.01)
    assert condition()


def test_what_was_handed_over_is_in_the_file(tmp_path: Path) -> None:
    samples = random_samples(300)
    recorder = a_recorder(tmp_path / "new")
    for sample in samples:
        recorder.sample(sample)
    recorder.marker("Ann", "stairs")
    recorder.close(20.0)
    found = found_in(recorder.path)
    assert kept.samples(found) == samples
    assert found.closed
    assert [text for _, text in found.markers] == ["stairs"]
    assert recorder.path.name.endswith("_papers_demo.mcap")
    assert not recorder.state.on
    assert recorder.state.size_bytes == recorder.path.stat().st_size


def test_a_temperature_is_kept_when_it_changes_and_once_a_second(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_s = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now_s[0])
    recorder = a_recorder(tmp_path)
    for celsius in (24.0, 24.5, 24.5, 25.0, 25.0):
        for sample in random_samples(2):
            recorder.sample(sample)
        recorder.learn(replace(INFO, temperatures={"left": celsius}))
        now_s[0] += 0.6
    recorder.close(20.0)
    told = found_in(recorder.path).temperatures
    assert [(sensor, celsius) for _, sensor, celsius in told] == [
        ("left", 24.0),
        ("left", 24.5),
        ("left", 25.0),
    ]


def test_two_recordings_of_one_second_are_two_files(tmp_path: Path) -> None:
    first, second = a_recorder(tmp_path), a_recorder(tmp_path)
    first.close(20.0)
    second.close(20.0)
    assert first.path != second.path


@pytest.mark.parametrize("profile", ["../../etc/passwd", "a/b", "\0", "Ann's <b>"])
def test_a_name_cannot_leave_the_folder(tmp_path: Path, profile: str) -> None:
    recorder = Recorder(tmp_path, profile, "x", INFO)
    recorder.close(20.0)
    assert recorder.path.parent == tmp_path
    assert recorder.path.is_file()


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="--record") as error:
        a_recorder(tmp_path / "file")
    assert "\n" not in str(error.value)


def test_a_slow_disk_is_told_and_loses_nothing(tmp_path: Path) -> None:
    def slow(number: int) -> None:
        time.sleep(2.0)
        os.fsync(number)

    samples = random_samples(400)
    recorder = a_recorder(tmp_path, sync=slow)
    for sample in samples:
        recorder.sample(sample)
    wait_for(lambda: "slow" in recorder.state.trouble)
    recorder.sample(samples[0])
    wait_for(lambda: kept.samples(found_in(recorder.path)) == [*samples, samples[0]])  # nothing waits for it
    recorder.close(30.0)
    assert kept.samples(found_in(recorder.path)) == [*samples, samples[0]]


@pytest.fixture
def tiny_disk(tmp_path: Path) -> Iterator[Path]:
    """Five megabytes in memory, of which the recorder keeps four."""
    folder = tmp_path / "disk"
    folder.mkdir()
    made = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=5m", "tmpfs", folder], capture_output=True, check=False
    )
    if made.returncode:
        pytest.skip("needs the right to mount a tiny disk")
    yield folder
    subprocess.run(["umount", "-l", folder], check=True)


def test_a_disk_that_fills_up_costs_no_sample_before_it_is_full(tiny_disk: Path) -> None:
    samples = random_samples(40_000)
    recorder = a_recorder(tiny_disk)
    for i, sample in enumerate(samples):
        recorder.sample(sample)
        if i % 200 == 199 and recorder.on:
            time.sleep(0.02)
    wait_for(lambda: not recorder.on)
    recorder.close(20.0)
    found = found_in(recorder.path)
    back = kept.samples(found)
    assert "No space left" in recorder.state.trouble
    assert found.closed
    assert len(back) > 1000
    assert back == samples[: len(back)]


def test_a_queue_that_is_full_is_told_and_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recorder_module, "MOST_WAITING", 50)
    monkeypatch.setattr(recorder_module, "CHUNK_S", 60.0)
    samples = random_samples(80)
    recorder = a_recorder(tmp_path)
    for sample in samples:
        recorder.sample(sample)
    assert recorder.state.trouble
    recorder.close(20.0)
    found = found_in(recorder.path)
    kept_samples = kept.samples(found)
    assert kept_samples == samples[: len(kept_samples)]
    assert [e["samples"] for e in found.events if e["event"] == "lost"] == [80 - len(kept_samples)]


def test_what_the_disk_did_not_take_in_time_is_said_at_the_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """A disk that hangs from the second chunk on: Ctrl-C does not wait for it, and is not silent about it."""
    samples, hangs, write = random_samples(150), threading.Event(), Recorder._write

    def hang(recorder: Recorder, data: bytes, size: int) -> int:
        hangs.wait(60.0)
        return write(recorder, data, size)

    recorder = a_recorder(tmp_path)
    for sample in samples[:50]:
        recorder.sample(sample)
    wait_for(lambda: recorder._written == 50)
    monkeypatch.setattr(Recorder, "_write", hang)
    for sample in samples[50:]:
        recorder.sample(sample)
    recorder.close(0.5)
    hangs.set()
    assert "its last 100 samples are not recorded" in recorder.state.trouble
    assert "its last 100 samples are not recorded" in caplog.text


def test_a_sample_that_is_lost_while_the_loss_is_told_is_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told, samples = Keeper.event, random_samples(6)

    def event(keeper: Keeper, ns: int, name: str, **more: Any) -> None:
        if name == "lost" and samples:
            recorder.sample(samples.pop())
        told(keeper, ns, name, **more)

    monkeypatch.setattr(Keeper, "event", event)
    monkeypatch.setattr(recorder_module, "MOST_WAITING", 0)
    recorder = a_recorder(tmp_path)
    for _ in range(5):
        recorder.sample(samples.pop())
    wait_for(lambda: not samples)
    recorder.close(20.0)
    assert sum(e["samples"] for e in found_in(recorder.path).events if e["event"] == "lost") == 6


def test_a_full_disk_closes_the_recording_readable(tmp_path: Path) -> None:
    full = [False]

    def sync(number: int) -> None:
        if full[0]:
            full[0] = False  # the room that was kept is given back
            raise OSError(errno.ENOSPC, "No space left on device")
        os.fsync(number)

    samples = random_samples(200)
    recorder = a_recorder(tmp_path, sync=sync)
    for i, sample in enumerate(samples):
        recorder.sample(sample)
        if i == 100:
            full[0] = True
    wait_for(lambda: not recorder.state.on)
    found = found_in(recorder.path)
    assert "No space left" in recorder.state.trouble
    assert found.closed
    assert kept.samples(found) == samples[: len(kept.samples(found))]
    recorder.sample(samples[0])  # nobody is held up by a recording that has ended
    recorder.close(20.0)


def test_a_file_that_may_not_grow_keeps_its_whole_chunks(tmp_path: Path) -> None:
    """A real refusal by the system, in a process of its own: not even the end can be written."""
    code = f"""
        import resource, signal, sys, time
        sys.path.insert(0, {str(Path.cwd())!r})
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        from pathlib import Path
        from tests.outputs.test_recorder import a_recorder, random_samples
        from app.outputs import recorder as r
        r.RESERVE = 1000
        recorder = a_recorder(Path({str(tmp_path)!r}))
        resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))
        for sample in random_samples(2000):
            recorder.sample(sample)
            time.sleep(0.001)
        recorder.close(20.0)
        print(recorder.state.trouble)
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=60, check=False
    )
    assert "File too large" in done.stdout, done.stderr
    (path,) = tmp_path.glob("*.mcap")
    found = kept.samples(found_in(path))
    assert found == random_samples(2000)[: len(found)]
    assert found


SENDER = """
    import sys, time
    sys.path.insert(0, sys.argv[1])
    from pathlib import Path
    from tests.outputs.test_recorder import a_recorder, random_samples
    samples = random_samples(20000)
    recorder = a_recorder(Path(sys.argv[2]))
    print(recorder.path, flush=True)
    began = time.monotonic()
    for i, sample in enumerate(samples):
        recorder.sample(sample)
        if i % 40 == 39:
            print(i + 1, flush=True)
            time.sleep(max(0.0, began + i / 800 - time.monotonic()))
"""


def killed_recording(folder: Path, after_s: float) -> tuple[Path, int]:
    """Kill -9 a process that records two feet at 400 Hz: the file, and how many samples it handed over."""
    sender = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(SENDER), str(Path.cwd()), str(folder)], stdout=subprocess.PIPE
    )
    assert sender.stdout is not None
    path = Path(sender.stdout.readline().decode().strip())
    sender.stdout.readline()
    time.sleep(after_s)
    sender.send_signal(signal.SIGKILL)
    said = sender.stdout.read().split()
    sender.wait(120)
    return path, int(said[-1]) if said else 40


@pytest.mark.parametrize("after_s", [0.05, 0.9, 1.63])
def test_a_killed_recording_is_an_exact_prefix(tmp_path: Path, after_s: float) -> None:
    path, sent = killed_recording(tmp_path, after_s)
    found = kept.samples(found_in(path)) if path.stat().st_size > 100 else []
    assert found == random_samples(20000)[: len(found)]
    assert sent - len(found) <= 3 * 800  # how much is lost in a second is `make soak`'s to measure
