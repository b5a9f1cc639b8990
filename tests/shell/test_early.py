"""What comes while kernels are being compiled: on the disk at once, in the walk later, the same walk."""

from __future__ import annotations

import asyncio
import contextlib
import signal
import threading
from collections.abc import AsyncIterator, Callable
from pathlib import Path

import numpy as np
import pytest

from app.motion.commands import ApplyCandidate, DropCandidate, Order, SetCandidate
from app.motion.samples import Sample
from app.session import Session
from app.settings import Settings
from app.shell import record as recording
from app.shell.early import Early
from app.shell.taping import Taping
from app.shell.walk import Walk
from app.sources.files import load
from app.sources.inbox import Inbox
from app.sources.opening import open_source
from tests.estimator.walks import foot, one_by_one, rows_of
from tests.sources.links import walk as links

SAMPLES = one_by_one(foot("strides=4&rate_hz=100&noise=1"))
FIRST, REST = SAMPLES[:-20], SAMPLES[-20:]
LOWER = SetCandidate((("sensor_height_m", 0.04),))


@pytest.fixture(autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))


class Starting:
    """A walk whose kernels are compiled when ``compiled`` is set."""

    def __init__(self, folder: Path) -> None:
        self.source = Inbox("udp:1", "test")
        self.compiled = asyncio.Event()
        self.taping = Taping(folder, "default", lambda: self.walk.session)
        self.walk = Walk(self.source, Settings(), 2**24, 0, self.taping)
        self.walk.record("udp:1")
        prepared = asyncio.create_task(self._prepare())
        self.reading = asyncio.create_task(
            self.walk.read(self.walk.apply, lambda: None, lambda _: None, prepared)
        )

    async def _prepare(self) -> None:
        await self.compiled.wait()

    async def send(self, samples: list[Sample]) -> None:
        """Until they have been read."""
        before = self.taken
        self.source.put(samples)
        await self.until(lambda: self.taken == before + len(samples))

    @property
    def taken(self) -> int:
        return int(str(self.walk.health()["taken"]))

    async def until(self, condition: Callable[[], bool]) -> None:
        async with asyncio.timeout(90):
            while not condition():
                assert not self.reading.done()
                await asyncio.sleep(0.01)

    async def end(self) -> None:
        self.reading.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await self.reading
        self.walk.close()
        self.taping.stop()


@contextlib.asynccontextmanager
async def starting(folder: Path) -> AsyncIterator[Starting]:
    now = Starting(folder)
    yield now
    await now.end()


def only(folder: Path) -> Path:
    (path,) = folder.glob("*.mcap")
    return path


def settle(session: Session) -> None:
    """What a worker does."""
    while (job := session.applying.wanted) is not None:
        session.applying.adopt(job, job.run())


async def replayed(path: Path) -> Session:
    source = open_source(f"replay:{path}?speed=0", finish=True)
    assert source.settings is not None
    session = Session(source.settings)
    async for item in source:
        if isinstance(item, Order):
            session.apply(item)
            settle(session)
        elif isinstance(item, Sample):
            session.take(item)
    return session


def test_what_came_before_anything_was_compiled_is_recorded(tmp_path: Path) -> None:
    """Ctrl-C in that time ends the recording with all that was sent, read or not."""

    async def scenario() -> None:
        async with starting(tmp_path) as now:
            await now.send(FIRST)
            assert now.walk.behind
            assert not now.walk.session.stores
            now.reading.cancel()
            now.source.put(REST)

    asyncio.run(scenario())
    (kept,) = load(only(tmp_path)).sensors
    np.testing.assert_array_equal(kept.matrix, foot("strides=4&rate_hz=100&noise=1").matrix)


def test_the_walk_has_it_later_in_the_order_of_the_recording(tmp_path: Path) -> None:
    """Samples and orders, before and after; the replay is the same walk to the bit."""
    third = len(SAMPLES) // 3

    async def scenario() -> Session:
        async with starting(tmp_path) as now:
            await now.send(SAMPLES[:third])
            for command in (LOWER, ApplyCandidate()):
                now.walk.apply(Order(command, "me", 1))
            assert not now.walk.session.log
            await now.send(SAMPLES[third : 2 * third])
            assert now.taken == 2 * third, "orders are no samples"
            now.compiled.set()
            await now.until(lambda: not now.walk.behind)
            await now.send(SAMPLES[2 * third :])
            assert (now.walk.session.number, now.taken) == (len(SAMPLES) + 2, len(SAMPLES))
            settle(now.walk.session)
            return now.walk.session

    live = asyncio.run(scenario())
    again = asyncio.run(replayed(only(tmp_path)))
    assert live.main.settings.sensor_height_m == 0.04
    assert again.main.settings == live.main.settings
    rows = [rows_of(session.main.feet["foot"].tracker).tobytes() for session in (live, again)]
    assert rows[0] == rows[1]
    journal = load(only(tmp_path)).journal
    assert journal is not None
    assert [place for place, _ in journal.orders] == [third, third]
    assert [number for number, _ in live.log] == [third + 1, third + 2]


def test_a_recording_begun_meanwhile_has_what_waits(tmp_path: Path) -> None:
    async def scenario() -> None:
        async with starting(tmp_path / "first") as now:
            await now.send(SAMPLES[:50])
            now.walk.apply(Order(DropCandidate(), "me", 1))
            now.taping.stop()
            now.walk.record("udp:1")
            now.walk.record("udp:1")
            await now.send(SAMPLES[50:])

    asyncio.run(scenario())
    first, second = sorted((tmp_path / "first").glob("*.mcap"), key=lambda path: path.stat().st_size)
    assert len(load(first).sensors[0]) == 50
    found = load(second)
    assert len(found.sensors[0]) == len(SAMPLES)
    assert found.journal is not None
    assert [place for place, _ in found.journal.orders] == [50]


def test_a_fault_in_compiling_is_raised() -> None:
    async def broken() -> None:
        raise RuntimeError("no compiler")

    async def scenario() -> None:
        await Early[int](lambda _: None).release(asyncio.create_task(broken()))

    with pytest.raises(RuntimeError, match="no compiler"):
        asyncio.run(scenario())


def test_without_a_browser_a_sensor_is_recorded_from_the_first_sample_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C comes while its kernels are still being compiled."""
    sent = links(500)

    class Stopped(Inbox):
        async def _read(self) -> AsyncIterator[Sample]:
            for sample in sent:
                yield sample
            signal.raise_signal(signal.SIGINT)
            await asyncio.Event().wait()

    monkeypatch.setattr(recording, "open_source", lambda *_, **__: Stopped("udp:1", "test"))
    monkeypatch.setattr(recording, "warm_up", lambda _: threading.Event().wait())
    recording.record("udp:1", tmp_path, None, lambda _: None)
    assert len(load(only(tmp_path)).sensors[0]) == len(sent)
