"""The trail: near the path, broken where time was, in pieces that never change and are few."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.motion.basics import Floats
from app.motion.snapshot import Trail
from app.trail import APART_M, PIECE, PIECES, SLEEVE, TOLERANCES_M, TrailBuilder, coarser, segments_of


def path(points: int, seed: int = 0, step_m: float = 0.01) -> Floats:
    """A wandering walk [n, 3]."""
    heading = np.cumsum(0.05 * np.random.default_rng(seed).standard_normal(points))
    steps = step_m * np.column_stack([np.cos(heading), np.sin(heading), 0.1 * np.sin(20 * heading)])
    return np.cumsum(steps, axis=0)


def all_of(trail: Trail) -> Floats:
    return np.concatenate([*(p.segments for p in trail.pieces), trail.growing, trail.provisional]).astype(
        float
    )


def distance_to(points: Floats, segments: Floats) -> float:
    """The farthest any point lies from the segments."""
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    worst = 0.0
    for point in points:
        share = np.clip(((point - start) * along).sum(1) / (along**2).sum(1), 0, 1)
        worst = max(worst, np.linalg.norm(start + share[:, None] * along - point, axis=1).min())
    return float(worst)


@settings(max_examples=15)
@given(st.integers(0, 1000), st.lists(st.integers(0, 1500), max_size=4))
def test_a_fresh_trail_stays_within_a_centimetre_however_it_is_fed(seed: int, cuts: list[int]) -> None:
    points = path(1500, seed)
    builder = TrailBuilder("t")
    edges = [0, *sorted(cuts), 1500]
    for a, b in itertools.pairwise(edges):
        builder.add(points[a:b])
    trail = builder.trail(np.empty((0, 3)))
    assert distance_to(points[::7], all_of(trail)) <= TOLERANCES_M[0] + APART_M + 1e-5
    whole = TrailBuilder("t")
    whole.add(points)
    assert all_of(whole.trail(np.empty((0, 3)))).tobytes() == all_of(trail).tobytes()


def test_length_is_kept_and_old_pieces_are_coarser_but_near() -> None:
    points = path(200_000)
    builder = TrailBuilder("t")
    for a in range(0, len(points), 1000):
        builder.add(points[a : a + 1000])
    segments = all_of(builder.trail(np.empty((0, 3))))
    length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    assert np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum() == pytest.approx(length, rel=0.05)
    assert np.array_equal(segments[1:, 0], segments[:-1, 1])  # nowhere torn
    assert distance_to(points[::997], segments) < sum(TOLERANCES_M) + APART_M


def test_pieces_are_few_and_a_key_never_changes_its_content() -> None:
    seen: dict[str, bytes] = {}
    builder, most = TrailBuilder("t"), 0
    points = path(400_000)
    for a in range(0, len(points), 2000):
        builder.add(points[a : a + 2000])
        pieces = builder.trail(np.empty((0, 3))).pieces
        most = max(most, len(pieces))
        keys = [p.key for p in pieces]
        assert len(set(keys)) == len(keys)
        for piece in pieces:
            content = piece.segments.tobytes()
            assert seen.setdefault(piece.key, content) == content
    assert most <= 2 * PIECES + 4_000 / 100  # 4 km; a coarse piece holds more than 100 m


def test_a_snapshot_handed_out_is_not_written_into() -> None:
    builder, points = TrailBuilder("t"), path(20_000)
    held = []
    for a in range(0, len(points), 100):
        builder.add(points[a : a + 100])
        trail = builder.trail(points[a : a + 100])
        held.append((trail, [x.tobytes() for x in (trail.growing, trail.provisional)]))
    for trail, before in held:
        assert [x.tobytes() for x in (trail.growing, trail.provisional)] == before


def test_it_breaks_where_the_pen_is_lifted() -> None:
    builder = TrailBuilder("t")
    one, other = path(100), path(100) + [50.0, 0.0, 0.0]
    builder.add(one)
    builder.lift_pen()
    builder.add(other)
    segments = all_of(builder.trail(np.empty((0, 3))))
    assert np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).max() < 1.0  # the other is 50 m away
    assert distance_to(np.concatenate([one, other]), segments) < 0.02  # up to where it was lifted


@pytest.mark.parametrize("level", [1, 2])
def test_coarser_keeps_ends_and_breaks(level: int) -> None:
    one, other = path(300), path(300, 1) + [9.0, 0.0, 0.0]
    fine = np.concatenate([segments_of(one), segments_of(other)])
    coarse = coarser(fine, TOLERANCES_M[level])
    assert len(coarse) < len(fine) / 4
    assert np.array_equal(coarse[0, 0], fine[0, 0])
    assert np.array_equal(coarse[-1, 1], fine[-1, 1])
    torn = np.flatnonzero((coarse[1:, 0] != coarse[:-1, 1]).any(axis=1))
    assert len(torn) == 1
    assert np.array_equal(coarse[torn[0], 1], fine[298, 1])
    assert np.array_equal(coarse[torn[0] + 1, 0], fine[299, 0])
    assert distance_to(one, coarse.astype(float)) <= TOLERANCES_M[level] + 1e-5
    for size in (0, 1):
        assert coarser(fine[:size], 1.0).tobytes() == fine[:size].tobytes()


def test_standing_draws_nothing_new() -> None:
    builder = TrailBuilder("t")
    builder.add(np.zeros((5000, 3)))
    assert builder.trail(np.zeros((1, 3))).growing is not None
    assert not len(builder.trail(np.empty((0, 3))).growing)
    assert sum(map(len, TrailBuilder("t").trail(np.empty((0, 3))))) == 0


def test_the_provisional_part_hangs_on_the_settled() -> None:
    builder, points = TrailBuilder("t"), path(100)
    builder.add(points[:60])
    trail = builder.trail(points[60:])
    assert np.array_equal(trail.provisional[0, 0], trail.growing[-1, 1])
    assert len(trail.provisional) == 40


def test_an_old_trail_goes_in_front_and_turns() -> None:
    old, new, points = TrailBuilder("old"), TrailBuilder("new"), path(PIECE * 8)
    old.add(points)
    before = all_of(old.trail(np.empty((0, 3))))
    keys = {p.key for p in old.finished()}
    old.turn("turned", np.pi / 2)
    after = all_of(old.trail(np.empty((0, 3))))
    assert after[:, :, 0] == pytest.approx(-before[:, :, 1], abs=1e-4)
    assert after[:, :, 1] == pytest.approx(before[:, :, 0], abs=1e-4)
    assert not keys & {p.key for p in old.finished()}
    new.seed(old.finished())
    new.add(points)
    segments = all_of(new.trail(np.empty((0, 3))))
    assert np.array_equal(segments[: len(after)], after)


def test_a_straight_path_needs_one_segment_for_many_points() -> None:
    builder = TrailBuilder("t")
    builder.add(np.linspace([0.0, 0.0, 0.0], [10.0, 5.0, 0.0], 1001))
    trail = builder.trail(np.empty((0, 3)))
    assert len(trail.growing) <= 1000 / SLEEVE + 1
    assert np.array_equal(trail.growing[-1, 1], [10.0, 5.0, 0.0])  # drawn up to its end


def test_standing_makes_nothing_new_to_send() -> None:
    builder = TrailBuilder("t")
    builder.add(path(300))
    before = builder.trail(np.empty((0, 3)))
    builder.add(np.repeat(path(300)[-1:], 50, axis=0))
    after = builder.trail(np.empty((0, 3)))
    assert after.growing is before.growing
    assert after.pieces is before.pieces
