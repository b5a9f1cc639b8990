import asyncio
from pathlib import Path

import numpy as np
import pytest

from app.formats.plain import encode
from app.motion.basics import InputError
from app.motion.samples import Sample
from app.simulate.walk import make_walk
from app.sources.opening import open_source
from app.sources.replay import Replay

WALK = {"distance_m": "3", "feet": "2", "noise": "1"}
SPEC = "sim:walk?" + "&".join(f"{key}={value}" for key, value in WALK.items())


@pytest.fixture(scope="module")
def recorded(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("walks") / "walk.csv"
    path.write_bytes(encode(make_walk(WALK).recording))
    return path


def test_a_simulated_walk_knows_its_truth() -> None:
    replay = open_source(SPEC + "&speed=2&loop=1")
    assert set(replay.info.sensors) == {"left", "right"}
    assert (replay.speed, replay.loop) == (2.0, True)
    assert replay.info.truth is not None
    position, q_nb = replay.info.truth("left", np.array([0.0, 1.0]))
    assert (position.shape, q_nb.shape) == ((2, 3), (2, 4))


def test_a_recording_of_a_simulated_walk_knows_it_too(recorded: Path) -> None:
    live, replay = open_source(SPEC), open_source(str(recorded))
    assert isinstance(replay, Replay)
    assert live.info.truth is not None
    assert replay.info.truth is not None
    t_s = np.linspace(0.0, replay.duration_s, 50)
    for made, read in zip(live.info.truth("right", t_s), replay.info.truth("right", t_s), strict=True):
        np.testing.assert_array_equal(made, read)


def test_the_same_samples_either_way(recorded: Path) -> None:
    async def samples(spec: str) -> list[Sample]:
        stream = open_source(spec + ("&" if "?" in spec else "?") + "speed=0", finish=True)
        return [s._replace(host_ns=0, saturation=0) async for s in stream if isinstance(s, Sample)]

    assert asyncio.run(samples(SPEC)) == asyncio.run(samples(str(recorded)))


def test_one_foot_keeps_its_truth_and_turned_axes_lose_it(recorded: Path) -> None:
    assert open_source(f"{recorded}?foot=left").info.truth is not None
    assert open_source(f"{recorded}?axes=y,-x,z").info.truth is None


def test_an_edited_recording_has_no_truth(recorded: Path, tmp_path: Path) -> None:
    lines = recorded.read_text().splitlines()
    for edited in (lines[:-20], [lines[0].replace("distance_m=3", "distance_m=4"), *lines[1:]]):
        path = tmp_path / "edited.csv"
        path.write_text("\n".join(edited))
        assert open_source(str(path)).info.truth is None


@pytest.mark.parametrize(
    "spec", ["sim:swim", "sim:walk?colour=red", "sim:walk?noise=loud", "replay:tiger.csv"]
)
def test_a_spec_that_is_not_ours(recorded: Path, tmp_path: Path, spec: str) -> None:
    if spec.startswith("sim"):
        with pytest.raises(InputError):
            open_source(spec)
    path = tmp_path / "odd.csv"
    path.write_text("\n".join([f"# spec: {spec}", *recorded.read_text().splitlines()[1:]]))
    assert open_source(str(path)).info.truth is None


def test_a_missing_file_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        open_source(str(tmp_path / "none.csv"))
