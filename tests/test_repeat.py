"""A recorded walk, replayed with its changes, is the same walk to the bit."""

from __future__ import annotations

import asyncio
import contextlib
from pathlib import Path

import numpy as np
import pytest

from app.formats.journal import Start
from app.formats.keeping import Keeper
from app.motion.basics import InputError, Role
from app.motion.commands import (
    ApplyCandidate,
    Command,
    KeepAs,
    Order,
    ReplaceCandidate,
    ResetHeading,
    Seek,
    SetApplyAtOnce,
    SetCandidate,
    SwapAB,
    Undo,
)
from app.motion.recording import Landing, Stretch
from app.motion.samples import Sample
from app.session import Session
from app.settings import BUILT_IN, Settings
from app.simulate.walk import make_walk
from app.sources.opening import open_source
from app.sources.timeline import Timeline

WALK = {"path": "square", "feet": "2", "noise": "0.3", "seed": "5", "still_s": "1.5", "size_m": "4"}
BEGAN = Settings().with_changes({"gain_swing": 0.07})


def order(command: Command, number: int) -> Order:
    return Order(command, "Ann", 3_000_000_000 * number)


def orders() -> dict[int, Command]:
    """Every kind of order that moves the walk, between samples."""
    return {
        300: SetCandidate((("gain_stance", 0.7),)),
        400: ApplyCandidate(),
        500: SetApplyAtOnce(True),
        600: SetCandidate((("gain_swing", 0.2),)),
        700: KeepAs("A"),
        720: SetCandidate((("gain_swing", 2e9),)),  # refused, and refused again
        800: ReplaceCandidate(Settings(), "profile papers"),
        900: Undo(),
        1000: SwapAB(),
        1100: ResetHeading(),
        1200: SetApplyAtOnce(False),
        1300: SetCandidate((("gain_swing", 0.3),)),
    }


class Work:
    """Runs a session's re-estimations late: only after ``delay`` more samples and orders."""

    def __init__(self, session: Session, delay: int) -> None:
        self.session, self.delay, self.waited = session, delay, 0

    def do(self, now: bool = False) -> None:
        while self.session.applying.wanted is not None:
            self.waited += 1
            if not now and self.waited < self.delay:
                return
            self.waited = 0
            job = self.session.applying.wanted
            self.session.applying.adopt(job, job.run())


def apply(session: Session, given: Order) -> None:
    with contextlib.suppress(InputError):
        session.apply(given)


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Session]:
    """A walk driven by hand, recorded as it happens."""
    recording = make_walk(WALK).recording
    session = Session(BEGAN)
    keeper = Keeper({"source": "test"}, {}, 10**18)
    path = tmp_path_factory.mktemp("recordings") / "walk.mcap"
    work, given = Work(session, delay=40), orders()
    data = keeper.begin(0)
    keeper.start(0, Start(BEGAN, BEGAN, False))
    timeline = Timeline(recording)
    for i, sample in enumerate(timeline.cut(0, len(timeline), 0)):
        if i in given:
            asked = order(given[i], i)
            apply(session, asked)
            keeper.order(session.number, asked)
        session.take(sample)
        keeper.sample(sample)
        work.do()
        if i % 160 == 0:
            data += keeper.chunk()
    work.do(now=True)
    path.write_bytes(data + keeper.end())
    return path, session


async def replayed(
    spec: str, settings: Settings, delay: int, seek_back: bool = False, stretches: bool = False
) -> Session:
    source = open_source(spec, finish=True, stretches=stretches)
    session = Session(source.settings or settings)
    work, taken, skipped = Work(session, delay), 0, 0
    async for item in source:
        if isinstance(item, Sample):
            session.take(item)
            taken += 1
            if seek_back and taken == 1250:
                source.control(Seek(0.5))
            if stretches and taken == 30:  # over all orders but the first, and back, and far ahead
                source.control(Seek(9.0))
            if stretches and taken == 700:
                source.control(Seek(3.7))
                source.control(Seek(11.0))
        elif isinstance(item, Stretch):
            assert stretches
            session.take_stretch(item)
            taken += len(item)
            skipped += 1
        else:
            assert not isinstance(item, Landing)  # nobody asked for one
            apply(session, item if isinstance(item, Order) else Order(item, "replay", 0))
        work.do()
    work.do(now=True)
    assert (skipped > 5) == stretches
    return session


def rows(track) -> dict[str, np.ndarray]:
    trackers = {sensor: foot.tracker for sensor, foot in track.feet.items()}
    return {sensor: t.rows.table(t.rows.start, t.rows.end) for sensor, t in trackers.items()}


def assert_same(one, other) -> None:
    assert one.settings == other.settings
    for sensor, table in rows(one).items():
        np.testing.assert_array_equal(table, rows(other)[sensor])


@pytest.mark.parametrize(("delay", "seek_back"), [(1, False), (105, False), (150, False), (7, True)])
def test_a_replay_with_its_changes_repeats_the_walk_to_the_bit(live, delay: int, seek_back: bool) -> None:
    path, session = live
    again = asyncio.run(replayed(f"replay:{path}?speed=0", Settings(), delay, seek_back))
    assert_same(session.main, again.main)
    assert session.applying.candidate is not None
    assert again.applying.candidate is not None
    assert_same(session.applying.candidate, again.applying.candidate)
    if delay == 1:  # (the page's list leaves out an apply that the next one overtook)
        assert [c[2:] for c in again.applying.changes] == [c[2:] for c in session.applying.changes]


@pytest.mark.parametrize("delay", [1, 3, 1000])
@pytest.mark.parametrize("watched_s", [0, 1])
def test_a_walk_that_was_sought_through_is_the_same_walk_to_the_bit(
    live, delay: int, watched_s: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, session = live
    monkeypatch.setattr("app.sources.replay.WATCHED_NS", watched_s * 10**9)
    again = asyncio.run(replayed(f"replay:{path}?speed=0", Settings(), delay, stretches=True))
    assert_same(session.main, again.main)
    assert session.applying.candidate is not None
    assert again.applying.candidate is not None
    assert_same(session.applying.candidate, again.applying.candidate)


def test_a_replay_without_its_changes_has_the_settings_told(live) -> None:
    path, session = live
    told = Settings().with_changes({"gain_stance": 0.9})
    again = asyncio.run(replayed(f"replay:{path}?speed=0&changes=0", told, 1))
    assert again.main.settings == told
    assert again.log == []
    assert {s: len(t) for s, t in rows(again.main).items()} == {
        s: len(t) for s, t in rows(session.main).items()
    }


@pytest.mark.parametrize("named_at", [1, 900, 2500])
def test_feet_that_a_tap_named_meanwhile_are_linked_in_a_replay_as_they_were_live(
    named_at: int, tmp_path: Path
) -> None:
    """Naming is no order: the recording tells in the end which foot is which, and the walk is the same."""
    walk = make_walk({"feet": "2", "duration_s": "16", "noise": "1", "bias": "3"}).recording
    timeline, phones = Timeline(walk), {"left": "phone", "right": "phone-2"}
    roles = {"phone": Role.LEFT, "phone-2": Role.RIGHT}
    keeper = Keeper({"source": "test"}, dict.fromkeys(roles, Role.OTHER), 10**18)
    data = keeper.begin(0)
    keeper.start(0, Start(BUILT_IN["default"], BUILT_IN["default"], False))
    live = Session(BUILT_IN["default"], lambda _: Role.OTHER)
    for i, sample in enumerate(timeline.cut(0, len(timeline), 0)):
        sample = sample._replace(sensor=phones[sample.sensor])
        if i >= named_at:  # as each frame does
            live.name_feet(roles)
        live.take(sample)
        keeper.sample(sample)
    keeper.learnt(1, {"sensors": {sensor: role.value for sensor, role in roles.items()}})
    path = tmp_path / "walk.mcap"
    path.write_bytes(data + keeper.end())

    async def again() -> Session:
        source = open_source(f"replay:{path}?speed=0", finish=True)
        assert source.settings is not None
        session = Session(source.settings, lambda sensor: source.info.sensors[sensor])
        async for item in source:
            assert isinstance(item, Sample)
            session.take(item)
        return session

    replay = asyncio.run(again())
    assert_same(live.main, replay.main)
    seen, shown = live.snapshot().main, replay.snapshot().main
    assert seen.linked
    assert shown.linked
    assert [(f.role, f.position_n, f.q_nb) for f in seen.feet] == [
        (f.role, f.position_n, f.q_nb) for f in shown.feet
    ]
