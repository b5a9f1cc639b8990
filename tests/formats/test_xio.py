import numpy as np
import pytest

from app.formats.reading import read
from app.motion.basics import InputError

G = 9.80665
SIX = (
    "Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),"
    "Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)"
)
FIELD = "Magnetometer X ({0}),Magnetometer Y ({0}),Magnetometer Z ({0})"


def same_foot(recording, foot, with_field: bool = False) -> None:
    """Whether the recording is the foot of conftest: its axes are the shoe's already."""
    (samples,) = recording.sensors
    np.testing.assert_allclose(samples.matrix[:, 1:4], foot.force, rtol=1e-12)
    np.testing.assert_allclose(samples.matrix[:, 4:7], foot.rate, rtol=1e-12)
    if with_field:
        np.testing.assert_allclose(samples.matrix[:, 7:], foot.field, rtol=1e-12)
    else:
        assert np.isnan(samples.matrix[:, 7:]).all()


def test_with_times_in_seconds(foot) -> None:
    data = foot.csv("Time (s)," + SIX, [foot.t_s + 5, np.degrees(foot.rate), foot.force / G])
    recording = read("walk.csv", data)
    same_foot(recording, foot)
    assert recording.format == "x-io CSV"
    assert recording.sensors[0].device_ns == 5_000_000_000
    assert recording.sensors[0].rate_hz == pytest.approx(100)


def test_with_microseconds_and_a_magnetometer(foot) -> None:
    columns = [np.rint(foot.t_s * 1e6), np.degrees(foot.rate), foot.force / G, foot.field]
    recording = read("walk.csv", foot.csv(f"Timestamp (us),{SIX},{FIELD.format('uT')}", columns))
    same_foot(recording, foot, with_field=True)
    assert recording.duration_s == pytest.approx(3.99)


def test_a_relative_field_is_said(foot) -> None:
    columns = [foot.t_s, np.degrees(foot.rate), foot.force / G, foot.field / 50]
    recording = read("walk.csv", foot.csv(f"Time (s),{SIX},{FIELD.format('a.u.')}", columns))
    assert "the magnetic field has no unit: only its direction counts" in recording.assumed


def test_packet_numbers_are_no_times(foot) -> None:
    """Other packets use up numbers: rows are even, whatever the numbers skip."""
    packets = np.cumsum(np.random.default_rng(3).integers(1, 4, 400))
    columns = [packets, np.degrees(foot.rate), foot.force / G, foot.field / 100]
    data = foot.csv(f"Packet number,{SIX},{FIELD.format('G')}", columns)
    recording = read("walk.csv", data)
    same_foot(recording, foot, with_field=True)
    assert recording.format == "x-IMU CSV"
    assert recording.duration_s == pytest.approx(399 / 256, abs=1e-9)
    assert "256 Hz assumed: the file has packet numbers, no times" in recording.assumed


def test_a_repeated_packet_is_dropped(foot) -> None:
    packets = np.arange(400)
    packets[200] = 199
    recording = read(
        "x.csv", foot.csv(f"Packet number,{SIX}", [packets, np.degrees(foot.rate), foot.force / G])
    )
    assert recording.sensors[0].dropped == {"repeated time": 1}
    assert recording.duration_s == pytest.approx(398 / 256)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("Accelerometer Y (g)", "Accelerometer Y", "column 'Accelerometer Y' has no unit, expected m/s²"),
        ("Gyroscope X (deg/s)", "Gyroscope X (rpm)", "column 'Gyroscope X .rpm.' has the unit 'rpm'"),
        ("Gyroscope Z (deg/s)", "Gyro Z (deg/s)", "no column 'Gyroscope Z', expected it with its unit"),
        ("Time (s)", "Time", "column 'Time' has no unit of time"),
        ("Time (s)", "When (s)", "neither a time nor a packet number"),
    ],
)
def test_headers_that_do_not_say_enough(foot, old: str, new: str, words: str) -> None:
    header = ("Time (s)," + SIX).replace(old, new)
    with pytest.raises(InputError, match=f"^walk.csv: .*{words}"):
        read("walk.csv", foot.csv(header, [foot.t_s, np.degrees(foot.rate), foot.force / G]))


def test_radians_and_metres_by_the_header(foot) -> None:
    header = "Time (s)," + SIX.replace("(deg/s)", "(rad/s)").replace("(g)", "(m/s^2)")
    same_foot(read("walk.csv", foot.csv(header, [foot.t_s, foot.rate, foot.force])), foot)


def test_the_measured_short_walk(shared_data) -> None:
    path = shared_data / "xio_ngimu" / "short_walk.csv"
    recording = read(path.name, path.read_bytes())
    (samples,) = recording.sensors
    assert recording.dropped_rows == 205
    assert samples.dropped == {"repeated time": 205}
    assert len(samples) == 16539 - 205
    assert samples.rate_hz == pytest.approx(400, rel=0.01)
    assert np.diff(samples.matrix[:, 0]).min() > 0
    assert (
        "toe = x, right = −y, down = −z, assumed from gravity at rest and the swing of the foot"
        in recording.assumed
    )


@pytest.mark.parametrize(("name", "clipped"), [("straightLine", 1), ("stairsAndCorridor", 12)])
def test_the_measured_x_imu_walks(shared_data, name: str, clipped: int) -> None:
    path = shared_data / "xio_ximu" / f"{name}_CalInertialAndMag.csv"
    recording = read(path.name, path.read_bytes())
    (samples,) = recording.sensors
    assert samples.rate_hz == pytest.approx(256)
    assert recording.dropped_rows == 0
    assert np.count_nonzero(samples.saturation & 1) == clipped
    assert np.nanmedian(np.linalg.norm(samples.matrix[:, 7:], axis=1)) == pytest.approx(40, abs=15)
