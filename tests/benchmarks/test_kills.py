"""The kills of `make soak`, a few of them."""

from __future__ import annotations

from pathlib import Path

from benchmarks.kills import kill, some_samples


def test_a_killed_recording_is_an_exact_beginning(tmp_path: Path) -> None:
    samples = some_samples()
    for after_s in (0.3, 0.8, 1.3):
        assert kill(tmp_path, samples, after_s).exact
