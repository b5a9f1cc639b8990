"""Settings: every limit holds, and every setting can be told to a person."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError, fields, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.limits import Value
from app.settings import BUILT_IN, LIMITS, Settings, parse

PAPERS = BUILT_IN["papers"]
DEFAULTS: dict[str, Value] = {f.name: getattr(PAPERS, f.name) for f in fields(Settings)}
SWITCHES = [name for name, value in DEFAULTS.items() if isinstance(value, bool)]
WORDS = [name for name, value in DEFAULTS.items() if isinstance(value, str)]
NUMBERS = [name for name in DEFAULTS if name not in SWITCHES + WORDS]


@pytest.mark.parametrize("name", DEFAULTS)
def test_every_setting_has_a_name_and_a_sentence(name: str) -> None:
    limit = LIMITS[name]
    assert limit.label
    assert limit.sentence.endswith(".")
    assert len(limit.sentence) > 20


@pytest.mark.parametrize("name", NUMBERS)
def test_every_number_has_a_unit_and_a_safe_range_around_its_default(name: str) -> None:
    limit, default = LIMITS[name], DEFAULTS[name]
    assert limit.unit
    assert isinstance(default, float)
    assert limit.low <= limit.safe[0] <= default <= limit.safe[1] <= limit.high
    assert 0 < limit.step < limit.safe[1] - limit.safe[0]


@pytest.mark.parametrize("name", WORDS)
def test_every_choice_holds_its_default(name: str) -> None:
    assert DEFAULTS[name] in LIMITS[name].choices


def test_labels_differ() -> None:
    assert len({limit.label for limit in LIMITS.values()}) == len(LIMITS)


@pytest.mark.parametrize("name", NUMBERS)
def test_a_number_may_be_at_its_limits_and_not_beyond(name: str) -> None:
    low, high = LIMITS[name].low, LIMITS[name].high
    for value in (low, high):
        assert getattr(PAPERS.with_changes({name: value}), name) == value
    for value in (
        math.nextafter(low, -math.inf),
        math.nextafter(high, math.inf),
        math.inf,
        -math.inf,
        math.nan,
    ):
        with pytest.raises(ValueError, match=name):
            PAPERS.with_changes({name: value})


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [True, "1", None, [1.0], 1j])
def test_a_number_is_nothing_else(name: str, value: Value) -> None:
    with pytest.raises(ValueError, match=f"{name}.*expected a number"):
        PAPERS.with_changes({name: value})


@pytest.mark.parametrize("name", SWITCHES)
@pytest.mark.parametrize("value", [1, 0.0, "true", None])
def test_a_switch_is_nothing_else(name: str, value: Value) -> None:
    with pytest.raises(ValueError, match=f"{name}.*expected true or false"):
        PAPERS.with_changes({name: value})


@pytest.mark.parametrize("name", WORDS)
@pytest.mark.parametrize("value", ["", "magic", 3.0, True])
def test_a_choice_is_one_of_its_words(name: str, value: Value) -> None:
    with pytest.raises(ValueError, match=f"{name}.*expected one of"):
        PAPERS.with_changes({name: value})


def test_an_error_says_what_came_and_what_was_expected() -> None:
    with pytest.raises(ValueError, match=r"gain_stance = 51: expected 0 to 50 1/s$"):
        Settings(gain_stance=51.0)


def test_an_unknown_key_is_named_with_those_there_are() -> None:
    with pytest.raises(ValueError, match="unknown setting 'gain': expected one of .*gain_stance"):
        PAPERS.with_changes({"gain": 1.0})
    with pytest.raises(ValueError, match="unknown setting 'gain'"):
        parse("gain", "1")


def test_whole_numbers_are_kept_as_floats() -> None:
    assert type(Settings(gain_stance=1).gain_stance) is float


def test_settings_stay_as_they_are() -> None:
    with pytest.raises(FrozenInstanceError):
        PAPERS.gain_stance = 2.0  # type: ignore[misc]
    assert PAPERS.with_changes({"gain_stance": 2.0}).gain_stance == 2.0
    assert PAPERS == Settings()


@given(st.sampled_from(NUMBERS), st.floats(0.0, 1.0))
def test_what_is_written_is_parsed_back(name: str, share: float) -> None:
    limit = LIMITS[name]
    value = min(limit.high, limit.low + share * (limit.high - limit.low))
    assert parse(name, repr(value)) == value
    assert getattr(PAPERS.with_changes({name: parse(name, repr(value))}), name) == value


@pytest.mark.parametrize(
    ("words", "value"), [(("on", "Yes", "true", "1"), True), (("off", "no", "FALSE", "0"), False)]
)
def test_switches_are_typed_as_words(words: tuple[str, ...], value: bool) -> None:
    assert {parse("magnetometer", word) for word in words} == {value}


def test_choices_are_typed_as_they_are() -> None:
    assert parse("estimator", "papers") == "papers"


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("gain_stance", "much", "expected a number in 1/s"),
        ("gain_stance", "", "expected a number"),
        ("magnetometer", "maybe", "expected on or off"),
    ],
)
def test_a_bad_word_is_named(name: str, text: str, said: str) -> None:
    with pytest.raises(ValueError, match=f"{name}='{text}': {said}"):
        parse(name, text)


@given(st.text())
def test_any_text_is_a_setting_or_one_line_of_error(text: str) -> None:
    for name in DEFAULTS:
        try:
            PAPERS.with_changes({name: parse(name, text)})
        except ValueError as error:
            assert str(error).startswith(name)
            assert len(str(error).splitlines()) == 1


def test_no_difference_is_no_words() -> None:
    assert PAPERS.differences(PAPERS) == ""


@given(st.sampled_from(NUMBERS))
def test_a_difference_names_the_setting_the_old_and_the_new(name: str) -> None:
    new = PAPERS.with_changes({name: LIMITS[name].high})
    assert PAPERS.differences(new) == f"{name} {DEFAULTS[name]:.4g} → {LIMITS[name].high:.4g}"


def test_differences_are_told_in_the_order_of_the_panel() -> None:
    new = replace(PAPERS, magnetometer=True, gain_stance=2.0)
    assert PAPERS.differences(new) == "gain_stance 1.05 → 2, magnetometer false → true"
