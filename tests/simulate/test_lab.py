"""The lab: errors as asked for and no others, and every lesson shows what its sentences say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.samples import Sample
from app.session import Session
from app.simulate.lab import LESSONS, LIMITS, PERFECT, Lab, LabErrors, Lesson
from app.simulate.walk import make_walk
from tests.estimator.walks import one_by_one

STILL = Sample("foot", 0, 0, 0, (0.0, 0.0, -9.80665), (0.0, 0.0, 0.0), (24.0, 0.0, 42.0))


def spoilt(errors: LabErrors, count: int = 1, sample: Sample = STILL) -> list[Sample]:
    lab = Lab()
    lab.errors = errors
    read = [lab.spoil(sample) for _ in range(count)]
    return [one for one in read if one is not None]


def test_a_perfect_sensor_changes_nothing() -> None:
    assert spoilt(PERFECT)[0] is STILL


def test_biases_are_added() -> None:
    (read,) = spoilt(LabErrors(force_bias_mps2=0.1, rate_bias_dps=1.0, field_bias_ut=5.0))
    assert read.specific_force_b == pytest.approx((0.1, 0.1, -9.70665))
    assert read.angular_rate_b == pytest.approx((math.radians(1.0),) * 3)
    assert read.field_b == pytest.approx((24.0, 5.0, 42.0))
    assert read._replace(specific_force_b=STILL.specific_force_b, angular_rate_b=STILL.angular_rate_b,
                         field_b=STILL.field_b) == STILL  # fmt: skip


def test_noise_has_the_papers_size() -> None:
    read = spoilt(LabErrors(noise=2.0), 4000)
    spread = [np.std([getattr(r, name) for r in read], axis=0)
              for name in ("specific_force_b", "angular_rate_b", "field_b")]  # fmt: skip
    assert np.array(spread) == pytest.approx(2.0 * np.outer((0.033, 0.0076, 0.082), np.ones(3)), rel=0.05)


def test_what_is_cut_off_is_flagged() -> None:
    hard = STILL._replace(specific_force_b=(50.0, -3.0, -60.0))
    (read,) = spoilt(LabErrors(range_g=2.0), sample=hard)
    assert read.specific_force_b == pytest.approx((19.6133, -3.0, -19.6133))
    assert read.saturation == 0b101


def test_as_many_are_lost() -> None:
    assert len(spoilt(LabErrors(lost_percent=30.0), 5000)) == pytest.approx(3500, abs=150)


@given(st.sampled_from(sorted(LIMITS)), st.floats())
def test_a_value_is_in_range_or_refused(name: str, value: float) -> None:
    limit = LIMITS[name]
    if limit.low <= value <= limit.high:
        assert getattr(PERFECT.with_changes({name: value}), name) == value
    else:
        with pytest.raises(ValueError, match="expected"):
            PERFECT.with_changes({name: value})


def walked(lesson: Lesson, taken_ns: int = 2_000_000_000) -> Session:
    """A straight walk; the lesson is taken after the still start."""
    made = make_walk({"distance_m": "40", "rate_hz": "100"})
    session, lab = Session(lesson.settings, truth=made.truth), Lab()
    for sample in one_by_one(made.recording.sensors[0]):
        if sample.device_ns >= taken_ns:
            lab.errors = lesson.errors
        read = lab.spoil(sample)
        if read is not None:
            session.take(read)
    return session


@pytest.fixture(scope="module")
def taken() -> dict[str, Session]:
    return {lesson.name: walked(lesson) for lesson in LESSONS}


def error_m(session: Session) -> float:
    error = session.snapshot().main.feet[0].error_m
    assert error is not None
    return error


def test_the_perfect_walk_lies_on_the_truth(taken: dict[str, Session]) -> None:
    assert error_m(taken["Perfect"]) < 0.15  # of 40 m: what sampling at 100 Hz costs


def test_a_gyro_bias_bends_the_walk_but_not_its_strides(taken: dict[str, Session]) -> None:
    foot = taken["Gyro bias"].snapshot().main.feet[0]
    assert error_m(taken["Gyro bias"]) > 1.0
    assert foot.distance_m == pytest.approx(taken["Perfect"].snapshot().main.feet[0].distance_m, rel=0.02)


@pytest.mark.parametrize("name", ["Gyro bias", "Gain to zero"])
def test_a_bias_that_was_there_in_the_still_start_is_seen_too(name: str) -> None:
    """As where a replay begins anew with the errors set: else the lesson would show nothing."""
    (lesson,) = (one for one in LESSONS if one.name == name)
    assert error_m(walked(lesson, 0)) > 1.0


def test_without_gains_the_height_runs_off(taken: dict[str, Session]) -> None:
    held, free = (abs(taken[name].snapshot().main.feet[0].height_m) for name in ("Gyro bias", "Gain to zero"))
    assert free > 3.0 * held
    assert free > 0.5


def test_without_zero_velocity_position_runs_away(taken: dict[str, Session]) -> None:
    assert error_m(taken["ZUPT off"]) > 10.0
    assert taken["ZUPT off"].snapshot().main.feet[0].strides == 0


def test_noise_hardly_matters(taken: dict[str, Session]) -> None:
    assert error_m(taken["Noise"]) < 1.0


def test_saturation_is_counted_and_costs(taken: dict[str, Session]) -> None:
    assert taken["Saturation"].snapshot().health["foot"].saturated > 10
    assert error_m(taken["Saturation"]) > 2.0 * error_m(taken["Perfect"])


def test_lost_samples_cost_little(taken: dict[str, Session]) -> None:
    snapshot = taken["Lost samples"].snapshot()
    assert snapshot.health["foot"].segments == 1
    assert error_m(taken["Lost samples"]) < 1.0


def test_iron_bends_what_the_compass_holds(taken: dict[str, Session]) -> None:
    assert error_m(taken["Magnet"]) > 5.0 * error_m(taken["Perfect"])
