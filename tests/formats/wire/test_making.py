from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.formats.mounting import AS_GIVEN, Axes, rotation
from app.formats.saturation import Range
from app.formats.wire.making import ENU, NWU, Z_UP, Maker, Taker, device_from_body, quantised
from tests.formats.wire.protocols import AXES

REST = (0.0, 0.0, 9.80665)
STILL = (0.0, 0.0, 0.0)


@pytest.mark.parametrize("axes", AXES, ids=str)
def test_turning_is_the_mountings_matrix_and_taking_is_its_inverse(axes: Axes) -> None:
    force, rate, field = (1.0, -2.0, 3.0), (4.0, 5.0, -6.0), (-7.0, 8.0, 9.0)
    sample = Maker("foot", axes, Range()).make(1, 2, force, rate, field)
    assert sample is not None
    assert sample.field_b is not None
    for given, got in (
        (force, sample.specific_force_b),
        (rate, sample.angular_rate_b),
        (field, sample.field_b),
    ):
        np.testing.assert_array_equal(got, rotation(axes) @ given)
    taker = Taker(axes, Range())
    assert (taker.force(sample), taker.rate(sample), taker.field(sample)) == (force, rate, field)


@pytest.mark.parametrize("axes", AXES, ids=str)
def test_the_devices_quaternion_takes_shoe_vectors_to_the_devices_axes(axes: Axes) -> None:
    w, x, y, z = device_from_body(axes)
    np.testing.assert_allclose(Rotation.from_quat([x, y, z, w]).as_matrix(), rotation(axes).T, atol=1e-12)


def test_a_level_board_with_z_up_stands_level_in_north_east_down() -> None:
    for earth, heading in ((NWU, 0.0), (ENU, 90.0)):
        sample = Maker("foot", Z_UP, Range(), earth).make(0, 0, REST, STILL, None, 0, (1.0, 0.0, 0.0, 0.0))
        assert sample is not None
        assert sample.device_q_nb is not None
        w, x, y, z = sample.device_q_nb
        turned = Rotation.from_quat([x, y, z, w])
        np.testing.assert_allclose(turned.apply([0, 0, 1]), [0, 0, 1], atol=1e-12)  # down stays down
        ahead = turned.apply([1, 0, 0])
        assert math.degrees(math.atan2(ahead[1], ahead[0])) == pytest.approx(heading)


@pytest.mark.parametrize("axes", AXES[::5], ids=str)
def test_saturation_follows_the_axes(axes: Axes) -> None:
    maker = Maker("foot", axes, Range(50.0, 5.0, 100.0))
    for channel in range(9):
        values = [0.0] * 9
        values[channel] = -(50.0, 5.0, 100.0)[channel // 3] * 0.985
        a, b, c, d, e, f, g, h, i = values
        by_value = maker.make(0, 0, (a, b, c), (d, e, f), (g, h, i))
        by_device = maker.make(0, 0, STILL, STILL, None, 1 << channel)
        assert by_value is not None
        assert by_device is not None
        assert by_value.saturation == by_device.saturation
        assert by_value.saturation.bit_count() == 1
        reading = (*by_value.specific_force_b, *by_value.angular_rate_b, *(by_value.field_b or ()))
        assert by_value.saturation == 1 << int(np.flatnonzero(reading)[0])
        assert Taker(axes, Range()).saturation(by_value) == 1 << channel


def test_what_is_not_finite_is_no_sample_and_leaves_no_number() -> None:
    maker = Maker("foot", AS_GIVEN, Range())
    assert maker.make(0, 0, (math.nan, 0.0, 0.0), STILL) is None
    assert maker.make(0, 0, REST, (math.inf, -math.inf, 0.0)) is None
    assert maker.make(0, 0, (0.0, -123456.0, 0.0), STILL) is None  # a lost decimal point
    assert maker.make(0, 0, REST, (0.0, 0.0, 500.0)) is None
    sample = maker.make(0, 0, REST, STILL, (math.nan, 0.0, 0.0), 0, (0.1, 0.1, 0.0, math.nan))
    assert sample is not None
    assert (sample.seq, sample.field_b, sample.device_q_nb) == (0, None, None)


def test_sensors_clip_before_the_wire() -> None:
    sample = Maker("foot", Z_UP, Range()).make(0, 0, (99.0, -99.0, 1.0), STILL)
    assert sample is not None
    assert Taker(Z_UP, Range(force=50.0)).force(sample) == (50.0, -50.0, 1.0)


@pytest.mark.parametrize(("value", "code"), [(0.26, 3), (-0.26, -3), (1e9, 32767), (-1e9, -32768)])
def test_codes_are_the_nearest_that_fit(value: float, code: int) -> None:
    assert quantised(value, 0.1) == code
