"""`stridescope gestures`: one JSON object, lines for a person, one line for an error."""

from __future__ import annotations

import itertools
import json

import pytest

from app.__main__ import main
from app.motion.basics import MotionId

SCRIPT = "sim:gestures?script=none:2,forward:5,none:2,turn_ccw:4,none:2&vary=0"


@pytest.mark.parametrize("decoder", ["default", "papers"])
def test_json_is_one_object_with_every_key(decoder: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gestures", SCRIPT, "--decoder", decoder, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    decisions = told["decisions"]
    assert told["decoder"] == decoder
    times = [d["t_s"] for d in decisions]
    assert times == sorted(times)
    for d in decisions:
        assert MotionId(d["motion_id"]).name.lower() == d["motion"]
        assert d["speed_mps"] >= 0.0
        assert 0.0 <= d["confidence"] <= 1.0
    motions = {d["motion"] for d in decisions}
    assert {"forward", "turn_ccw", "none"} <= motions
    assert decisions[-1]["motion"] == "none"


def test_every_decision_is_a_change(capsys: pytest.CaptureFixture[str]) -> None:
    main(["gestures", SCRIPT, "--json"])
    decisions = json.loads(capsys.readouterr().out)["decisions"]
    keys = [(d["motion_id"], d["speed_mps"], d["turn_radps"], d["certain"]) for d in decisions]
    assert all(a != b for a, b in itertools.pairwise(keys))


def test_a_person_is_told_in_lines_with_reasons(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gestures", SCRIPT]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("sim:gestures (simulator): ")
    assert any("both feet march" in line for line in lines)


def test_one_foot_is_one_line_and_exit_2(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gestures", "sim:walk?strides=2"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert "expected the sensors left and right" in said.err
