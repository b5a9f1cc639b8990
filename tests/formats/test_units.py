import math

import pytest

from app.formats.units import FIELD, FORCE, RATE, factor, split_unit
from app.motion.basics import InputError


@pytest.mark.parametrize(
    ("unit", "table", "si"),
    [
        ("g", FORCE, 9.80665),
        ("mg", FORCE, 0.00980665),
        ("m/s^2", FORCE, 1.0),
        ("deg/s", RATE, math.pi / 180),
        ("rad/s", RATE, 1.0),
        ("G", FIELD, 100.0),
        ("gauss", FIELD, 100.0),
        ("uT", FIELD, 1.0),
        ("a.u.", FIELD, 1.0),
    ],
)
def test_factors_to_si(unit: str, table: dict[str, float], si: float) -> None:
    assert factor("x.csv", "A", unit, table) == pytest.approx(si)


@pytest.mark.parametrize("unit", [None, "furlong"])
def test_no_or_strange_units_name_the_column(unit: str | None) -> None:
    with pytest.raises(InputError, match="x.csv: column 'Accelerometer X'.*expected m/s².*g"):
        factor("x.csv", "Accelerometer X", unit, FORCE)


def test_units_in_round_and_square_brackets() -> None:
    assert split_unit("Time (s)") == ("Time", "s")
    assert split_unit("acc [m/s^2]") == ("acc", "m/s^2")
    assert split_unit("Time") == ("Time", None)
    assert split_unit("(s)") == ("(s)", None)
