"""The shipped recordings: made by their own SPEC, small, and a walk worth looking at."""

from __future__ import annotations

import runpy
from pathlib import Path
from urllib.parse import parse_qsl

import numpy as np
import pytest

from app.formats.reading import read
from app.motion.recording import Recording
from app.simulate.options import WalkOptions, parse, spec_of
from app.simulate.walk import SimulatedWalk, simulate

ROOT = Path(__file__).parents[2]
TOOL = runpy.run_path(str(ROOT / "tools" / "make_recordings.py"))
SPECS: dict[str, str] = TOOL["SPECS"]


def options_of(query: str) -> WalkOptions:
    return parse(dict(parse_qsl(query)))


@pytest.fixture(scope="module", params=sorted(SPECS))
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def recording(name: str) -> Recording:
    return read(name, (ROOT / "recordings" / name).read_bytes())


@pytest.fixture(scope="module")
def demo() -> SimulatedWalk:
    return simulate(options_of(SPECS["demo.csv"]))


def test_the_spec_is_the_first_line(name: str) -> None:
    first = (ROOT / "recordings" / name).read_text().splitlines()[0]
    assert first == f"# spec: {spec_of(options_of(SPECS[name]))}"


def test_the_spec_makes_the_recording_again(name: str, recording: Recording) -> None:
    assert recording.spec is not None
    walk = simulate(options_of(recording.spec.partition("?")[2]))
    for shipped, made in zip(recording.sensors, walk.recording.sensors, strict=True):
        assert (shipped.sensor, shipped.role) == (made.sensor, made.role)
        np.testing.assert_array_equal(shipped.matrix[:, 0], made.matrix[:, 0])
        last_digit = np.repeat([1e-4, 1e-4, 1e-2], 3)  # another platform's sine may round it differently
        assert np.all(np.abs(shipped.matrix - made.matrix)[:, 1:] < 1.01 * last_digit)


def test_it_is_read_as_it_is(recording: Recording) -> None:
    assert not recording.assumed
    assert recording.dropped_rows == 0
    assert 20.0 < recording.duration_s < 180.0


def test_it_is_small(name: str) -> None:
    assert (ROOT / "recordings" / name).stat().st_size < 2_000_000


def test_the_demo_walks_at_once_and_turns_within_half_a_minute(demo: SimulatedWalk) -> None:
    assert 90.0 < demo.recording.duration_s < 180.0
    for foot in demo.feet.values():
        assert 1.0 < foot.timing.heel_off_s < 2.5
        footprints_in_30_s = int((30.0 - foot.timing.heel_off_s) / foot.timing.cycle_s)
        assert np.ptp(foot.heading_rad[:footprints_in_30_s]) > np.pi


def test_the_demo_comes_home_on_the_level(demo: SimulatedWalk) -> None:
    for foot in demo.feet.values():
        np.testing.assert_allclose(foot.position_n[-1], 0.0, atol=1e-9)


def test_the_demo_starts_far_from_its_magnet(demo: SimulatedWalk) -> None:
    """The heading of the start is taken from the compass, if it is on."""
    for sensor in demo.recording.sensors:
        north, east = sensor.matrix[:100, 7:9].mean(axis=0)
        assert abs(np.arctan2(-east, north)) < np.radians(1.0)
        assert np.ptp(np.linalg.norm(sensor.matrix[:, 7:10], axis=1)) > 2.0  # µT: it is there


def test_as_mcap_it_is_the_same_recording(recording: Recording) -> None:
    again = read("again.mcap", TOOL["as_mcap"](recording))
    assert again.spec == recording.spec
    for one, other in zip(recording.sensors, again.sensors, strict=True):
        assert (one.sensor, one.role, one.device_ns) == (other.sensor, other.role, other.device_ns)
        np.testing.assert_array_equal(one.matrix, other.matrix)
