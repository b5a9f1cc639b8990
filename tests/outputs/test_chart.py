"""A plot becomes well-formed SVG whose marks lie where the numbers are."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.outputs.chart import BOTTOM, HEIGHT, LEFT, MOST_POINTS, RIGHT, TOP, WIDTH, Axis, chart
from app.studies.words import Curve, Plot


def parsed(plot: Plot) -> ET.Element:
    text = chart(plot)
    for attribute in ("class", "height", "width"):
        for word in ("grid", "line", "band", "mid", "end", "legend", "note", "cross"):
            text = text.replace(f"{attribute}={word}", f'{attribute}="{word}"')
    return ET.fromstring(text)


def one(x: np.ndarray, y: np.ndarray, dots: bool = True, log_x: bool = False, equal: bool = False) -> Plot:
    return Plot("t", "x, s", "y, m", (Curve("a", x, y, dots),), log_x=log_x, equal=equal)


def circles(plot: Plot) -> np.ndarray:
    found = parsed(plot).findall(".//circle")
    return np.array([[float(c.get("cx", "nan")), float(c.get("cy", "nan"))] for c in found])


@given(
    st.lists(st.tuples(st.floats(-1e6, 1e6), st.floats(-1e12, 1e12) | st.just(np.nan) | st.just(np.inf))),
    st.booleans(),
    st.booleans(),
    st.booleans(),
)
def test_any_numbers_make_a_plot_within_its_frame(
    points: list[tuple[float, float]], log_x: bool, log_y: bool, equal: bool
) -> None:
    x, y = np.array(points, dtype=np.float64).reshape(-1, 2).T
    plot = Plot("t", "x", "y", (Curve("a", x, y, dots=True),), log_x=log_x, log_y=log_y, equal=equal)
    at = circles(plot)
    if len(at):
        assert np.isfinite(at).all()
        assert (at[:, 0] >= LEFT - 0.1).all()
        assert (at[:, 0] <= WIDTH - RIGHT + 0.1).all()
        assert (at[:, 1] >= TOP - 0.1).all()
        assert (at[:, 1] <= HEIGHT - BOTTOM + 0.1).all()


def test_marks_are_linear_in_the_values_and_up_is_more() -> None:
    at = circles(one(np.array([0.0, 1.0, 3.0]), np.array([0.0, 2.0, 6.0])))
    steps = np.diff(at, axis=0)
    np.testing.assert_allclose(steps[1], 2 * steps[0], atol=0.2)
    assert steps[0][1] < 0


def test_a_logarithmic_axis_makes_decades_equal() -> None:
    at = circles(one(np.array([1.0, 10.0, 100.0]), np.ones(3), log_x=True))
    assert at[1, 0] - at[0, 0] == pytest.approx(at[2, 0] - at[1, 0], abs=0.2)


def test_a_metre_is_a_metre_on_both_axes() -> None:
    at = circles(one(np.array([0.0, 1.0, 1.0]), np.array([0.0, 0.0, 1.0]), equal=True))
    assert at[1, 0] - at[0, 0] == pytest.approx(at[1, 1] - at[2, 1], abs=0.2)


def test_ticks_lie_at_the_values_they_tell() -> None:
    axis = Axis(-1.3, 4.2, 0.0, 550.0, log=False)
    for pixel, text in axis.ticks():
        value = float(text.replace("−", "-"))
        assert pixel == pytest.approx((value + 1.3) / 5.5 * 550.0)
    assert len(axis.ticks()) >= 3


def test_long_curves_are_thinned() -> None:
    many = np.linspace(0.0, 1.0, 100_000)
    assert chart(one(many, many, dots=False)).count("L") < MOST_POINTS + 10


def test_words_never_become_markup() -> None:
    text = chart(Plot("<b>", "<i>", "<u>", (Curve("<s>", np.ones(1), np.ones(1)),) * 2, note="<q>"))
    for tag in ("<b>", "<i>", "<u>", "<s>", "<q>"):
        assert tag not in text
