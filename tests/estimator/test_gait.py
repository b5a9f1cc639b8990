"""The gait machine: consecutive contrary samples, in seconds; never the literal pseudo-code."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.estimator.gait import STANCE, SWING, gait_phase
from app.motion.basics import Floats
from tests.estimator.walks import estimate, foot, rows_of

TH = 1.0


def phases(
    rates: list[float], dts: list[float] | float, min_duration_s: float, start: float = STANCE
) -> list[float]:
    """The machine over a series of rates."""
    steps = [dts] * len(rates) if isinstance(dts, float) else dts
    phase, contrary, found = start, 0.0, []
    for rate, dt in zip(rates, steps, strict=True):
        phase, contrary = gait_phase(phase, contrary, rate, TH, min_duration_s, dt)
        found.append(phase)
    return found


def test_it_flips_after_so_many_consecutive_contrary_samples() -> None:
    assert phases([2.0] * 6, 0.01, 0.04) == [STANCE] * 3 + [SWING] * 3
    assert phases([0.5] * 6, 0.01, 0.04, SWING) == [SWING] * 3 + [STANCE] * 3


def test_one_sample_on_this_side_starts_the_count_again() -> None:
    assert phases([2.0, 2.0, 2.0, 0.5] * 5, 0.01, 0.04) == [STANCE] * 20
    assert phases([0.5, 0.5, 0.5, 2.0] * 5, 0.01, 0.04, SWING) == [SWING] * 20


def test_the_count_starts_again_at_a_transition() -> None:
    assert phases([2.0] * 4 + [0.5] * 4, 0.01, 0.04) == [STANCE] * 3 + [SWING] * 4 + [STANCE]


def test_zero_duration_flips_at_once() -> None:
    assert phases([0.5, 2.0, 0.5, 2.0], 0.01, 0.0) == [STANCE, SWING, STANCE, SWING]


def test_on_the_threshold_is_contrary_in_both_phases() -> None:
    """Fig. 5's ≥ and ≤."""
    assert phases([TH], 0.01, 0.0) == [SWING]
    assert phases([TH], 0.01, 0.0, SWING) == [STANCE]


@pytest.mark.parametrize("rate_hz", [50, 100, 200, 400])
def test_the_sample_rate_does_not_matter(rate_hz: int) -> None:
    """The delay is Γ, and at most half a sample less or more; a dip or spike shorter than it hides."""
    t_s = np.arange(2 * rate_hz) / rate_hz
    rates = np.where((t_s >= 0.5) & (t_s < 1.0), 3.0, 0.2)
    rates[(t_s >= 0.7) & (t_s < 0.72 - 1e-9)] = 0.1  # a dip
    rates[(t_s >= 1.4) & (t_s < 1.42 - 1e-9)] = 4.0  # a spike
    edges = t_s[np.flatnonzero(np.diff(phases(rates.tolist(), 1.0 / rate_hz, 0.06))) + 1]
    # the first contrary sample speaks for the time since the one before it
    assert edges == pytest.approx([0.56 - 1 / rate_hz, 1.06 - 1 / rate_hz], abs=0.51 / rate_hz)


@given(st.lists(st.floats(0.5, 1.5), min_size=30, max_size=30))
def test_uneven_stamps_are_counted_in_time(shares: list[float]) -> None:
    dts = [0.01 * share for share in shares]
    swing_from = phases([2.0] * 30, dts, 0.1).index(SWING)
    assert sum(dts[: swing_from + 1]) >= 0.1 - 0.5 * dts[swing_from]
    assert sum(dts[:swing_from]) < 0.1 - 0.5 * dts[swing_from - 1]


def literal(rates: Floats, threshold: float, count: int) -> int:
    """Swings found by the dissertation's pseudo-code (Fig. 12) to the letter: its counter is never reset."""
    phase, gamma, swings = STANCE, 0, 0
    for rate in rates.tolist():
        if rate < threshold if phase == STANCE else rate > threshold:
            continue  # transitions 1 and 3
        if gamma > count:
            phase = SWING if phase == STANCE else STANCE
            swings += phase == SWING
        else:
            gamma += 1
    return swings


@pytest.mark.parametrize(("query", "threshold"), [("model=papers&rate_hz=50", 2.0), ("rate_hz=100", 1.0)])
def test_a_hundred_strides_are_a_hundred_and_the_literal_code_finds_many_more(
    query: str, threshold: float
) -> None:
    """The sample counter as printed, and as it is here."""
    samples = foot(query)
    tracker = estimate(samples, threshold_radps=threshold)
    assert tracker.stride_count == 100
    assert np.count_nonzero(np.diff(rows_of(tracker)[:, 10]) > 0) == 100
    rates = np.linalg.norm(samples.matrix[:, 4:7], axis=1)
    assert literal(rates, threshold, round(0.06 * samples.rate_hz)) > 200
