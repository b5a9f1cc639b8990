"""Syncing beside writing: nobody waits for it, all of it comes to an end, an error is not swallowed."""

from __future__ import annotations

import errno
import threading

import pytest

from app.outputs.syncing import Syncer


def test_what_is_written_does_not_wait_and_is_synced_in_the_end() -> None:
    gate, calls = threading.Event(), []

    def sync(number: int) -> None:
        gate.wait(60)
        calls.append(number)

    syncer = Syncer(7, sync)
    for i in range(50):
        syncer.wrote(bytes([i]))  # returns although no sync has
    assert calls == []
    gate.set()
    syncer.finish()
    assert set(calls) == {7}
    assert 1 <= len(calls) <= 50
    assert syncer.stop() == []


def test_a_sync_under_way_tells_how_long_it_takes() -> None:
    gate = threading.Event()
    syncer = Syncer(1, lambda number: bool(gate.wait(60)))  # type: ignore[arg-type]
    syncer.wrote(b"a")
    seen = [syncer.slow_s]
    while seen[-1] <= seen[0] or seen[-1] == 0.0:
        seen.append(syncer.slow_s)
    gate.set()
    syncer.finish()


def test_what_could_not_be_synced_comes_back() -> None:
    def full(number: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    syncer = Syncer(1, full)
    syncer.wrote(b"first")
    assert syncer.stop() == [b"first"]
    with pytest.raises(OSError, match="No space left"):
        syncer.wrote(b"second")
    with pytest.raises(OSError, match="No space left"):
        syncer.finish()
    assert syncer.stop() == [b"first", b"second"]
