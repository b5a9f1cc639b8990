import pytest

from app.formats.mounting import parse_axes
from app.formats.options import Options, parse_options
from app.motion.basics import InputError


def test_all_of_them() -> None:
    texts = {"rate": "128", "axes": "x,-y,-z", "foot": "left", "device": "gx1"}
    assert parse_options(texts) == Options(128.0, parse_axes("x,-y,-z"), "left", "gx1")
    assert parse_options({}) == Options()
    assert parse_options({"device": "auto"}) == Options()


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("rate", "fast"),
        ("rate", "0"),
        ("rate", "-5"),
        ("rate", "nan"),
        ("rate", "inf"),
        ("rate", ""),
        ("axes", "x,y"),
        ("foot", "both"),
        ("device", "wii"),
        ("colour", "red"),
    ],
)
def test_misuse_is_one_line_that_names_it(key: str, value: str) -> None:
    with pytest.raises(InputError, match=f"{key}.*expected") as error:
        parse_options({key: value})
    assert "\n" not in str(error.value)
