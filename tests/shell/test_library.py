"""Recordings as files: info, recover."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from app.__main__ import main
from app.formats.keeping import Keeper
from app.motion.basics import Role
from app.shell.library import info
from tests.formats.walks import CLOCK_NS, random_samples, write


@pytest.fixture
def damaged(tmp_path: Path) -> Path:
    path = tmp_path / "walk.mcap"
    path.write_bytes(write(random_samples(100))[:-3000])
    return path


def test_recover_writes_beside_and_keeps_the_damaged_one(damaged: Path, capsys) -> None:
    before = damaged.read_bytes()
    assert main(["recover", str(damaged)]) == 0
    assert main(["recover", str(damaged)]) == 0
    assert damaged.read_bytes() == before
    names = sorted(path.name for path in damaged.parent.iterdir())
    assert names == ["walk.mcap", "walk_recovered.mcap", "walk_recovered_2.mcap"]
    assert "samples" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["recover", "info"])
def test_what_is_no_recording_is_one_line(command: str, tmp_path: Path, capsys) -> None:
    for name, data in (("empty", b""), ("text.mcap", b"Dear Sir"), ("none", None)):
        if data is not None:
            (tmp_path / name).write_bytes(data)
        assert main([command, str(tmp_path / name)]) == 2
        error = capsys.readouterr().err
        assert name in error
        assert error.count("\n") == 1


def test_info_tells_all_of_a_recording(tmp_path: Path, capsys) -> None:
    path = tmp_path / "walk.mcap"
    path.write_bytes(write(random_samples(100)))
    assert main(["info", str(path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["sensors"]["left"]["samples"] == 50
    assert told["sensors"]["left"]["rate_hz"] == pytest.approx(100.0)
    assert told["lost"] == {"left": 0, "right": 0}
    assert told["closed"] is True
    assert main(["info", str(path)]) == 0
    assert "50 samples at 100.0 Hz" in capsys.readouterr().out


def test_info_says_which_foot_a_tap_named(tmp_path: Path, capsys) -> None:
    made = Keeper({}, {"phone": Role.OTHER, "left": Role.LEFT}, CLOCK_NS)
    data = made.begin(0)
    for i, sample in enumerate(random_samples(40)):
        made.sample(sample._replace(sensor="left" if i % 2 else "phone"))
    data += made.chunk()
    made.learnt(10**9, {"sensors": {"phone": "right", "left": "left"}})
    path = tmp_path / "walk.mcap"
    path.write_bytes(data + made.end())
    assert main(["info", str(path)]) == 0
    told = capsys.readouterr().out
    assert "phone (right): 20 samples" in told
    assert "left: 20 samples" in told


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.65])
@pytest.mark.parametrize("jitter_ms", [0.0, 1.5])
def test_info_counts_what_is_missing_between_stamps(share: float, jitter_ms: float, tmp_path: Path) -> None:
    """Also where more than half is; of stamps that tremble no step is certain, but none is invented."""
    random = np.random.default_rng(3)
    came = [i for i in range(2000) if i in (0, 1999) or random.random() >= share]
    rows = [f"{0.01 * i + random.uniform(-1, 1) * jitter_ms / 1000:.6f},foot,0,0,-9.8,0,0,0,,," for i in came]
    header = "t_s,foot,fx_mps2,fy_mps2,fz_mps2,wx_radps,wy_radps,wz_radps,mx_gauss,my_gauss,mz_gauss"
    path = tmp_path / "walk.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    told = info(str(path))["sensors"]["foot"]
    if jitter_ms and share:
        assert told["missing"] <= 2000 - len(came) + 100
    else:
        assert told["missing"] == 2000 - len(came)
        assert told["rate_hz"] == pytest.approx(100.0, rel=0.01)


def test_info_tells_of_any_recording(capsys) -> None:
    demo = Path(__file__).parents[2] / "recordings" / "demo.csv"
    assert main(["info", str(demo)]) == 0
    assert "plain CSV" in capsys.readouterr().out


def test_info_tells_what_is_missing_between_stamps(tmp_path: Path, capsys) -> None:
    walk = [s for s in random_samples(200) if s.sensor == "left" and s.seq not in (20, 21, 50) and s.seq < 60]
    later = [s._replace(device_ns=s.device_ns + 3 * 10**9, seq=s.seq + 60) for s in walk[:10]]
    renumbered = [s._replace(seq=i) for i, s in enumerate([*walk, *later])]  # as a decoder numbers them
    path = tmp_path / "walk.mcap"
    path.write_bytes(write(renumbered))
    assert main(["info", str(path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    left = told["sensors"]["left"]
    assert told["lost"] == {"left": 0}
    assert (left["missing"], left["gaps"]) == (3, 1)
    assert left["gaps_s"] == pytest.approx(2.41)
    assert main(["info", str(path)]) == 0
    assert "3 lost, 0 dropped" in (text := capsys.readouterr().out)
    assert "1 gap of 2.4 s" in text
