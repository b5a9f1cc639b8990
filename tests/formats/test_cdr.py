"""ROS 2 messages: every double back to the bit, laid out as the definitions say."""

from __future__ import annotations

import math
import struct

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.formats import cdr
from app.formats.records import WIDTH, At, last_doubles

doubles = st.floats(allow_nan=False, width=64)
vectors = st.tuples(doubles, doubles, doubles)
names = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=12)


def doubles_of(messages: list[bytes], count: int, columns=(0, 1, 2)) -> np.ndarray:
    rows = np.zeros((len(messages), WIDTH), np.int64)
    rows[:, At.END] = np.cumsum([len(message) for message in messages])
    rows[1:, At.BEGIN] = rows[:-1, At.END]
    return last_doubles(b"".join(messages), rows, count, columns)


@given(st.integers(-(2**63), 2**63 - 1), names, vectors, vectors, st.none() | st.tuples(*[doubles] * 4))
def test_imu_comes_back(stamp_ns, frame, rate, force, q_nb) -> None:
    message = cdr.imu(stamp_ns, frame, q_nb, rate, force)
    q, w, f = cdr.imu_columns(doubles_of([message, message], cdr.IMU_DOUBLES, cdr.IMU_COLUMNS))
    assert tuple(w[1].tolist()) == rate
    assert tuple(f[1].tolist()) == force
    assert np.isnan(q[0]).all() if q_nb is None else tuple(q[0].tolist()) == q_nb


def test_imu_is_laid_out_as_its_definition() -> None:
    message = cdr.imu(1_500_000_002, "foot", (0.1, 0.2, 0.3, 0.4), (1.0, 2.0, 3.0), (4.0, 5.0, 6.0))
    assert struct.unpack_from("<4siII5s", message) == (b"\0\1\0\0", 1, 500_000_002, 5, b"foot\0")
    assert (len(message) - 4) % 8 == 0  # doubles are aligned from behind the encapsulation
    assert struct.unpack_from("<4d", message, 4 + 24) == (0.2, 0.3, 0.4, 0.1)
    assert struct.unpack_from("<3d", message, 4 + 24 + 13 * 8) == (1.0, 2.0, 3.0)


@given(vectors)
def test_a_field_comes_back_or_says_that_it_does_not(field_ut) -> None:
    field_t = cdr.tesla(field_ut)
    message = cdr.magnetic_field(0, "left", field_t)
    back = cdr.microtesla(doubles_of([message], cdr.MAGNETIC_DOUBLES))[0]
    assert (tuple(back.tolist()) == field_ut) == cdr.comes_back(field_ut, field_t)
    assert all(math.isclose(a, b, rel_tol=1e-15, abs_tol=1e-300) for a, b in zip(back, field_ut, strict=True))


def test_a_pose_is_laid_out_as_its_definition() -> None:
    message = cdr.pose(0, "ned", (1.0, 2.0, 3.0), (0.1, 0.2, 0.3, 0.4))
    assert struct.unpack("<7d", message[-56:]) == (1.0, 2.0, 3.0, 0.2, 0.3, 0.4, 0.1)
