import math

import numpy as np
import pytest

from app.formats.saturation import RANGES, Range, saturation

G = 9.80665


def matrix(channel: int, values: list[float]) -> np.ndarray:
    table = np.zeros((len(values), 10))
    table[:, 7:] = np.nan
    table[:, channel] = values
    return table


@pytest.mark.parametrize(("channel", "full"), [(1, 5 * G), (3, 5 * G), (5, math.radians(300)), (9, 120.0)])
def test_a_known_range_flags_from_98_percent_either_way(channel: int, full: float) -> None:
    bits = saturation(matrix(channel, [0, 0.97 * full, 0.99 * full, -full, full]), RANGES["gx1"])
    assert bits.tolist() == [0, 0, 1 << (channel - 1), 1 << (channel - 1), 1 << (channel - 1)]


def test_an_evident_range_is_a_large_extreme_repeated_in_a_row() -> None:
    clipped = [0.0, 30.0, 49.0, 49.0, 49.0, 20.0, 48.9]
    assert saturation(matrix(2, clipped), Range()).tolist() == [0, 0, 2, 2, 2, 0, 2]


@pytest.mark.parametrize(
    "values",
    [
        [0.0, 49.0, 48.0, 49.0, 48.0, 49.0],  # never twice in a row
        [0.0, 49.0, 49.0, 20.0],  # twice only
        [9.8, 9.8, 9.8, 9.8],  # a coarse sensor at rest
        [],
    ],
)
def test_other_extremes_are_left_alone(values: list[float]) -> None:
    assert not saturation(matrix(2, values), Range()).any()


def test_a_missing_field_is_not_at_its_range() -> None:
    assert not saturation(matrix(1, [0.0, 1.0]), RANGES["gx1"]).any()
