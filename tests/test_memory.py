"""Over its budget a walk lets its oldest samples go, and nothing else changes."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest

from app.blocks import BLOCK
from app.memory import Memory
from app.motion.basics import Role
from app.motion.commands import (
    ApplyCandidate,
    ResetHeading,
    SetCandidate,
)
from app.motion.estimate import ROW_WIDTH
from app.motion.recording import Landing, Stretch
from app.motion.samples import SAMPLE_WIDTH, Rows, Sample, Samples
from app.rotation import from_yaw, rotate, yaw_of
from app.session import Session
from app.settings import Settings
from app.stores import SensorStore
from app.tracks import Track
from tests.estimator.walks import PAPERS, estimate, foot, rows_of
from tests.sessions import (
    GAIN,
    LONG,
    OTHER,
    fed,
    length_of,
    main_rows,
    order,
    settle,
    tell,
)


def budgeted(budget: int, samples: Iterable[Sample], settings_: Settings = PAPERS) -> Session:
    return fed(Session(settings_, budget_bytes=budget), samples)


#: A sample, its arrival and flags, a row of the main track and one of a candidate.
ROW_BYTES = 8 * (SAMPLE_WIDTH + 2 + 2 * ROW_WIDTH)
ROOM = 7 * BLOCK * ROW_BYTES


def test_over_the_budget_the_oldest_block_goes_and_the_page_is_told() -> None:
    session = Session(PAPERS, budget_bytes=ROOM)
    block = BLOCK * ROW_BYTES
    for i, sample in enumerate(LONG):
        session.take(sample)
        if i == 20_000:
            tell(session, GAIN)
        if i % 1000 == 0:
            assert session.stored_bytes <= ROOM + block
    snapshot = session.snapshot()
    start = session.stores["foot"].samples.start
    assert start % BLOCK == 0
    assert start > 0
    assert snapshot.hindsight_from_s == pytest.approx(start / 50.0)
    assert snapshot.stored_bytes <= snapshot.budget_bytes
    whole = rows_of(estimate(foot("path=oval&size_m=60&duration_s=1200&rate_hz=50")))
    assert main_rows(session).tobytes() == whole[start:].tobytes()


def test_hindsight_begins_by_the_clock_that_all_sensors_share() -> None:
    session = Session(PAPERS)
    session.take(LONG[0]._replace(sensor="left"))
    session.take(LONG[0]._replace(sensor="right", device_ns=LONG[0].device_ns + 7_000_000_000))
    assert session.snapshot().hindsight_from_s == pytest.approx(7.0)


def test_after_the_cut_a_candidate_goes_on_from_mains_checkpoint() -> None:
    session = budgeted(ROOM, LONG)
    start = session.stores["foot"].samples.start
    assert start
    before = session.snapshot().main.feet[0]
    tell(session, SetCandidate((("gain_swing", 0.001),)))
    assert session.applying.candidate is not None
    ghost = session.applying.candidate.feet["foot"].tracker
    assert ghost.rows.start == start
    assert rows_of(ghost)[0, :3] == pytest.approx(main_rows(session)[0, :3], abs=1e-3)
    assert ghost.stride_count == before.strides
    tell(session, ApplyCandidate())
    after = session.snapshot().main.feet[0]
    assert after.strides == before.strides
    assert after.distance_m == pytest.approx(before.distance_m, rel=0.01)


def test_the_trail_before_the_cut_survives_an_apply_and_turns_with_it() -> None:
    session = budgeted(ROOM, LONG)
    before = session.snapshot().main.feet[0].trail
    tell(session, SetCandidate((("gain_stance", 1.06),)), ApplyCandidate())
    after = session.snapshot().main.feet[0].trail
    assert length_of(after) == pytest.approx(length_of(before), rel=0.05)
    tell(session, ResetHeading())
    yaw = session.main.settings.start_heading_rad
    turned = session.snapshot().main.feet[0].trail
    assert length_of(turned) == pytest.approx(length_of(after), rel=0.01)
    assert turned.pieces[0].key != after.pieces[0].key
    point, was = turned.pieces[0].segments[-1, 1], after.pieces[0].segments[-1, 1]
    assert rotate(from_yaw(yaw), tuple(was.tolist())) == pytest.approx(tuple(point.tolist()), abs=1e-3)
    assert yaw_of(tuple(main_rows(session)[-1, 6:10].tolist())) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("late", [0, 2 * BLOCK, 20 * BLOCK])
def test_a_result_that_comes_after_blocks_have_gone_is_the_same(late: int) -> None:
    session = budgeted(ROOM, LONG[:30_000])
    session.apply(order(GAIN))
    job = session.applying.wanted
    assert job is not None
    track = job.run()
    fed(session, LONG[30_000 : 30_000 + late])
    session.applying.adopt(job, track)
    settle(session)
    assert session.applying.candidate is not None
    ghost, store = session.applying.candidate.feet["foot"].tracker, session.stores["foot"].samples
    assert (ghost.rows.start, ghost.rows.end) == (store.start, store.end)
    assert set(session.main.bases()) == {"foot"}
    tell(session, ApplyCandidate(), OTHER, ApplyCandidate())
    assert session.main.feet["foot"].tracker.rows.start == store.start
    fed(session, LONG[30_000 + late :])
    assert np.isfinite(main_rows(session)).all()
    assert session.stored_bytes <= ROOM


def test_what_is_stored_is_all_that_every_sample_takes() -> None:
    session = budgeted(ROOM, LONG[: BLOCK + 1])
    assert session.stored_bytes == 2 * BLOCK * 8 * (SAMPLE_WIDTH + 2 + ROW_WIDTH)
    tell(session, GAIN)
    assert session.stored_bytes == 2 * BLOCK * ROW_BYTES


def landing(first: int, last: int) -> Landing:
    samples = Samples("foot", Role.FOOT, 0, np.zeros((last, SAMPLE_WIDTH)), np.zeros(last, np.uint16))
    return Landing(Stretch((Rows(samples, first, last),), 0, list), {}, {}, lambda: iter(()))


def test_a_landing_goes_on_where_the_walk_ends_and_leaves_half_of_the_memory() -> None:
    main, stores = Track("main", PAPERS), dict[str, SensorStore]()
    memory = Memory(2 * 1000 * ROW_BYTES, stores)
    assert memory.has_room_for(landing(0, 999), main)
    assert not memory.has_room_for(landing(0, 1000), main)
    assert not memory.has_room_for(landing(5, 999), main)
    store = stores["foot"] = SensorStore("foot", Role.FOOT)
    for sample in LONG[:5]:
        store.take(sample)
    roomy = Memory(10 * BLOCK * ROW_BYTES, stores)
    assert roomy.has_room_for(landing(5, 999), main)
    assert not roomy.has_room_for(landing(0, 999), main)
    taken = store.samples.nbytes + store.clocks.nbytes
    tight = Memory(2 * (994 * ROW_BYTES + taken), stores)
    assert not tight.has_room_for(landing(5, 999), main)
    assert tight.has_room_for(landing(5, 998), main)
