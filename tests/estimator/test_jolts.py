"""An accelerometer at the end of its range: what it missed is guessed, and a lost walk is not called good."""

from __future__ import annotations

import numpy as np
import pytest

from app.settings import BUILT_IN
from tests.estimator.walks import G, estimate, foot, rows_of, samples_of, walk

DEFAULT = BUILT_IN["default"]
NOISE = "gyro_noise_radps=0.0035&accelerometer_noise_mps2=0.03&strides=60"


def pushed(top: float) -> np.ndarray:
    """Two pushes forward and two back, each alike, read by a sensor that ends at ``top``: velocities [n]."""
    t_s = np.arange(800) / 200
    push = np.zeros(800)
    for begin_s, sign in ((1.0, 1.0), (1.1, -1.0), (1.6, 1.0), (1.7, -1.0)):
        now = (t_s > begin_s) & (t_s < begin_s + 0.1)
        push[now] += sign * 60.0 * np.sin(np.pi * (t_s[now] - begin_s) / 0.1)
    force = np.column_stack([np.clip(push, -top, top), 0.0 * t_s, -G + 0.0 * t_s])
    return rows_of(estimate(samples_of(t_s, force, np.zeros((800, 3))), DEFAULT))[:, 3]


def test_the_velocity_that_was_missed_is_guessed() -> None:
    whole, clipped, more = (pushed(top)[[220, 340]] for top in (100.0, 40.0, 25.0))  # between push and stop
    assert whole == pytest.approx(60.0 * 0.1 * 2.0 / np.pi, rel=0.01)
    for found, top in ((clipped, 40.0), (more, 25.0)):
        lobe = 60.0 * np.sin(np.linspace(0.0, np.pi, 10_001))
        missed = 0.1 * float(np.mean(np.maximum(lobe - top, 0.0)))
        assert np.abs(whole - found).max() < 0.2 * missed


def end_m(query: str) -> tuple[float, float, str]:
    """How far off the end of a walk is, the path, and the word on it."""
    tracker = estimate(foot(query), DEFAULT)
    truth = walk(query).truth("foot", foot(query).matrix[-1:, 0] * 1e-9)[0]
    away = rows_of(tracker)[-1, :2] - truth[0, :2]
    assert tracker.trust is not None
    return float(np.hypot(*away)), float(np.hypot(*truth[0, :2])), tracker.trust.word


@pytest.mark.parametrize("model", ["papers", "smooth"])
@pytest.mark.parametrize("rate_hz", [50, 200])
@pytest.mark.parametrize("range_g", [2, 3, 5, 8])
def test_a_range_that_is_too_small_is_not_called_good(model: str, rate_hz: int, range_g: int) -> None:
    query = f"model={model}&rate_hz={rate_hz}&accelerometer_range_g={range_g}&{NOISE}"
    away_m, path_m, word = end_m(query)
    assert word != "good" or away_m < 0.02 * path_m
    assert word == "lost" or away_m < 0.2 * path_m


def test_what_is_guessed_brings_most_of_the_walk_back() -> None:
    """Without it the first was 11 % off, the second 29 %."""
    assert end_m(f"rate_hz=200&accelerometer_range_g=3&{NOISE}")[0] < 0.06 * 72.0
    assert end_m(f"model=papers&rate_hz=100&accelerometer_range_g=5&{NOISE}")[0] < 0.16 * 72.0


def test_a_range_that_is_large_enough_changes_nothing() -> None:
    samples = foot(f"rate_hz=100&{NOISE}")
    assert estimate(samples, DEFAULT).state["missed_m"][0] == 0.0
    assert np.abs(samples.matrix[:, 1:4]).max() > 30.0
