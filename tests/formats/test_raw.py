import numpy as np
import pytest

from app.formats.raw import NO_STAMP, even_stamps, whole_ns


@pytest.mark.parametrize("rate_hz", [50.0, 204.8, 256.0, 333.3])
def test_even_stamps_are_each_rounded_once(rate_hz: float) -> None:
    """No rounding adds up: an hour later a stamp is still within half a nanosecond, and an ulp."""
    index = np.arange(int(3600 * rate_hz))
    stamps = even_stamps(index, rate_hz)
    assert np.abs(stamps - index * 1e9 / rate_hz).max() <= 0.501
    assert set(np.diff(stamps).tolist()) <= {int(1e9 / rate_hz), int(1e9 / rate_hz) + 1}


def test_what_is_no_stamp() -> None:
    stamps = np.array([0.4, 0.6, np.nan, np.inf, -np.inf, 1e300, 2.0**62, -5.0])
    assert whole_ns(stamps).tolist() == [0, 1, *[NO_STAMP] * 5, -5]
