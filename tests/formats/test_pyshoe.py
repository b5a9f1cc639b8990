import io
from typing import Any

import numpy as np
import pytest
import scipy.io
from hypothesis import given
from hypothesis import strategies as st

from app.formats.reading import read
from app.motion.basics import InputError


def mat(**variables: object) -> bytes:
    file: Any = io.BytesIO()  # the stubs know only paths
    scipy.io.savemat(file, variables)
    return file.getvalue()


def trial(count: int = 60) -> bytes:
    force = np.tile([-1.0, 0.5, -9.7], (count, 1))
    rate = np.tile([0.01, 0.02, 0.03], (count, 1))
    return mat(imu=np.hstack([force, rate]), ts=(1.0 + np.arange(count) / 200)[None])


def test_a_trial() -> None:
    recording = read("trial.mat", trial())
    (samples,) = recording.sensors
    assert (recording.format, samples.sensor, len(samples)) == ("PyShoe MATLAB", "foot", 60)
    assert samples.device_ns == 1_000_000_000
    assert samples.rate_hz == pytest.approx(200)
    assert samples.matrix[5, 1:7].tolist() == [-1.0, 0.5, -9.7, 0.01, 0.02, 0.03]
    assert recording.assumed[0] == "units of a PyShoe trial: m/s² and rad/s"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (mat(gt=np.zeros((3, 3))), "no numbers named 'imu'"),
        (mat(imu=np.zeros((3, 6))), "no numbers named 'ts'"),
        (mat(imu="words", ts=np.zeros(3)), "no numbers named 'imu'"),
        (mat(imu=np.zeros((3, 6)), ts=np.zeros(4)), r"imu is \(3, 6\) beside 4 times"),
        (mat(imu=np.zeros((3, 5)), ts=np.zeros(3)), r"expected \(times, 6\)"),
        (mat(imu=np.zeros((0, 6)), ts=np.zeros(0)), "imu is|no numbers"),
        (mat(imu=np.zeros((3, 6)) * 1j, ts=np.zeros(3)), "no numbers named 'imu'"),
        (b"MATLAB 7.3 MAT-file, Platform: x" + bytes(200), "save it with -v7"),
        (trial()[:300], "damaged MATLAB file"),
        (b"MATLAB 5.0", "damaged MATLAB file"),
    ],
)
def test_other_files_are_one_line(data: bytes, words: str) -> None:
    with pytest.raises(InputError, match=f"^trial.mat: .*{words}") as error:
        read("trial.mat", data)
    assert "\n" not in str(error.value)


@given(st.lists(st.tuples(st.integers(0, 600), st.integers(0, 255)), max_size=4), st.integers(0, 4000))
def test_damage_is_an_input_error_or_a_recording(changes: list[tuple[int, int]], length: int) -> None:
    data = bytearray(trial())
    for place, value in changes:
        data[place] = value
    try:
        assert len(read("trial.mat", bytes(data[:length])).sensors[0]) > 0
    except InputError as error:
        assert "\n" not in str(error)


def test_the_measured_trials(shared_data) -> None:
    paths = sorted((shared_data / "pyshoe_vicon").glob("*.mat"))
    assert len(paths) == 29
    for path in paths:
        (samples,) = read(path.name, path.read_bytes()).sensors
        assert samples.rate_hz == pytest.approx(200, rel=2e-3)
        assert not samples.dropped
        assert samples.matrix[:, 3].mean() < -5.0
