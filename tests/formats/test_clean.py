import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.clean import BACKWARD, NOT_FINITE, REPEATED, clean
from app.formats.raw import NO_STAMP, RawFoot
from app.motion import InputError

STAMPS = st.lists(
    st.one_of(st.integers(-50, 50), st.sampled_from([NO_STAMP, 2**62, -(2**62), 2**53])),
    min_size=1,
    max_size=30,
)


def raw(stamps: list[int], force: list[float] | None = None, field: list[float] | None = None) -> RawFoot:
    count = len(stamps)
    f = np.zeros((count, 3))
    f[:, 2] = force if force is not None else -9.8
    m = None if field is None else np.tile(np.array(field)[:, None], (1, 3))
    return RawFoot("foot", np.array(stamps, np.int64), f, np.zeros((count, 3)), m)


def one_by_one(stamps: list[int], usable: list[bool]) -> list[int]:
    """The rule a live intake follows, in a loop: finite, and later than the last one kept."""
    kept: list[int] = []
    for i, (stamp, fine) in enumerate(zip(stamps, usable, strict=True)):
        if fine and (not kept or stamp > stamps[kept[-1]]):
            kept.append(i)
    return kept


@given(STAMPS, st.data())
def test_the_same_rows_as_the_live_rule(stamps: list[int], data: st.DataObject) -> None:
    force = data.draw(
        st.lists(
            st.sampled_from([-9.8, math.nan, math.inf, 1e300]), min_size=len(stamps), max_size=len(stamps)
        )
    )
    usable = [s != NO_STAMP and f == -9.8 for s, f in zip(stamps, force, strict=True)]
    first = next((s for s, fine in zip(stamps, usable, strict=True) if fine), 0)
    usable = [fine and s - first < 2**53 for s, fine in zip(stamps, usable, strict=True)]
    kept = one_by_one(stamps, usable)
    if not kept:
        with pytest.raises(InputError):
            clean(raw(stamps, force))
        return
    samples = clean(raw(stamps, force))
    assert samples.device_ns + samples.matrix[:, 0].astype(int) == pytest.approx(
        [stamps[i] for i in kept], abs=0
    )
    assert len(samples) + sum(samples.dropped.values()) == len(stamps)


def test_each_reason_is_counted() -> None:
    samples = clean(raw([0, 10, 10, 5, 20, NO_STAMP, 30], [-9.8, -9.8, -9.8, -9.8, math.nan, -9.8, -9.8]))
    assert samples.matrix[:, 0].tolist() == [0, 10, 30]
    assert samples.dropped == {REPEATED: 1, BACKWARD: 1, NOT_FINITE: 2}


def test_a_gap_stays_a_gap() -> None:
    assert clean(raw([0, 10**10])).matrix[:, 0].tolist() == [0, 1e10]


def test_a_field_that_is_not_finite_is_no_field() -> None:
    samples = clean(raw([0, 1, 2], field=[40.0, math.nan, math.inf]))
    assert len(samples) == 3
    assert np.isfinite(samples.matrix[:, 7:]).tolist() == [[True] * 3, [False] * 3, [False] * 3]
