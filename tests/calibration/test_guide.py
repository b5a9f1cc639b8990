"""A calibration finds the errors that a simulated sensor was given: the figures of the project's aims."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from app.calibration.guide import Guide, coverage, held
from app.calibration.steps import FIELD_STEPS, STEPS
from app.calibration.still import Pose, Stillness
from app.calibration.words import Calibration, Correction
from app.motion.samples import Sample
from app.simulate.calibration import Calibrating, Errors, make_calibration
from app.sources.timeline import Timeline

SEEDS = range(8)
G = 9.80665
#: 0.5 mg, 0.05 °/s, 0.5 % of a field of 48.6 µT.
NULLS = {"force": 0.5e-3 * G, "rate": np.radians(0.05), "field": 0.005 * 48.6}
SCALE = 0.002


@cache
def made(seed: int, **options: str) -> tuple[Calibrating, list[Sample]]:
    simulated = make_calibration({"seed": str(seed), "first": "6", **options})
    timeline = Timeline(simulated.recording)
    return simulated, timeline.cut(0, len(timeline), 0)


def led(samples: list[Sample]) -> Guide:
    guide = Guide("a sensor")
    for sample in samples:
        guide.add(sample)
    return guide


def check(found: Calibration, true: Calibrating, scale: float = SCALE, nulls: float = 1.0) -> None:
    for kind, null in NULLS.items():
        got: Correction = getattr(found, kind)
        expected: Errors = getattr(true, kind)
        np.testing.assert_allclose(got.null, expected.null, rtol=0.0, atol=nulls * null)
        np.testing.assert_allclose(np.diag(got.scale), np.diag(expected.scale), rtol=scale)


@pytest.mark.parametrize("seed", SEEDS)
def test_nulls_and_scales_are_recovered(seed: int) -> None:
    true, samples = made(seed)
    guide = led(samples)
    assert guide.done
    fit, _ = guide.results("now", field_ut=48.6)
    check(fit, true)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_reports_formulas_recover_them_without_noise_and_with_exact_turns(seed: int) -> None:
    true, samples = made(seed, noise="0")
    _, report = led(samples).results("now", field_ut=48.6)
    check(report, true)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_fits_bear_turns_that_are_made_badly_where_the_formulas_do_not(seed: int) -> None:
    true, samples = made(seed, sloppy_deg="2")
    guide = led(samples)
    assert guide.done
    fit, report = guide.results("now", field_ut=48.6)
    check(fit, true)
    wrong = [np.abs(np.diag(c.rate.scale) - np.diag(true.rate.scale)).max() for c in (fit, report)]
    assert wrong[0] < wrong[1]


def still(noise_mps2: float, seconds: float, rate_hz: float = 100.0) -> Pose:
    """What is known of a sensor that lies still for so long."""
    random, stillness, pose = np.random.default_rng(1), Stillness(), None
    for i in range(round(seconds * rate_hz)):
        x, y, z = random.normal(0.0, noise_mps2, 3)
        sample = Sample("a", i, round(i * 1e9 / rate_hz) + 1, 0, (x, y, z - G), (0.0, 0.0, 0.0))
        pose = stillness.add(sample)
    assert pose is not None
    return pose


def test_a_pose_is_held_until_its_mean_is_known() -> None:
    pose = still(0.033, 3.3)
    assert pose.doubt_mps2 == pytest.approx(0.033 / np.sqrt(pose.samples), rel=0.15)
    assert held(still(0.0, 1.7)) < 1.0 <= held(still(0.0, 1.9))  # 0.3 s go by first
    assert held(still(0.033, 1.9)) < 1.0 <= held(still(0.033, 3.7))
    assert held(still(0.08, 3.5)) < 1.0 <= held(still(0.08, 3.9))  # nobody holds still for ever
    assert held(still(0.033, 1.9, 400.0)) == 1.0


@pytest.mark.parametrize("rate", ["50", "400"])
def test_any_rate_will_do(rate: str) -> None:
    true, samples = made(5, rate=rate)
    fit, _ = led(samples).results("now", field_ut=48.6)
    check(fit, true, scale=2 * SCALE if rate == "50" else SCALE)


def test_corrected_samples_are_the_truth() -> None:
    """A calibration of what was corrected finds nothing more to correct; its poses end a little apart."""
    _, samples = made(3)
    fit, _ = led(samples).results("now", field_ut=48.6)
    again, _ = led([fit.apply(sample) for sample in samples]).results("later", field_ut=48.6)
    for kind, null in NULLS.items():
        np.testing.assert_allclose(getattr(again, kind).null, 0.0, atol=0.2 * null)
        np.testing.assert_allclose(np.diag(getattr(again, kind).scale), 1.0, atol=0.2 * SCALE)


def test_without_a_magnetometer_it_is_shorter() -> None:
    true, samples = made(0, magnetometer="off")
    guide = led(samples)
    assert guide.done
    assert guide.view().steps == len(STEPS)
    fit, report = guide.results("now")
    assert fit.field is report.field is None
    np.testing.assert_allclose(fit.force.null, true.force.null, atol=NULLS["force"])


def test_the_report_takes_about_a_minute() -> None:
    _, samples = made(0)
    assert (samples[-1].device_ns - samples[0].device_ns) * 1e-9 < 75.0


# --- the guide -----------------------------------------------------------------------------------


def test_it_goes_step_by_step_and_shows_how_far() -> None:
    _, samples = made(0)
    guide, steps, held = Guide("s"), [], []
    for sample in samples:
        guide.add(sample)
        view = guide.view() if sample.seq % 10 == 0 else None
        if view is not None:
            steps.append(view.step)
            held.append(view.held)
    assert steps == sorted(steps)
    assert set(steps) == set(range(len(STEPS + FIELD_STEPS) + 1))
    assert any(0.2 < part < 0.8 for part in held)
    assert guide.view().words == "Done."
    assert guide.view().coverage > 0.5


def test_a_wrong_pose_is_named() -> None:
    _, samples = made(0)
    guide = Guide("s")
    flat = samples[100]
    on_its_back = flat._replace(specific_force_b=(0.0, 0.0, G))
    for i in range(300):
        guide.add(on_its_back._replace(device_ns=i * 10_000_000))
    assert guide.view().step == 0
    assert guide.view().note == "Now z is up; z is down is wanted."


def test_what_lies_askew_is_no_pose() -> None:
    guide = Guide("s")
    for i in range(300):
        guide.add(Sample("s", i, i * 10_000_000, 0, (0.0, 6.5, -7.3), (0.0, 0.0, 0.0)))
    assert guide.view().step == 0
    assert "askew" in guide.view().note


def test_a_hand_that_trembles_is_not_still() -> None:
    guide = Guide("s")
    for i in range(600):
        shake = 0.2 * (-1) ** (i // 3)
        guide.add(Sample("s", i, i * 10_000_000, 0, (0.0, 0.0, -G), (shake, 0.0, 0.0)))
    assert guide.view().step == 0
    assert guide.view().held == 0.0


def test_samples_lost_in_a_turn_cost_that_turn_only() -> None:
    true, samples = made(2)
    early = next(s.seq for s in samples if abs(s.angular_rate_b[0]) > 1.0)
    guide = led([s for s in samples if not early <= s.seq < early + 30])
    assert guide.done
    assert guide.legs[1].way.broken
    fit, report = guide.results("now", field_ut=48.6)
    check(fit, true, scale=2 * SCALE)
    assert np.abs(np.diag(report.rate.scale) - np.diag(true.rate.scale)).max() < 0.01


def test_a_step_can_be_made_again() -> None:
    _, samples = made(0)
    guide = led(samples[:600])
    before = guide.view().step
    assert before >= 1
    guide.back()
    assert guide.view().step == before - 1
    Guide("s").back()


def test_the_field_without_its_strength_keeps_its_mean() -> None:
    true, samples = made(4)
    fit, _ = led(samples).results("now")
    assert fit.field is not None
    ratio = np.diag(fit.field.scale) / np.diag(true.field.scale)
    np.testing.assert_allclose(ratio / ratio.mean(), 1.0, atol=SCALE)
    assert ratio.mean() == pytest.approx(1.0, abs=0.05)


def test_a_sensor_that_never_turned_gives_no_calibration() -> None:
    _, samples = made(0)
    guide = led(samples)
    guide.legs[:] = [leg._replace(pose=guide.legs[0].pose) for leg in guide.legs]
    with pytest.raises(ValueError, match="readings"):
        guide.results("now")


def test_coverage_counts_directions() -> None:
    rng = np.random.default_rng(0)
    around = rng.normal(size=(4000, 3))
    around /= np.linalg.norm(around, axis=1)[:, np.newaxis]
    assert coverage(around * 40.0 + [5.0, -3.0, 8.0]) == 1.0
    circle = np.column_stack([np.cos(t := np.linspace(0, 6.28, 300)), np.sin(t), 0.0 * t])
    assert coverage(circle) < 0.3


def test_a_correction_undoes_what_the_error_does() -> None:
    true, _ = made(1, skew="0.02")
    values = np.random.default_rng(1).normal(size=(20, 3))
    correction = Correction(tuple(true.force.null), tuple(map(tuple, true.force.scale)))  # type: ignore[arg-type]
    np.testing.assert_allclose(correction.table(true.force.read(values)), values, atol=1e-12)
    one = correction.apply(tuple(true.force.read(values)[0]))
    np.testing.assert_allclose(one, values[0], atol=1e-12)
    assert replace(Calibration("s", "now", "fit"), force=correction).force is correction
