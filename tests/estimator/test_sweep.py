"""The search for gains: every closure is that of a tracker with those gains, to the bit."""

from __future__ import annotations

import numpy as np
import pytest

from app.blocks import BLOCK
from app.estimator.sweep import best_of, sweep
from app.estimator.tracker import Tracker
from app.settings import Settings
from tests.estimator.test_tracker import LONG, closure_of
from tests.estimator.walks import PAPERS, estimate, foot, still, table_of

STANCE, SWING = np.array([0.0, 0.7, 1.05, 3.0]), np.array([0.0, 0.05, 1.0])


@pytest.mark.parametrize("compass", [False, True])
def test_a_closure_is_the_trackers_to_the_bit(compass: bool) -> None:
    chosen = Settings(magnetometer=compass)
    closure_m = sweep(table_of(LONG.matrix), chosen, STANCE, SWING)
    for a, gain_stance in enumerate(STANCE):
        for b, gain_swing in enumerate(SWING):
            tracker = estimate(LONG, chosen, gain_stance=float(gain_stance), gain_swing=float(gain_swing))
            assert closure_m[a, b] == closure_of(tracker)


def test_more_swing_gains_than_stance_gains() -> None:
    one = sweep(table_of(LONG.matrix), PAPERS, STANCE[:1], SWING)
    assert one.shape == (1, 3)
    assert one.tolist() == sweep(table_of(LONG.matrix), PAPERS, STANCE, SWING)[:1].tolist()


def test_halves_are_the_whole() -> None:
    table = table_of(LONG.matrix)
    whole = sweep(table, PAPERS, STANCE, SWING)
    halves = [sweep(table, PAPERS, part, SWING) for part in np.array_split(STANCE, 2)]
    assert np.concatenate(halves).tobytes() == whole.tobytes()


def test_after_old_samples_are_gone_it_goes_on_from_a_checkpoint() -> None:
    main, table = estimate(LONG), table_of(LONG.matrix)
    table.drop_oldest()
    base = main.checkpoints[BLOCK]
    closure_m = sweep(table, PAPERS, STANCE, SWING, base=base)
    for a, gain_stance in enumerate(STANCE):
        tracker = Tracker(Settings(gain_stance=float(gain_stance)), BLOCK, base)
        tracker.advance(table)
        assert closure_m[a, 0] == closure_of(tracker)


def test_the_best_pair_has_the_least_mean_closure_over_the_feet() -> None:
    tables = [table_of(foot("path=eight&noise=3&feet=2", number).matrix) for number in (0, 1)]
    surfaces = [sweep(table, PAPERS, STANCE, SWING) for table in tables]
    found = best_of(surfaces, STANCE, SWING)
    mean = (surfaces[0] + surfaces[1]) / 2
    a, b = STANCE.tolist().index(found.best[0]), SWING.tolist().index(found.best[1])
    assert mean[a, b] == mean.min()
    assert np.array_equal(found.closure_m, mean)


def test_it_tells_its_progress_and_can_be_given_up() -> None:
    heard: list[float] = []

    def hear(done: float) -> bool:
        heard.append(done)
        return True

    sweep(table_of(LONG.matrix), PAPERS, STANCE, SWING, hear)
    assert heard == sorted(heard)
    assert heard[-1] == 1.0
    with pytest.raises(InterruptedError):
        sweep(table_of(still(1.0).matrix), PAPERS, STANCE, SWING, lambda done: False)
