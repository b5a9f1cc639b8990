"""A calibration as JSON: what was kept is what is read, and nothing else is read."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.calibration.words import Calibration, Correction, from_json, to_json
from app.motion.basics import InputError

KEPT = Calibration(
    "gx1 1234", "2026-11-22T03:00:00+0000", "fit",
    Correction((0.1, -0.2, 0.3), ((1.01, 0.0, 0.0), (0.0, 0.99, 0.001), (0.0, 0.001, 1.0))),
    Correction((0.01, 0.0, -0.02)),
    Correction((12.0, -3.0, 4.0)),
    {"force rms m/s²": 0.002},
)  # fmt: skip


def test_what_was_kept_is_what_is_read() -> None:
    assert from_json("x", to_json(KEPT)) == KEPT
    bare = Calibration("a", "b", "report")
    assert from_json("x", to_json(bare)) == bare


def test_it_is_for_a_person_to_read() -> None:
    told = json.loads(to_json(KEPT))
    assert told["force"]["unit"] == "m/s²"
    assert told["made"].startswith("2026-11-22")
    assert "null" in told["meaning"]


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("force", "null"), [1e9, 0, 0]), (("force", "null"), [0, 0]), (("rate", "unit"), "deg/s"),
        (("field", "scale"), [[1, 0, 0], [0, 1, 0]]), (("rate", "scale"), [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        (("stridescope_calibration",), 2), (("sensor",), 5), (("force",), "x"), (("force", "null"), "abc"),
    ],
)  # fmt: skip
def test_what_is_not_plausible_is_refused_in_one_line(path: tuple[str, ...], value: object) -> None:
    told = json.loads(to_json(KEPT))
    place = told
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    with pytest.raises(InputError) as refused:
        from_json("x.json", json.dumps(told))
    assert str(refused.value).startswith("calibration x.json: ")
    assert "\n" not in str(refused.value)


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused(text: str) -> None:
    with pytest.raises(InputError):
        from_json("x", text)


@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(max_size=5) | st.integers(),
        lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    )
)
def test_any_json_in_its_place_is_read_or_refused(value: object) -> None:
    for key in ("force", "residuals", "made"):
        told = json.loads(to_json(KEPT)) | {key: value}
        try:
            from_json("x", json.dumps(told))
        except InputError:
            continue
