"""`stridescope calibrate` as its user runs it, on a simulated sensor."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from app.commands.calibrate import Teller, bar
from app.motion.basics import InputError
from app.motion.status import GuideView
from app.shell import calibrate as calibrating
from app.shell.calibrate import calibrate
from app.simulate.calibration import make_calibration
from app.sources.inbox import Inbox
from tests.refusals import refused
from tests.sources.links import walk


def run(tmp_path: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "XDG_CONFIG_HOME": str(tmp_path)}
    command = [sys.executable, "-m", "app", "calibrate", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=200, env=environment, check=False)


def test_it_leads_finds_and_keeps(tmp_path: Path) -> None:
    out = tmp_path / "copy.json"
    done = run(tmp_path, "--source", "sim:calibration?seed=3&speed=0", "--field", "48.6", "--out", str(out))
    assert done.returncode == 0, done.stderr
    assert "1/10  Lay the sensor flat" in done.stdout
    assert "10/10  Lay it flat with x (the toe) to magnetic north" in done.stdout
    kept = list((tmp_path / "stridescope" / "calibrations").glob("*.json"))
    assert [path.read_text("utf-8") for path in kept] == [out.read_text("utf-8")]
    true = make_calibration({"seed": "3"})
    null = json.loads(out.read_text("utf-8"))["force"]["null"]
    np.testing.assert_allclose(null, true.force.null, atol=0.005)


def test_json_is_one_object_and_no_save_keeps_nothing(tmp_path: Path) -> None:
    done = run(tmp_path, "--source", "sim:calibration?speed=0&magnetometer=off", "--no-save", "--json")
    told = json.loads(done.stdout)
    assert set(told) == {"fit", "report"}
    assert "field" not in told["fit"]
    assert not (tmp_path / "stridescope" / "calibrations").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--source", "sim:walk?distance=3&speed=0"), "step"),
        (("--source", "sim:calibration", "--sensor", "left"), "expected one of foot"),  # before it plays
        (("--source", "sim:calibration", "--gravity", "5"), "--gravity"),
        (("--source", "sim:calibration?still=x"), "number"),
    ],
)
def test_what_cannot_be_is_one_line(
    arguments: tuple[str, ...], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert words in refused(capsys, "calibrate", "--no-save", *arguments)


def test_the_look_follows_the_guide() -> None:
    seen: list[GuideView] = []
    calibrate("sim:calibration?speed=0", None, seen.append)
    assert seen[-1].done
    with pytest.raises(InputError, match="ended at step 1"):
        calibrate("sim:walk?distance=2&speed=0&still=0.1", None, seen.append)


def test_a_live_source_without_the_sensor_says_which_it_hears(monkeypatch: pytest.MonkeyPatch) -> None:
    source, seen = Inbox("udp:1", "test"), list[str]()
    source.put(walk(3))
    monkeypatch.setattr(calibrating, "open_source", lambda *_, **__: source)
    monkeypatch.setattr(calibrating, "WATCH_S", 0.01)

    def look(view: GuideView) -> None:
        seen.append(view.note)
        signal.raise_signal(signal.SIGINT)

    with pytest.raises(InputError, match="given up"):
        calibrate("udp:1", "right", look)
    assert seen[0] == "waiting for right: only left is heard"


def test_a_terminal_is_told_each_step_once() -> None:
    view = GuideView("s", 2, 10, "Turn.", "x+", 0.5, "", 0.25, frozenset(), False)
    teller = Teller(live=True)
    assert "3/10  Turn." in teller.text(view)
    assert "Turn." not in teller.text(view)
    assert "[###---------]  25 %" in teller.text(view)
    assert bar(1.0, 4) == "[####] 100 %"
    assert Teller(live=False).text(view) == "3/10  Turn.\n"
