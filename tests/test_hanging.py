"""A pendulum's figures: the period of a small swing is the law's, angles are those of the swing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.hanging import period
from app.motion.snapshot import PendulumView
from app.session import Session
from app.settings import Settings
from app.simulate.hanging import HELD_S, make_pendulum
from app.simulate.pendulum import Pendulum, swing
from tests.estimator.walks import one_by_one


@given(st.floats(0.3, 4.0), st.floats(0.0, 6.0), st.floats(-1.0, 1.0))
def test_the_period_of_a_sine_wherever_it_begins(seconds: float, phase: float, offset: float) -> None:
    t_s = np.arange(250) / 25.0
    angle = 0.3 * np.sin(math.tau * t_s / seconds + phase) + offset
    assert period(t_s, angle) == pytest.approx(seconds, rel=0.03)


def test_what_hangs_still_or_has_swung_once_has_no_period() -> None:
    t_s = np.arange(250) / 25.0
    assert period(t_s, np.full(250, 0.5)) is None
    assert period(t_s, np.cos(math.tau * t_s / 9.0)) is None
    assert period(t_s[:1], t_s[:1]) is None


def shown(seconds: float, settings: Settings = Settings(), **options: str) -> PendulumView:  # noqa: B008
    """The pendulum after so many seconds."""
    made = make_pendulum({"damping": "0", **options})
    session = Session(settings, truth=made.truth, rod_m=made.recording.rod_m)
    for sample in one_by_one(made.recording.sensors[0]):
        if sample.device_ns * 1e-9 <= seconds:
            session.take(sample)
            if sample.seq % 20 == 0:
                session.snapshot()
    view = session.snapshot().pendulum
    assert view is not None
    return view


@pytest.mark.parametrize("rod_m", [0.5, 2.0])
def test_a_small_swing_takes_two_pi_root_l_over_g(rod_m: float) -> None:
    view = shown(12.0, start_deg="4", length_m=f"{rod_m}")
    law = math.tau * math.sqrt(rod_m / 9.81)
    assert view.rod_m == rod_m
    assert view.true_period_s == pytest.approx(law, rel=2e-3)
    assert view.period_s == pytest.approx(law, rel=2e-2)


def test_the_true_angle_is_that_of_the_newest_sample() -> None:
    """Not of the last look at the truth, a fifth of a second ago: there the rods would lie apart."""
    gyro_alone = Settings(estimator="papers", gain_stance=0.0, gain_swing=0.0)
    view = shown(7.315, gyro_alone, start_deg="25")
    exact = swing(Pendulum(damping=0.0, start_deg=25.0), 10.0)
    assert view.true_rad == pytest.approx(exact(np.array([7.31 - HELD_S])).angle[0], abs=1e-9)
    assert view.angle_rad == pytest.approx(view.true_rad, abs=5e-3)
    assert view.worst_rad < 5e-3


def test_a_walk_is_none() -> None:
    assert Session(Settings()).snapshot().pendulum is None
