import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.faults import Faults, Line, Outage, parse_faults
from app.motion.basics import InputError


def test_what_is_typed() -> None:
    typed = ["lost=1%", "flip=0.02", "garbage=0", "unplug=5", "brownout=0.5@20", "drift=-50", "burst=16"]
    assert parse_faults(typed) == Faults(
        0.01, 0.02, 0.0, -50.0, 0.016, (Outage(5.0, 10.0),), (Outage(0.5, 20.0),)
    )


@pytest.mark.parametrize(
    "wrong", ["lost", "lost=2", "lost=200%", "flip=nan", "colour=1", "", "burst=-1", "drift=fast"]
)
def test_what_is_wrong_is_one_line(wrong: str) -> None:
    with pytest.raises(InputError, match="--fault") as error:
        parse_faults([wrong])
    assert "\n" not in str(error.value)


@given(st.binary(max_size=2000), st.integers(0, 99))
def test_damage_is_counted_and_repeatable(data: bytes, seed: int) -> None:
    faults = Faults(lost=0.1, flip=0.1, garbage=0.1)
    line, again = Line(faults, seed), Line(faults, seed)
    arrived = line.carry(data)
    assert arrived == again.carry(data)
    assert len(arrived) == len(data) - line.lost + line.strays
    if line.lost == line.strays == 0:
        assert sum(a != b for a, b in zip(data, arrived, strict=True)) == line.flipped


def test_a_sound_line_changes_nothing() -> None:
    assert Line(Faults()).carry(b"\x00\x10\xff") == b"\x00\x10\xff"
