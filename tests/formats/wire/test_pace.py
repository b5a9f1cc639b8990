from __future__ import annotations

import numpy as np
import pytest

from app.formats.wire.pace import Pace


@pytest.mark.parametrize("rate_hz", [10.0, 50.863, 76.3, 100.0, 400.0, 1000.0])
@pytest.mark.parametrize("source_hz", [100.0, 333.0, 1000.0])
@pytest.mark.parametrize("start_ns", [0, 12_345_678, 10**18])
def test_the_mean_rate_is_kept_and_a_slow_source_passes_whole(
    rate_hz: float, source_hz: float, start_ns: int
) -> None:
    rng = np.random.default_rng(1)
    stamps = start_ns + (np.arange(4000) * 1e9 / source_hz).astype(int) + rng.integers(0, 1000, 4000)
    pace = Pace()
    passed = [stamp for stamp in stamps.tolist() if pace.due(stamp, rate_hz)]
    expected = min(rate_hz, source_hz) * 4000 / source_hz
    assert len(passed) == pytest.approx(expected, abs=1.5)
    assert passed[0] == stamps[0]


def test_a_clock_that_starts_anew_measures_on() -> None:
    pace = Pace()
    assert [pace.due(ms * 1_000_000, 100.0) for ms in (500, 503, 510, 0, 10, 12)] == [
        True,
        False,
        True,
        True,
        True,
        False,
    ]
