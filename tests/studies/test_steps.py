"""One step: each acceleration covers one metre and comes to rest; each rule is exact where it must be."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad, simpson

from app.studies import steps
from app.studies.steps import METHODS, Profile


@pytest.mark.parametrize(("profile", "covers"), [
    (steps.linear, 1.0), (steps.sinusoid, 1.0), (steps.bezier, 1.0), (steps.gaussian, 0.99887),
])  # fmt: skip
def test_the_models_cover_their_step_and_stop(profile: Profile, covers: float) -> None:
    end = steps.SWING_S
    speed, _ = quad(lambda t: profile(np.array([t]))[0], 0.0, end)
    way, _ = quad(lambda t: (end - t) * profile(np.array([t]))[0], 0.0, end)
    assert speed == pytest.approx(0.0, abs=1e-9)
    assert way == pytest.approx(covers, abs=1e-5)


@pytest.mark.parametrize("grid", [steps.stretched_grid, steps.even_grid])
@pytest.mark.parametrize("rate_hz", [20, 50, 1000])
def test_grids_begin_and_end_at_rest(grid: steps.Profile, rate_hz: float) -> None:
    t, a = grid(rate_hz, steps.linear)  # type: ignore[call-arg, arg-type]
    assert (t[0], t[-1]) == (0.0, pytest.approx(steps.END_S))
    assert np.diff(t).min() > 0.0
    assert a[0] == a[-1] == 0.0


def uneven(count: int) -> np.ndarray:
    return np.sort(np.random.default_rng(1).uniform(0.0, 2.0, count))


@pytest.mark.parametrize(("name", "degree"), [("Euler", 0), ("trapezoid", 1), ("Simpson 1/3", 2)])
def test_a_rule_is_exact_for_its_polynomial(name: str, degree: int) -> None:
    t = uneven(31)
    stamps, integral = METHODS[name](t, t**degree)
    expected = (stamps ** (degree + 1) - t[0] ** (degree + 1)) / (degree + 1)
    np.testing.assert_allclose(integral, expected, atol=1e-12)


@pytest.mark.parametrize("count", [30, 31])
def test_the_modified_rule_is_simpsons_at_every_second_stamp(count: int) -> None:
    t = uneven(count)
    _, plain = METHODS["Simpson 1/3"](t, np.sin(t))
    stamps, modified = METHODS["modified Simpson"](t, np.sin(t))
    np.testing.assert_array_equal(modified[::2][: len(plain)], plain)
    np.testing.assert_allclose(modified[1] - modified[0], 0.5 * (t[1] - t[0]) * (np.sin(t[0]) + np.sin(t[1])))
    assert len(stamps) == len(modified) == count


def test_simpson_agrees_with_scipy() -> None:
    t = uneven(31)
    assert METHODS["Simpson 1/3"](t, np.exp(t))[1][-1] == pytest.approx(simpson(np.exp(t), x=t))
