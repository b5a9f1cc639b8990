import numpy as np
import pytest

from app.formats.reading import read
from app.motion.basics import InputError

AXES = ["acc_x", "acc_y", "acc_z", "gyr_x", "gyr_y", "gyr_z"]
UP = np.array([1.0, -1.0, -1.0])  # gaitmap's sensors are z-up


def six(foot) -> np.ndarray:
    return np.hstack([foot.force * UP, np.degrees(foot.rate) * UP])


def same(samples, foot) -> None:
    np.testing.assert_allclose(samples.matrix[:, 1:4], foot.force, rtol=1e-12)
    np.testing.assert_allclose(samples.matrix[:, 4:7], foot.rate, rtol=1e-12)


def test_one_header_row_and_a_sample_counter(foot) -> None:
    index = np.arange(400) + 23000
    data = foot.csv(",index," + ",".join(AXES), [np.arange(400), index, six(foot)])
    recording = read("walk.csv", data)
    same(recording.sensors[0], foot)
    assert (recording.sensors[0].sensor, recording.format) == ("foot", "gaitmap CSV")
    assert recording.sensors[0].rate_hz == pytest.approx(204.8)
    assert "204.8 Hz assumed: the file has row numbers, no times" in recording.assumed


def test_a_jump_of_the_counter_is_a_gap(foot) -> None:
    index = np.arange(400) + np.where(np.arange(400) < 200, 0, 2048)
    recording = read("walk.csv", foot.csv(",index," + ",".join(AXES), [np.arange(400), index, six(foot)]))
    steps = np.diff(recording.sensors[0].matrix[:, 0])
    assert steps[199] == pytest.approx(2049 / 204.8 * 1e9, abs=1)
    assert np.delete(steps, 199) == pytest.approx(1e9 / 204.8, abs=1)


def two_feet(foot, first: str, second: str, clock: np.ndarray) -> bytes:
    """Columns of both feet side by side, axis by axis, as gaitmap's sample has them."""
    sensors = [side + "_sensor" for _ in AXES for side in ("left", "right")]
    axes = [axis for axis in AXES for _ in range(2)]
    values = np.repeat(six(foot), 2, axis=1)
    lines = foot.csv(",".join([second, *axes]), [clock, values])
    return ",".join([first, *sensors]).encode() + b"\n" + lines


@pytest.mark.parametrize(("first", "second"), [("sensor", "axis"), ("", "")])
def test_two_header_rows_and_row_numbers(foot, first: str, second: str) -> None:
    recording = read("walk.csv", two_feet(foot, first, second, np.arange(400)))
    assert [samples.sensor for samples in recording.sensors] == ["left", "right"]
    for samples in recording.sensors:
        same(samples, foot)
        assert samples.rate_hz == pytest.approx(204.8)


def test_two_header_rows_and_times(foot) -> None:
    recording = read("walk.csv", two_feet(foot, "", "", foot.t_s))
    assert recording.sensors[1].rate_hz == pytest.approx(100)
    assert not any("assumed: the file has row numbers" in sentence for sentence in recording.assumed)


def test_a_row_that_both_feet_lose_is_one_row(foot) -> None:
    lines = two_feet(foot, "", "", foot.t_s).splitlines()
    lines.insert(100, lines[99])
    recording = read("walk.csv", b"\n".join([*lines, b"4.0,1.0,"]))
    assert recording.dropped_rows == 2
    assert [dict(s.dropped) for s in recording.sensors] == [
        {"repeated time": 1, "truncated row": 1},
        {"repeated time": 1},
    ]


def test_a_missing_axis_is_named(foot) -> None:
    with pytest.raises(InputError, match="foot has no column 'gyr_z'"):
        read("walk.csv", foot.csv("," + ",".join(AXES[:5]), [np.arange(400), six(foot)[:, :5]]))


def test_without_row_numbers_or_times(foot) -> None:
    with pytest.raises(InputError, match="first column is 'acc_x', expected a row number or a time"):
        read("walk.csv", foot.csv(",".join(AXES), [six(foot)]))


@pytest.mark.parametrize(
    ("name", "rows", "feet"),
    [
        ("imu_sample", 7928, ["left", "right"]),
        ("imu_sample_healthy_stair_up", 5130, ["left", "right"]),
        ("imu_sample_ms_left", 7000, ["foot"]),
    ],
)
def test_the_measured_feet(shared_data, name: str, rows: int, feet: list[str]) -> None:
    path = shared_data / "gaitmap_feet" / f"{name}.csv"
    recording = read(path.name, path.read_bytes())
    assert [samples.sensor for samples in recording.sensors] == feet
    for samples in recording.sensors:
        assert len(samples) == rows
        assert samples.rate_hz == pytest.approx(204.8, rel=1e-4)
    assert not any("never rests" in sentence for sentence in recording.assumed)
