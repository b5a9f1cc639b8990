"""The viewer's numbers for who runs it."""

from __future__ import annotations

from dataclasses import replace

from app.measures import measures
from app.motion.source import Link
from app.motion.status import RecorderState
from tests.scene import fakes


def told(**changes: object) -> dict[tuple[str, ...], float]:
    status = replace(fakes.status(), **changes)  # type: ignore[arg-type]
    found = measures(fakes.snapshot(5.0, two=True), status, 300)
    return {(m.name.removeprefix("stridescope_"), *(value for _, value in m.labels)): m.value for m in found}


def test_before_the_first_frame_the_process_is_told() -> None:
    names = [m.name for m in measures(None, None, 0)]
    assert "stridescope_frames_total" in names
    assert "process_cpu_seconds_total" in names


def test_samples_rates_drops_and_memory_of_each_sensor() -> None:
    health = fakes.snapshot(5.0, two=True).health
    found = told()
    for sensor, one in health.items():
        assert found["samples_total", sensor] == one.taken
        assert found["sample_rate_hertz", sensor] == one.rate_hz
        for why, count in one.dropped.items():
            assert found["dropped_total", sensor, why] == count
    assert found[("frames_total",)] == 300
    assert found[("stored_bytes",)] == fakes.snapshot(5.0, two=True).stored_bytes
    assert found[("memory_peak_bytes",)] > 1e6


def test_the_link_is_one_state_of_all() -> None:
    found = told(link=Link.PAUSED)
    assert {name: found["link", name.value] for name in Link} == {
        name: float(name is Link.PAUSED) for name in Link
    }


def test_the_recording_and_its_disk() -> None:
    assert told(recording=None)[("recording",)] == 0
    found = told(recording=RecorderState("walk.mcap", True, 12.5, 4096, 10**9, "disk full"))
    assert found[("recording",)] == found[("recording_trouble",)] == 1
    assert (found[("recording_seconds",)], found[("disk_free_bytes",)]) == (12.5, 1e9)
