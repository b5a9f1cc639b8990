import numpy as np
import pytest

from app.formats.clock import stamps
from app.formats.raw import NO_STAMP
from app.motion.basics import InputError


def ns(cells: list[str], rate_hz: float | None = None) -> list[int]:
    return stamps("x.csv", np.array(cells), rate_hz)[0].tolist()


def test_seconds_and_nanoseconds() -> None:
    assert ns(["0.5", "1.25"]) == [500_000_000, 1_250_000_000]
    assert ns(["1700000000000000001", "1700000000000000009"]) == [1700000000000000001, 1700000000000000009]


@pytest.mark.parametrize(
    ("cell", "second"),
    [
        ("14:03:05.25", 50585.25),
        ("2022-10-21t14:03:05.25z", 50585.25),
        ("10/21/2022 2:03:05.25 pm", 50585.25),
        ("12:00:00 am", 0.0),
        ("12:00:01 pm", 43201.0),
        ("55:29.2", 3329.2),
    ],
)
def test_times_of_day(cell: str, second: float) -> None:
    assert ns([cell]) == [round(second * 1e9)]


def test_midnight_and_the_hour_are_passed() -> None:
    assert ns(["23:59:59.5", "00:00:00.5", "00:00:01.5"]) == [
        86399_500000000,
        86400_500000000,
        86401_500000000,
    ]
    assert ns(["59:59.5", "00:00.5"]) == [3599_500000000, 3600_500000000]


def test_an_unreadable_cell_among_others() -> None:
    assert ns(["00:00:01", "a:b:c", "1:2:3:4", "00:00:02"]) == [10**9, NO_STAMP, NO_STAMP, 2 * 10**9]


def test_a_clock_that_stands_still() -> None:
    with pytest.raises(InputError, match="every row has the time 00:00:01.*give rate="):
        stamps("x.csv", np.array(["00:00:01"] * 5), None)


def test_a_coarse_clock_is_spread() -> None:
    cells = [f"00:00:{i // 50:02d}" for i in range(501)]
    found, said = stamps("x.csv", np.array(cells), None)
    assert np.diff(found).tolist() == [20_000_000] * 500
    assert said == ("50 Hz assumed: the file's clock is too coarse, rows were spread evenly",)
