"""The papers' machines, one by one, against Table 14, eq. 5.1 and their own open points."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.gestures.papers import FootMachines, PapersDecoder, PapersSettings, overall
from app.gestures.words import FEET, FootReading
from app.motion.basics import MotionId, Role
from app.rotation import from_yaw
from tests.gestures.feet import LEVEL

RATES_HZ = (30.0, 100.0, 400.0)


def fed(
    rate_hz: float, seconds: float, rate_radps: object, yaw_rad: object = lambda t: 0.0
) -> list[FootMachines]:
    """One foot's machines after each sample, copied; rate and yaw are functions of the time."""
    machines, seen = FootMachines(PapersSettings()), []
    for i in range(round(seconds * rate_hz)):
        t = i / rate_hz
        machines.take(round(t * 1e9), rate_radps(t), from_yaw(yaw_rad(t)))  # type: ignore[operator]
        seen.append(FootMachines(**vars(machines)))
    return seen


@pytest.mark.parametrize("rate_hz", RATES_HZ)
def test_swing_takes_two_samples_of_30_hz_and_motion_comes_with_it(rate_hz: float) -> None:
    seen = fed(rate_hz, 2.0, lambda t: 3.0 if t >= 1.0 else 0.0)
    first = next(i for i, m in enumerate(seen) if m.swing) / rate_hz
    assert 1.0 + 1 / 30 - 1e-9 <= first <= 1.0 + 2 / 30 + 1 / rate_hz
    assert [m.motion for m in seen] == [m.swing for m in seen]


@pytest.mark.parametrize("rate_hz", RATES_HZ)
def test_motion_outlives_the_swing_by_the_hold(rate_hz: float) -> None:
    seen = fed(rate_hz, 3.0, lambda t: 3.0 if 0.5 <= t < 1.0 else 0.0)
    stance = next(i for i, m in enumerate(seen) if m.motion and not m.swing) / rate_hz
    ends = next(i for i, m in enumerate(seen) if i > rate_hz and not m.motion) / rate_hz
    assert ends - stance == pytest.approx(0.7, abs=2.0 / rate_hz)


def test_a_spike_shorter_than_the_duration_is_no_swing() -> None:
    assert not any(m.swing for m in fed(100.0, 1.0, lambda t: 9.0 if 0.5 <= t < 0.55 else 0.0))


def test_at_30_hz_the_filter_is_equation_5_1_to_the_letter() -> None:
    yaw = np.cumsum(np.random.default_rng(1).normal(0.0, 0.1, 90))
    machines, y, last = FootMachines(PapersSettings()), 0.0, yaw[0]
    for i, x in enumerate(yaw.tolist()):
        machines.take(round(i * 1e9 / 30), 0.0, from_yaw(x))
        y = 0.9 * (y + x - last) if i else 0.0
        last = x
        assert machines.filtered_rad == pytest.approx(y, abs=1e-6)


@pytest.mark.parametrize("rate_hz", RATES_HZ)
@pytest.mark.parametrize("frequency_hz", [0.1, 0.53, 3.0])
def test_the_corner_stays_at_half_a_hertz_at_any_rate(rate_hz: float, frequency_hz: float) -> None:
    seen = fed(rate_hz, 30.0, lambda t: 0.0, lambda t: math.sin(math.tau * frequency_hz * t))
    late = [abs(m.filtered_rad) for m in seen[len(seen) // 2 :]]
    ideal = 1.0 / math.hypot(1.0, 1.0 / (math.tau * frequency_hz * 0.3))
    assert max(late) == pytest.approx(ideal, rel=0.12)


@given(st.floats(-math.pi, math.pi))
def test_yaw_is_unwrapped_so_the_offset_does_not_matter(offset: float) -> None:
    turned = [m.filtered_rad for m in fed(30.0, 2.0, lambda t: 3.0, lambda t: offset + 0.4 * math.sin(9 * t))]
    straight = [m.filtered_rad for m in fed(30.0, 2.0, lambda t: 3.0, lambda t: 0.4 * math.sin(9 * t))]
    np.testing.assert_allclose(turned, straight, atol=1e-9)


def test_yaw_needs_motion_and_is_held_between_twists() -> None:
    def twist(t: float) -> float:
        return 0.5 * max(0.0, math.sin(math.tau * t))

    assert not any(m.yaw for m in fed(30.0, 3.0, lambda t: 0.0, twist))
    moving = fed(30.0, 3.0, lambda t: 3.0 if t % 1.0 < 0.5 else 0.0, twist)
    first = next(i for i, m in enumerate(moving) if m.yaw)
    assert all(m.yaw for m in moving[first:])


@pytest.mark.parametrize(
    ("left", "right", "motion"),
    [
        ("", "", MotionId.NONE),
        ("m", "m", MotionId.FORWARD),
        ("m", "my", MotionId.FORWARD_RIGHT),
        ("my", "m", MotionId.FORWARD_LEFT),
        ("", "m", MotionId.SIDE_RIGHT),
        ("m", "", MotionId.SIDE_LEFT),
        ("", "my", MotionId.TURN_CW),
        ("my", "", MotionId.TURN_CCW),
        ("my", "my", MotionId.NONE),  # open in the text: no row of Table 14
    ],
)
def test_the_overall_machine_is_table_14(left: str, right: str, motion: MotionId) -> None:
    feet = [FootMachines(PapersSettings(), motion="m" in has, yaw="y" in has) for has in (left, right)]
    assert overall(*feet) == motion


def feed(decoder: PapersDecoder, t_s: float, moves: dict[Role, bool]) -> None:
    for foot in FEET:
        rate = 3.0 if moves[foot] else 0.0
        decoder.take(FootReading(foot, round(t_s * 1e9), LEVEL, (0.0, rate, 0.0)))


@pytest.mark.parametrize("leads", FEET)
def test_the_foot_that_leads_is_a_side_step_until_the_other_moves(leads: Role) -> None:
    decoder, seen = PapersDecoder(), []
    for i in range(120):
        t = i / 60
        feed(decoder, t, {foot: t > (0.5 if foot is leads else 1.0) for foot in FEET})
        seen.append(decoder.motion)
    order = [motion for motion, _ in itertools.groupby(seen)]
    side = MotionId.SIDE_LEFT if leads is Role.LEFT else MotionId.SIDE_RIGHT
    assert order == [MotionId.NONE, side, MotionId.FORWARD]


def test_a_silent_sensor_and_rubbish_end_a_foots_motion() -> None:
    decoder = PapersDecoder()
    for i in range(60):
        feed(decoder, i / 60, dict.fromkeys(FEET, True))
    assert decoder.motion == MotionId.FORWARD
    stopped = decoder.watch(2_000_000_000)
    assert stopped is not None
    assert stopped.motion == MotionId.NONE
    for i in range(180, 240):
        feed(decoder, i / 60, dict.fromkeys(FEET, True))
    left_gone = decoder.take(FootReading(Role.LEFT, 4_000_000_000, LEVEL, (math.nan, 0.0, 0.0)))
    assert left_gone is not None
    assert left_gone.motion == MotionId.SIDE_RIGHT
