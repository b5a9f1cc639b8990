import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.basics import InputError
from app.sources.serial_spec import open_serial, port_specs
from app.sources.spec import Spec, parse_spec
from app.sources.starting import Wish


def test_one_port() -> None:
    (one,) = port_specs(parse_spec("serial:/dev/ttyUSB0?device=gx1&baud=38400&foot=left&rate=76"))
    assert (one.path, one.foot, one.axes, one.wish) == (
        "/dev/ttyUSB0",
        "left",
        None,
        Wish("gx1", 38400, 76.0),
    )


def test_two_ports_are_left_and_right_and_may_differ() -> None:
    left, right = port_specs(
        parse_spec("serial:/dev/a,/dev/b?device=mip&right.device=auto&left.axes=-x,y,-z")
    )
    assert (left.path, left.foot, left.wish.device) == ("/dev/a", "left", "mip")
    assert left.axes == ((0, -1), (1, 1), (2, -1))
    assert (right.path, right.foot, right.wish.device, right.axes) == ("/dev/b", "right", None, None)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("serial:a,b,c", "expected a port"),
        ("serial:a,a", "expected a port"),
        ("serial:a,", "expected a port"),
        ("serial:a,b?foot=left", "of two ports the first"),
        ("serial:a?foot=middle", "foot='middle'"),
        ("serial:a?device=toaster", "device='toaster': expected auto or one of gx1"),
        ("serial:a?baud=fast", "baud='fast'"),
        ("serial:a?baud=9600.5", "baud='9600.5'"),
        ("serial:a?baud=1", "baud='1'"),
        ("serial:a?rate=0", "rate='0'"),
        ("serial:a?axes=x,y", "axes='x,y'"),
        ("serial:a?colour=red", "unknown option 'colour'"),
        ("serial:a?columns=ax,ay,az", "say device=csv too"),
        ("serial:a?device=csv&columns=ax,ay", "columns=ax,ay: expected names"),
        ("serial:a,b?left.colour=red", "unknown option 'colour'"),
        ("serial:a,b?middle.axes=x,y,z", "unknown option 'middle.axes'"),
    ],
)
def test_what_is_wrong_is_named_in_one_line(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as error:
        port_specs(parse_spec(text))
    assert "\n" not in str(error.value)


def test_a_port_that_is_not_there_is_said_before_anything_opens() -> None:
    with pytest.raises(InputError, match="no such port, expected one that is there"):
        open_serial(parse_spec("serial:/dev/no-such-port"))


@given(st.text(max_size=30), st.dictionaries(st.text(max_size=8), st.text(max_size=8), max_size=3))
def test_anything_is_specs_or_an_input_error(target: str, options: dict[str, str]) -> None:
    try:
        specs = port_specs(Spec("serial", target, options))
    except InputError as error:
        assert str(error)
        return
    assert 1 <= len(specs) <= 2
