"""A recording holds the estimate now and then; a seek that lands there gives the same walk, to the bit."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import weakref
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from app.formats.journal import Start
from app.formats.keeping import Keeper
from app.formats.reading import read
from app.formats.recover import recover
from app.formats.states import read_state
from app.motion.basics import InputError
from app.motion.commands import ApplyCandidate, Command, KnowBias, Order, ResetHeading, Seek, SetCandidate
from app.motion.estimate import Way
from app.motion.recording import Landing, Stretch
from app.motion.samples import Sample
from app.saving import Saver, saved
from app.session import Session
from app.settings import BUILT_IN, Settings
from app.simulate.walk import make_walk
from app.sources.opening import open_source
from app.sources.timeline import Timeline

KEY = b"a key of thirty-two octets, made"
WALK = {"path": "square", "feet": "2", "noise": "0.3", "seed": "5", "duration_s": "140", "size_m": "4"}
CHUNK = 160


def write(settings: Settings, orders: dict[int, Command], lost: int = -1) -> tuple[bytes, Session]:
    """A walk recorded as it happens, with an order before some samples; sample ``lost`` is left out."""
    recording = make_walk(WALK).recording
    session, saver, keeper = Session(settings), Saver(), Keeper({"source": "test"}, {}, 10**18, KEY)
    saver.begin(session)
    data = keeper.begin(0)
    keeper.start(0, Start(settings, settings, False))
    timeline = Timeline(recording)
    for i, sample in enumerate(timeline.cut(0, len(timeline), 0)):
        if i in orders:
            asked = Order(orders[i], "Ann", 7)
            session.apply(asked)
            keeper.order(session.number, asked)
            work(session)
        session.take(sample)
        if i != lost:
            keeper.sample(sample)
        if i % CHUNK == 0:
            for sensor, state, way in saver.due(session):
                keeper.estimate(sensor, i, state, way)
            data += keeper.chunk()
    return data + keeper.end(), session


def work(session: Session) -> None:
    while (job := session.applying.wanted) is not None:
        session.applying.adopt(job, job.run())


@pytest.fixture(scope="module", params=["papers", "default"])
def walked(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Session]:
    data, session = write(BUILT_IN[request.param], {})
    path = tmp_path_factory.mktemp("recordings") / "walk.mcap"
    path.write_bytes(data)
    return path, session


async def sought(path: Path, places: list[float], key: bytes, fill: bool) -> tuple[Session, int]:
    """A replay sought through to its end; how often it landed."""
    source = open_source(f"replay:{path}?speed=0", finish=True, stretches=True, key=key)
    assert source.settings is not None
    session, landed, waiting = Session(source.settings), 0, list(places)
    async for item in source:
        if isinstance(item, Sample):
            session.take(item)
            if waiting and session.number % 50 == 49:
                source.control(Seek(waiting.pop(0)))
        elif isinstance(item, Stretch):
            session.take_stretch(item)
        elif isinstance(item, Landing):
            if session.land(item):
                landed += 1
                assert_same_now(session, item)
                job = session.applying.filling
                assert job is not None
                if fill:
                    stub = weakref.ref(session.main)
                    session.applying.filled(job, job.run())
                    gc.collect()
                    assert stub() is None  # its rows are as many as the walk's
            else:
                for stretch in item.steps():
                    session.take_stretch(stretch)
        else:
            with contextlib.suppress(InputError):
                session.apply(item if isinstance(item, Order) else Order(item, "replay", 0))
        work(session)
    return session, landed


def assert_same_now(session: Session, landing: Landing) -> None:
    """What has landed stands where the walk from its first sample stands, and its trail leads there."""
    whole = Session(session.main.settings)
    whole.main.biases = session.biases
    for sensor, store in session.stores.items():
        whole.main.advance(sensor, store.samples)
        one, other = session.main.feet[sensor], whole.main.feet[sensor]
        assert one.tracker.state.tobytes() == other.tracker.state.tobytes()
        assert one.tracker.distance_m == other.tracker.distance_m
        assert one.tracker.stride_count == other.tracker.stride_count
        row = landing.saved[sensor].row
        assert tables(one)[row:].tobytes() == tables(other)[row:].tobytes()
        trail = one.trail()
        corners = np.concatenate([piece.segments for piece in trail.pieces] + [trail.growing]).reshape(-1, 3)
        path = tables(other)[:, :3]
        for corner in corners[:: max(1, len(corners) // 50)]:
            assert np.linalg.norm(path - corner, axis=1).min() < 0.002  # corners are points of the path
        assert len(corners) > 100


def tables(foot) -> np.ndarray:
    return foot.tracker.rows.table(0, foot.tracker.rows.end)


def assert_same(one: Session, other: Session) -> None:
    assert one.main.settings == other.main.settings
    assert list(one.main.feet) == list(other.main.feet)
    for sensor, foot in one.main.feet.items():
        twin = other.main.feet[sensor]
        assert tables(foot).tobytes() == tables(twin).tobytes()
        assert foot.tracker.strides == twin.tracker.strides
        assert foot.tracker.state.tobytes() == twin.tracker.state.tobytes()
        samples, same = (s.stores[sensor].samples for s in (one, other))
        assert samples.table(0, samples.end).tobytes() == same.table(0, same.end).tobytes()


PLACES = [[130.0], [125.0, 20.0, 130.0], [80.0, 138.0]]


@pytest.mark.parametrize("places", PLACES, ids=str)
def test_a_walk_landed_in_is_the_same_walk_to_the_bit(walked, places: list[float]) -> None:
    path, session = walked
    again, landed = asyncio.run(sought(path, places, KEY, fill=True))
    assert landed >= 1
    assert_same(session, again)


def test_a_state_of_another_key_is_not_believed(walked) -> None:
    path, session = walked
    again, landed = asyncio.run(sought(path, [130.0], b"another key", fill=True))
    assert landed == 0
    assert_same(session, again)


def test_until_it_is_filled_in_the_page_has_all_it_needs(walked) -> None:
    path, session = walked
    again, landed = asyncio.run(sought(path, [130.0], KEY, fill=False))
    assert landed == 1
    one, other = again.snapshot(), session.snapshot()
    for mine, its in zip(one.main.feet, other.main.feet, strict=True):
        assert (mine.position_n, mine.q_nb, mine.distance_m) == (its.position_n, its.q_nb, its.distance_m)
        assert mine.strides == its.strides


def test_there_is_a_state_of_each_foot_every_half_minute(walked) -> None:
    path, _ = walked
    journal = read("walk.mcap", path.read_bytes()).journal
    assert journal is not None
    for sensor in ("left", "right"):
        told = [read_state(data, KEY) for _, name, data in journal.states if name == sensor]
        rows = [state.row for state in told if state is not None]
        assert len(rows) == 4
        assert all(29.0 <= (b - a) / 100.0 <= 33.0 for a, b in pairwise([0, *rows]))


def test_an_estimate_changed_on_the_way_is_landed_in_up_to_there_only(tmp_path: Path) -> None:
    orders: dict[int, Command] = {
        20_000: SetCandidate((("threshold_radps", 0.9),)),
        20_001: ApplyCandidate(),
        23_000: ResetHeading(),
    }
    data, session = write(BUILT_IN["papers"], orders)
    path = tmp_path / "walk.mcap"
    path.write_bytes(data)
    again, landed = asyncio.run(sought(path, [135.0], KEY, fill=True))
    assert landed == 1
    assert_same(session, again)
    journal = read("walk.mcap", data).journal
    assert journal is not None
    late = [state for place, _, told in journal.states if place > 23_000 and (state := read_state(told, KEY))]
    assert {state.settings for state in late} == {session.main.settings}


def test_what_was_changed_before_a_seek_is_in_the_state_it_lands_on(tmp_path: Path) -> None:
    orders: dict[int, Command] = {
        0: KnowBias("left", (0.001, -0.002, 0.003), (0.0002, 0.0002, 0.0002), "a test"),
        900: SetCandidate((("threshold_radps", 0.9),)),
        1_000: ApplyCandidate(),
    }
    data, session = write(BUILT_IN["default"], orders)
    path = tmp_path / "walk.mcap"
    path.write_bytes(data)
    again, landed = asyncio.run(sought(path, [130.0, 20.0, 130.0], KEY, fill=True))
    assert landed >= 1
    assert_same(session, again)


def test_a_state_after_a_sample_that_the_disk_did_not_take_is_ignored() -> None:
    journal = read("walk.mcap", write(BUILT_IN["papers"], {}, lost=8_000)[0]).journal
    assert journal is not None
    assert [sensor for _, sensor, _ in journal.states].count("left") == 1
    assert [sensor for _, sensor, _ in journal.states].count("right") == 4


def test_a_recording_begun_in_a_walk_is_a_walk_of_its_own_and_has_no_states() -> None:
    session, saver = Session(BUILT_IN["papers"]), Saver()
    timeline = Timeline(make_walk(WALK).recording)
    for sample in timeline.cut(0, 100, 0):
        session.take(sample)
    saver.begin(session)
    session.take_stretch(timeline.stretch(100, len(timeline), 0))
    assert list(saver.due(session)) == []


def test_of_a_cut_recording_the_states_before_the_cut_still_serve(walked, tmp_path: Path) -> None:
    path, _ = walked
    data = path.read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(recover("walk.mcap", data[: int(0.7 * len(data))]).data)
    again, landed = asyncio.run(sought(cut, [95.0], KEY, fill=True))
    assert landed == 1
    plain, _ = asyncio.run(sought(cut, [], b"", fill=True))
    assert_same(plain, again)


def test_a_tracker_goes_on_from_what_was_saved_under_its_settings_only(walked) -> None:
    _, session = walked
    tracker = session.main.feet["left"].tracker
    state = saved(tracker)
    stretch = Timeline(make_walk(WALK).recording).stretch(0, 100, 0)
    way = Way(0, state.row, np.empty((0, 2, 3), np.float32))
    landing = Landing(stretch, {"left": state}, {"left": way}, lambda: iter(()))
    other = Session(session.main.settings.with_changes({"threshold_radps": 0.33}))
    assert not other.land(landing)
    assert other.number == 0
    tight = Session(session.main.settings, budget_bytes=10_000)
    assert not tight.land(landing)
