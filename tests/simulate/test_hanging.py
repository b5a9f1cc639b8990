"""The pendulum as a source: held, then let go; readings, attitude and place are one motion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.estimator.tracker import track
from app.motion.basics import Floats, InputError
from app.motion.estimate import ATTITUDE
from app.motion.samples import Column
from app.rotation import pitch_of
from app.settings import Settings
from app.simulate.hanging import HELD_S, SENSOR, make_pendulum


def seconds(count: int, rate_hz: float = 100.0) -> Floats:
    return np.arange(count) / rate_hz


def test_it_is_held_and_then_swings_to_the_other_side() -> None:
    made = make_pendulum({"start_deg": "20", "damping": "0"})
    _, q_nb = made.truth(SENSOR, seconds(401))
    angle = np.degrees([pitch_of(tuple(q)) for q in q_nb])
    assert angle[: int(HELD_S * 100)] == pytest.approx(20.0)
    assert angle.min() == pytest.approx(-20.0, abs=0.01)
    half = HELD_S + np.pi * np.sqrt(1.0 / 9.81) * (1 + np.radians(20) ** 2 / 16)  # half a period, to θ²
    assert seconds(401)[angle.argmin()] == pytest.approx(half, abs=0.011)


def test_what_the_sensor_reads_is_the_motion_of_the_truth() -> None:
    """Specific force is Rᵀ(a − g), by the truth's own positions; the rate is the attitude's."""
    made = make_pendulum({"start_deg": "50", "length_m": "2", "rate_hz": "1000", "duration_s": "6"})
    matrix = made.recording.sensors[0].matrix
    t_s = matrix[:, 0] * 1e-9
    position_n, q_nb = made.truth(SENSOR, t_s)
    free = slice(int((HELD_S + 0.2) * 1000), -2)
    acceleration_n = np.gradient(np.gradient(position_n, t_s, axis=0), t_s, axis=0)
    turn = Rotation.from_quat(np.roll(q_nb, -1, axis=1))
    force_b = turn.inv().apply(acceleration_n - [0.0, 0.0, 9.81])
    assert matrix[free, Column.FX : Column.FX + 3] == pytest.approx(force_b[free], abs=1e-3)
    rate = np.gradient(2 * np.arctan2(q_nb[:, 2], q_nb[:, 0]), t_s)
    assert matrix[free, Column.FX + 4] == pytest.approx(rate[free], abs=1e-4)


def test_the_gyro_alone_follows_it_and_a_gain_is_misled() -> None:
    """What the lesson says: gain 0 is exact with a perfect gyro; a gain takes the swing for gravity."""
    made = make_pendulum({"start_deg": "30", "duration_s": "20"})
    samples = made.recording.sensors[0]
    _, q_nb = made.truth(SENSOR, samples.matrix[:, 0] * 1e-9)
    true_deg = np.degrees([pitch_of(tuple(q)) for q in q_nb])

    def worst_deg(gain: float) -> float:
        settings = Settings(gain_stance=gain, gain_swing=gain)
        rows = track(samples, settings).rows
        found = [pitch_of(tuple(q)) for q in rows.table(0, rows.end)[:, ATTITUDE].tolist()]
        return float(np.abs(np.degrees(found) - true_deg)[100:].max())

    assert worst_deg(0.0) < 0.1
    assert worst_deg(3.0) > 5.0


@pytest.mark.parametrize(
    "options", [{"start_deg": "95"}, {"rate_hz": "x"}, {"length_m": "nan"}, {"colour": "red"}], ids=str
)
def test_bad_options_are_one_line(options: dict[str, str]) -> None:
    with pytest.raises(InputError, match="expected") as caught:
        make_pendulum(options)
    assert "\n" not in str(caught.value)
