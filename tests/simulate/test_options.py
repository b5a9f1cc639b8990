"""Reading a SPEC's query: every key both ways, and one clear line for whatever is wrong."""

from __future__ import annotations

import re
from urllib.parse import parse_qsl

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.basics import InputError
from app.simulate.options import MODELS, PATHS, WalkOptions, parse, spec_of

numbers = st.floats(-3.0, 3.0).map(lambda x: float(f"{x:.12g}"))
some_options = st.fixed_dictionaries(
    {},
    optional={
        "path": st.sampled_from(PATHS),
        "feet": st.sampled_from([1, 2]),
        "strides": st.integers(1, 50),
        "rate_hz": st.integers(20, 400).map(float),
        "stride_m": st.sampled_from([0.5, 1.2, 1.37]),
        "seed": st.integers(0, 2**63 - 1),
        "magnetometer": st.booleans(),
        "gyro_bias_radps": st.tuples(numbers, numbers, numbers),
        "iron_beside_m": numbers,
        "accelerometer_range_g": st.sampled_from([5.0, 16.0]),
    },
)


@given(some_options)
def test_a_spec_reads_back(values: dict[str, object]) -> None:
    options = WalkOptions(**values)  # type: ignore[arg-type]
    query = spec_of(options).partition("?")[2]
    assert parse(dict(parse_qsl(query))) == options


@given(
    st.dictionaries(st.sampled_from(list(WalkOptions.__dataclass_fields__)), st.text(max_size=12), max_size=3)
)
def test_any_text_is_read_or_refused_in_one_line(texts: dict[str, str]) -> None:
    try:
        assert isinstance(parse(texts), WalkOptions)
    except InputError as error:
        assert str(error).startswith("sim:walk: ")
        assert len(str(error).splitlines()) == 1


@pytest.mark.parametrize(("texts", "says"), [
    ({"speed": "2"}, "unknown option 'speed'.*one of model, path,"),
    ({"path": "moon"}, "path='moon'.*straight, oval, square, eight, stairs"),
    ({"rate_hz": "fast"}, "rate_hz='fast'.*a number from 20 to 2000"),
    ({"rate_hz": "nan"}, "rate_hz='nan'.*a number from 20"),
    ({"rate_hz": "inf"}, "rate_hz='inf'"),
    ({"rate_hz": "5"}, "rate_hz='5'.*from 20 to 2000"),
    ({"strides": "1.5"}, "strides='1.5'.*a whole number"),
    ({"feet": "3"}, "feet='3'.*from 1 to 2"),
    ({"magnetometer": "maybe"}, "magnetometer='maybe'.*on or off"),
    ({"gyro_bias_radps": "1,2"}, "gyro_bias_radps='1,2'.*three numbers x,y,z"),
    ({"strides": "3", "distance_m": "4"}, "distance_m and strides together.*only one"),
    ({"laps": "2"}, "laps with path=straight"),
    ({"path": "stairs", "size_m": "9"}, "size_m with path=stairs"),
    ({"model": "papers", "path": "oval"}, "model=papers with path=oval: expected path=straight"),
])  # fmt: skip
def test_what_is_wrong_is_named(texts: dict[str, str], says: str) -> None:
    with pytest.raises(InputError, match=says):
        parse(texts)


def test_as_usual() -> None:
    assert parse({}) == WalkOptions()
    assert spec_of(WalkOptions()) == "sim:walk"
    assert spec_of(WalkOptions(path="eight", magnetometer=False)) == "sim:walk?path=eight&magnetometer=off"


def test_every_option_has_a_sentence_and_its_unit_in_its_name() -> None:
    units = r"_(m|s|hz|spm|deg|mps2|radps|gauss|g|dps|m3)$|_fraction$"
    for name, field in WalkOptions.__dataclass_fields__.items():
        option = field.metadata["option"]
        assert option.sentence
        plain = option.kind in ("choice", "switch", "integer") or name in ("noise", "bias", "iron_along")
        assert plain or re.search(units, name), name
    assert "papers" in MODELS


def test_a_unit_may_be_left_out() -> None:
    short = parse({"rate": "50", "cadence": "100", "gyro_bias": "0,0,1"})
    assert short == parse({"rate_hz": "50", "cadence_spm": "100", "gyro_bias_radps": "0,0,1"})


def test_a_key_said_both_ways_is_refused() -> None:
    with pytest.raises(InputError, match="rate_hz is given twice"):
        parse({"rate": "50", "rate_hz": "60"})
