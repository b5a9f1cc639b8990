import numpy as np
import pytest

from app.formats.rest import check_units, find_rest
from app.motion.basics import Floats, InputError, Role
from app.motion.samples import Samples

G = 9.80665


def samples(force: Floats, rate: Floats) -> Samples:
    matrix = np.full((len(force), 10), np.nan)
    matrix[:, 0] = np.arange(len(force)) * 10_000_000
    matrix[:, 1:4], matrix[:, 4:7] = force, rate
    return Samples("left", Role.LEFT, 0, matrix, np.zeros(len(force), np.uint16))


def walk(rest: float, still: slice, peak_radps: float = 6.0) -> Samples:
    """A swinging foot of 5 s whose force at rest, in a still second, is ``rest``."""
    t_s = np.arange(500) / 100
    moving = np.ones(500)
    moving[still] = 0.0
    wave = moving * np.sin(2 * np.pi * 1.1 * t_s)
    noise = np.random.default_rng(2).normal(0, 1e-3, (500, 3))
    force = rest * (np.outer(wave, [1.0, 0.2, 0.5]) + [0, 0, -1.0] + noise)
    return samples(force, np.outer(wave, [0, peak_radps, 0]) + noise)


@pytest.mark.parametrize("start", [0, 130, 400])
def test_the_still_second_is_found_wherever_it_is(start: int) -> None:
    rest = find_rest(walk(9.7, slice(start, start + 100)))
    assert rest.still
    assert rest.magnitude_mps2 == pytest.approx(9.7, rel=2e-3)


def test_a_foot_that_never_rests_is_not_called_still() -> None:
    assert not find_rest(walk(9.8, slice(0, 0))).still


@pytest.mark.parametrize("rest", [8.6, 9.55, 9.81, 11.1])
def test_real_sensors_pass(rest: float) -> None:
    foot = walk(rest, slice(0, 100))
    check_units("x.csv", foot, find_rest(foot), "m/s²")


@pytest.mark.parametrize(
    ("rest", "unit", "words"),
    [
        (
            1.0,
            "m/s²",
            r"x.csv: .* of left rests at 1.00 \(0.1 g\): this looks like g, expected 9.807 m/s²",
        ),
        (1000.0, "m/s²", "rests at 1000.* this looks like mg"),
        (9.81 * G, "g", "rests at 9.8.*this looks like m/s², expected 1 g"),
        (1000 * G, "g", "this looks like mg, expected 1 g"),
        (0.1 * G, "g", "rests at 0.10 g: expected 1 g; check the sensor's scale"),
        (4.9, "m/s²", r"rests at 4.90 \(0.5 g\) m/s²: expected 9.807 m/s²"),
        (0.0, "m/s²", "rests at 0.00"),
        (12.0, "m/s²", "rests at 12.0"),
    ],
)
def test_mix_ups_are_recognised(rest: float, unit: str, words: str) -> None:
    foot = walk(rest, slice(0, 100))
    with pytest.raises(InputError, match=words):
        check_units("x.csv", foot, find_rest(foot), unit)


def test_degrees_in_a_column_of_radians_are_recognised() -> None:
    foot = walk(9.8, slice(0, 100), peak_radps=400.0)
    with pytest.raises(InputError, match="reads .* rad/s: this looks like deg/s"):
        check_units("x.csv", foot, find_rest(foot), "m/s²")


def test_a_fast_swing_and_a_lone_spike_are_not_taken_for_degrees() -> None:
    foot = walk(9.8, slice(0, 100), peak_radps=35.0)
    foot.matrix[250, 5] = 500.0
    check_units("x.csv", foot, find_rest(foot), "m/s²")
