import numpy as np
import pytest

from app.formats.reading import read
from app.motion.basics import InputError

G = 9.80665
DEVICE = "inertial-6253.76535:"
CHANNELS = [f"scaled{quantity}{axis}" for quantity in ("Accel", "Gyro", "Mag") for axis in "XYZ"]
HEADER = "Time," + ",".join(DEVICE + channel for channel in [*CHANNELS, "roll", "pitch", "yaw"])


def columns(foot, force_unit: float = G) -> list[np.ndarray]:
    return [foot.t_s, foot.force / force_unit, foot.rate, foot.field / 100, np.zeros((400, 3))]


def same_foot(recording, foot, rows: slice = slice(None)) -> None:
    (samples,) = recording.sensors
    np.testing.assert_allclose(samples.matrix[:, 1:4], foot.force[rows], rtol=1e-12)
    np.testing.assert_allclose(samples.matrix[:, 4:7], foot.rate[rows], rtol=1e-12)
    np.testing.assert_allclose(samples.matrix[:, 7:], foot.field[rows], rtol=1e-12)


def test_the_usual_export(foot) -> None:
    recording = read("walk.csv", foot.csv(HEADER, columns(foot)))
    same_foot(recording, foot)
    assert recording.format == "MicroStrain CSV"
    assert "units of SensorConnect: g, rad/s and gauss" in recording.assumed
    assert recording.duration_s == pytest.approx(3.99)


def test_force_in_metres_is_recognised_and_said(foot) -> None:
    recording = read("walk.csv", foot.csv(HEADER, columns(foot, 1.0)))
    same_foot(recording, foot)
    assert any("9.8 at rest cannot be g" in sentence for sentence in recording.assumed)


def test_a_unit_in_the_header_goes_first(foot) -> None:
    header = HEADER
    for axis in "XYZ":
        header = header.replace(f"Accel{axis}", f"Accel{axis} (m/s^2)")
    same_foot(read("walk.csv", foot.csv(header, columns(foot, 1.0))), foot)
    with pytest.raises(InputError, match=r"rests at 1.00 .*this looks like g"):
        read("walk.csv", foot.csv(header, columns(foot)))


def test_notes_above_the_header(foot) -> None:
    data = b"DATA_START\n\n" + foot.csv(HEADER, columns(foot))
    same_foot(read("walk.csv", data), foot)


def test_values_marked_invalid_are_dropped(foot) -> None:
    header = "Time," + ",".join(f"{DEVICE}{c},{DEVICE}{c}:valid" for c in CHANNELS)
    values = np.hstack([foot.force / G, foot.rate, foot.field / 100])
    valid = np.ones_like(values)
    valid[[50, 60], [1, 4]] = 0
    both = np.stack([values, valid], axis=2).reshape(400, -1)
    recording = read("walk.csv", foot.csv(header, [foot.t_s, both]))
    assert recording.sensors[0].dropped == {"not a finite number": 2}
    assert len(recording.sensors[0]) == 398


def clocked(foot, write) -> bytes:
    lines = foot.csv(HEADER, columns(foot)).decode().splitlines()
    rows = [f"{write(t)},{line.split(',', 1)[1]}" for t, line in zip(foot.t_s, lines[1:], strict=True)]
    return "\n".join([HEADER, *rows, ""]).encode()


def test_a_time_of_day_past_midnight(foot) -> None:
    def write(t: float) -> str:
        s = (86398 + t) % 86400
        return f"10/21/2022 {int(s // 3600):02d}:{int(s // 60) % 60:02d}:{s % 60:09.6f}"

    recording = read("walk.csv", clocked(foot, write))
    same_foot(recording, foot)
    assert recording.duration_s == pytest.approx(3.99, abs=1e-5)


def test_a_clock_cut_to_tenths_is_spread_evenly_and_said(foot) -> None:
    recording = read(
        "walk.csv", clocked(foot, lambda t: f"59:{57 + t:04.1f}" if t < 2.9 else f"00:{t - 3:04.1f}")
    )
    same_foot(recording, foot)
    assert recording.sensors[0].rate_hz == pytest.approx(100, rel=0.03)
    assert any("clock is too coarse" in sentence for sentence in recording.assumed)


def test_nanoseconds_since_1970(foot) -> None:
    recording = read("walk.csv", clocked(foot, lambda t: str(1_700_000_000_000_000_000 + round(t * 1e9))))
    same_foot(recording, foot)
    assert recording.sensors[0].device_ns == 1_700_000_000_000_000_000


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("scaledGyroY", "rawGyroY", "no scaledgyro Y"),
        ("Time", "Stamp", "no column 'Time'"),
        (f"{DEVICE}scaledMagX", "inertial-1.2:scaledMagX", "expected one device"),
    ],
)
def test_incomplete_headers(foot, old: str, new: str, words: str) -> None:
    with pytest.raises(InputError, match=f"^walk.csv: .*{words}"):
        read("walk.csv", foot.csv(HEADER.replace(old, new, 1), columns(foot)))


def test_a_time_that_is_none(foot) -> None:
    with pytest.raises(InputError, match="the time reads 'noon', expected seconds"):
        read("walk.csv", clocked(foot, lambda t: "noon"))


@pytest.mark.parametrize(
    ("name", "rows", "rate_hz"),
    [("31", 8549, 200), ("33", 11000, 200), ("34", 5200, 200), ("40", 21201, 167.2)],
)
def test_the_measured_corridors(shared_data, name: str, rows: int, rate_hz: float) -> None:
    path = shared_data / "hallway_gcp" / f"SensorConnectData_{name}.csv"
    recording = read(path.name, path.read_bytes())
    (samples,) = recording.sensors
    assert (len(samples), recording.dropped_rows) == (rows, 0)
    assert samples.rate_hz == pytest.approx(rate_hz, rel=1e-3)
    assert 35 < np.median(np.linalg.norm(samples.matrix[:, 7:], axis=1)) < 75
    assert samples.matrix[:200, 3].mean() < -6.0
