"""Reading the query of sim:gestures: every key both ways, and one clear line for whatever is wrong."""

from __future__ import annotations

from urllib.parse import parse_qsl

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.basics import InputError
from app.simulate.gestures_options import GESTURES, IDLE, GestureOptions, bars_of, parse, spec_of

a_bar = st.builds("{}:{}".format, st.sampled_from([*GESTURES, *IDLE]), st.integers(1, 90))
scripts = st.lists(a_bar, min_size=1, max_size=6).map(",".join) | st.just("random:20")
some_options = st.fixed_dictionaries(
    {"script": scripts},
    optional={
        "cadence_hz": st.sampled_from([0.6, 1.0, 2.0]),
        "amplitude": st.sampled_from([0.3, 1.0, 1.5]),
        "hesitation": st.floats(0.0, 1.0).map(lambda x: round(x, 6)),
        "mounting_deg": st.sampled_from([0.0, 12.5]),
        "seed": st.integers(0, 2**63 - 1),
    },
)


@given(some_options)
def test_a_spec_reads_back(values: dict[str, object]) -> None:
    options = GestureOptions(**values)  # type: ignore[arg-type]
    query = spec_of(options).partition("?")[2]
    assert parse(dict(parse_qsl(query))) == options


def test_units_may_be_left_out() -> None:
    assert parse({"cadence": "1.4", "rate": "60"}) == GestureOptions(cadence_hz=1.4, rate_hz=60.0)


@given(st.dictionaries(st.sampled_from(["script", "cadence", "seed", "noise", "x"]), st.text(max_size=20)))
def test_any_text_is_options_or_one_line(texts: dict[str, str]) -> None:
    try:
        parse(texts)
    except InputError as error:
        assert str(error).startswith("sim:gestures: ")


@pytest.mark.parametrize(
    ("texts", "words"),
    [
        ({"script": "hop:3"}, "'hop': expected one of"),
        ({"script": "forward"}, "expected forward:SECONDS"),
        ({"script": "forward:nan"}, "expected forward:SECONDS"),
        ({"script": "random:5,none:3"}, "expected random:BOUTS alone"),
        ({"script": "none:30000,none:30000"}, "at most 36000 s"),
        ({"cadence": "9"}, "cadence_hz=9: expected 0.3 to 3"),
        ({"cadence": "quick"}, "expected a number"),
        ({"cadence": "1", "cadence_hz": "1"}, "given twice"),
        ({"speed_of_light": "1"}, "unknown option"),
    ],
)
def test_what_is_wrong_is_said(texts: dict[str, str], words: str) -> None:
    with pytest.raises(InputError, match=words):
        parse(texts)


def test_a_script_is_its_bars() -> None:
    assert bars_of("none:2, forward:6.5") == (("none", 2.0), ("forward", 6.5))
