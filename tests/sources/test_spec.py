import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.basics import InputError
from app.sources.spec import KINDS, Spec, parse_spec


@pytest.mark.parametrize(
    ("text", "spec"),
    [
        ("walk.csv", Spec("replay", "walk.csv")),
        ("replay:walk.csv", Spec("replay", "walk.csv")),
        ("./a folder/näme:1.csv", Spec("replay", "./a folder/näme:1.csv")),
        ("C:/walk.csv", Spec("replay", "C:/walk.csv")),
        ("replay:w.csv?speed=2&loop=1", Spec("replay", "w.csv", speed=2.0, loop=True)),
        ("w.csv?speed=0&loop=off", Spec("replay", "w.csv", speed=0.0)),
        (
            "w.csv?rate=128&axes=x,-y,-z&foot=left&device=gx1",
            Spec("replay", "w.csv", {"rate": "128", "axes": "x,-y,-z", "foot": "left", "device": "gx1"}),
        ),
        ("w.csv?axes=+x,%2dy,-z", Spec("replay", "w.csv", {"axes": "+x,-y,-z"})),
        ("sim:walk", Spec("sim", "walk")),
        (
            "sim:walk?path=oval&noise=2&speed=8",
            Spec("sim", "walk", {"path": "oval", "noise": "2"}, speed=8.0),
        ),
        (
            "serial:/dev/ttyUSB0?device=auto&baud=115200",
            Spec("serial", "/dev/ttyUSB0", {"device": "auto", "baud": "115200"}),
        ),
        ("udp:9000", Spec("udp", "9000")),
    ],
)
def test_forms(text: str, spec: Spec) -> None:
    assert parse_spec(text) == spec


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no path"),
        ("replay:", "no path"),
        ("sim:", "no simulator"),
        ("w.csv?colour=red", "unknown option 'colour', expected one of speed, loop, changes, rate"),
        ("w.csv?loop", "option 'loop', expected key=value"),
        ("w.csv?=1", "expected key=value"),
        ("w.csv?speed=2&speed=3", "'speed' is given twice"),
        ("w.csv?speed=fast", "speed='fast': expected 0.1 to 8"),
        ("w.csv?speed=9", "speed='9': expected"),
        ("w.csv?speed=-1", "speed='-1': expected"),
        ("w.csv?speed=nan", "speed='nan': expected"),
        ("w.csv?loop=maybe", "loop='maybe': expected 1 or 0"),
        ("serial:", "no port"),
        ("serial:/dev/ttyUSB0?device", "expected key=value"),
    ],
)
def test_what_is_wrong_is_named_in_one_line(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as error:
        parse_spec(text)
    assert "\n" not in str(error.value)


@given(st.text(max_size=60))
def test_any_text_is_a_spec_or_an_input_error(text: str) -> None:
    try:
        spec = parse_spec(text)
    except InputError as error:
        assert "\n" not in str(error)
        return
    assert spec.kind in KINDS
    assert spec.target
