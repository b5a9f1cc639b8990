import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.mounting import parse_axes
from app.formats.options import Options
from app.formats.plain import HEADER
from app.formats.reading import read
from app.motion.basics import InputError, Role
from app.motion.recording import Recording

G = 9.80665
XIO = "Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s)," + ",".join(
    f"Accelerometer {axis} (g)" for axis in "XYZ"
)


def still(
    count: int = 200, f: tuple[float, ...] = (0, 0, -9.8), foot: str = "foot", start_s: float = 0
) -> str:
    """Rows of plain CSV: a foot that stands."""
    row = f"{foot}," + ",".join(map(repr, (*map(float, f), 0.01, 0.0, 0.0))) + ",0.2,0.0,0.4"
    return "".join(f"{start_s + i / 100:.3f},{row}\n" for i in range(count))


def plain(rows: str) -> bytes:
    return f"{HEADER}\n{rows}".encode()


# --- bad input: one clear line, or the rest of the walk kept and the loss counted -----------------


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "an empty file, expected plain CSV"),
        (b" \n\r\n", "an empty file"),
        (b"Dear Sir,\nplease find enclosed\n", "begins with 'Dear Sir,', expected plain CSV"),
        (b"# only\n# comments\n", "expected plain CSV"),
        (bytes(range(256)) * 10, "binary data"),
        (b"PK\x03\x04rest", "an Excel workbook or zip archive, expected plain CSV"),
        (b"time,ax,ay,az,gx,gy,gz\n0,0,0,1,0,0,0\n", "column 'ax' has no unit, expected a header with units"),
        (b"0.0,1,2,3,4,5,6\n0.1,1,2,3,4,5,6\n", "begins with numbers .*expected a header with units"),
        (HEADER.encode(), "no whole row"),
        (plain("0.0,left,1,2\n"), "no whole row"),
        (plain("nan,left,0,0,-9.8,0,0,0,,,\n"), "none of 1 rows is finite"),
        (plain(still(f=(0, 0, -1.0))), r"rests at 1.00 .*this looks like g"),
        (plain(still(f=(0, 0, -0.981))), r"rests at 0.98 \(0.1 g\): this looks like g"),
        (plain(still(f=(0, 0, -1000.0))), "this looks like mg"),
    ],
)
def test_no_recording(data: bytes, words: str) -> None:
    with pytest.raises(InputError, match=f"^walk.csv: .*{words}") as error:
        read("walk.csv", data)
    assert "\n" not in str(error.value)


def test_rest_at_a_tenth_of_g_in_a_column_of_g() -> None:
    rows = "".join(f"{i / 100},0.1,0,0,0,0,0.1\n" for i in range(100))
    with pytest.raises(InputError, match=r"rests at 0.10 g: expected 1 g; check the sensor's scale"):
        read("walk.csv", f"{XIO}\n{rows}".encode())


def test_two_samples_are_a_recording() -> None:
    recording = read("walk.csv", plain(still(2)))
    assert len(recording.sensors[0]) == 2
    assert recording.duration_s == pytest.approx(0.01)


def test_one_sample_is_a_recording() -> None:
    recording = read("walk.csv", plain(still(1)))
    assert (len(recording.sensors[0]), recording.duration_s, recording.sensors[0].rate_hz) == (1, 0.0, 0.0)


@pytest.mark.parametrize(
    ("spoilt", "reason"),
    [
        ("1.000,foot,nan,0,-9.8,0,0,0,,,\n", "not a finite number"),
        ("1.000,foot,0,0,-inf,0,0,0,,,\n", "not a finite number"),
        ("1.000,foot,0,0,-9.8,0,1e99,0,,,\n", "not a finite number"),
        ("1.000,foot,0,0,oops,0,0,0,,,\n", "not a finite number"),
        (",foot,0,0,-9.8,0,0,0,,,\n", "not a finite number"),
        ("0.500,foot,0,0,-9.8,0,0,0,,,\n", "time went backward"),
        ("0.990,foot,0,0,-9.8,0,0,0,,,\n", "repeated time"),
        ("1.000,foot,0,0\n", "wrong number of cells"),
    ],
)
def test_a_spoilt_row_is_dropped_and_counted(spoilt: str, reason: str) -> None:
    recording = read("walk.csv", plain(still(100) + spoilt + still(100, start_s=1.01)))
    (samples,) = recording.sensors
    assert (len(samples), recording.dropped_rows, dict(samples.dropped)) == (200, 1, {reason: 1})


def test_a_truncated_last_row_is_dropped_and_counted() -> None:
    recording = read("walk.csv", plain(still(100))[:-40])
    assert dict(recording.sensors[0].dropped) == {"truncated row": 1}
    assert len(recording.sensors[0]) == 99


def test_ten_missing_seconds_stay_missing() -> None:
    recording = read("walk.csv", plain(still(100) + still(100, start_s=11.0)))
    assert np.diff(recording.sensors[0].matrix[:, 0]).max() == pytest.approx(10.01e9)
    assert recording.dropped_rows == 0


def test_clipped_samples_are_flagged() -> None:
    clipped = "".join(f"{1 + i / 100:.2f},foot,0,0,-49.03325,0,0,0,,,\n" for i in range(3))
    recording = read("walk.csv", plain(still(100) + clipped + still(100, start_s=1.1)))
    assert np.flatnonzero(recording.sensors[0].saturation).tolist() == [100, 101, 102]
    assert set(recording.sensors[0].saturation[100:103].tolist()) == {4}


# --- what a person says of the file ----------------------------------------------------------------


def test_axes_are_as_told_and_said() -> None:
    rows = "".join(f"{i / 100},1,2,3,1,0.02,0.03\n" for i in range(100))
    recording = read("walk.csv", f"{XIO}\n{rows}".encode(), Options(axes=parse_axes("y,-z,-x")))
    reading = recording.sensors[0].matrix[0, 1:7]
    expected = [0.02 * G, -0.03 * G, -G, *np.radians([2, -3, -1])]
    assert reading == pytest.approx(expected)
    assert recording.assumed == ("toe = y, right = −z, down = −x, as told",)


def test_a_magnetometer_turns_with_the_rest() -> None:
    header = XIO + "," + ",".join(f"Magnetometer {axis} (uT)" for axis in "XYZ")
    rows = "".join(f"{i / 100},0,0,0,0,0,1,10,20,30\n" for i in range(100))
    recording = read("walk.csv", f"{header}\n{rows}".encode())
    assert recording.sensors[0].matrix[0, 7:].tolist() == [10, -20, -30]


def test_a_plain_csv_whose_z_is_up_is_told_so() -> None:
    recording = read("walk.csv", plain(still(f=(0, 0, 9.8))))
    assert recording.sensors[0].matrix[0, 3] == 9.8
    assert recording.assumed == ("foot rests at (0.0, 0.0, 9.8) m/s²: z is not down, expected (0, 0, −9.8)",)


def test_two_feet_mounted_differently_are_each_turned() -> None:
    lines = [
        "sensor,left_sensor,left_sensor,left_sensor,left_sensor,left_sensor,left_sensor"
        ",right_sensor,right_sensor,right_sensor,right_sensor,right_sensor,right_sensor",
        "axis," + ",".join(["acc_x,acc_y,acc_z,gyr_x,gyr_y,gyr_z"] * 2),
        *(f"{i},0,0,9.8,0,0,0,0,9.8,0,0,0,0" for i in range(100)),
    ]
    recording = read("walk.csv", "\n".join(lines).encode())
    assert [samples.matrix[0, 1:4].tolist() for samples in recording.sensors] == [[0, 0, -9.8]] * 2
    assert any(s.startswith("left: toe = x, right = −y, down = −z") for s in recording.assumed)
    assert any(s.startswith("right: toe = x, right = z, down = −y") for s in recording.assumed)


def test_a_rate_replaces_the_times_and_is_said() -> None:
    recording = read("walk.csv", plain(still(100)), Options(rate_hz=50.0))
    assert recording.sensors[0].rate_hz == pytest.approx(50)
    assert recording.assumed == ("50 Hz as told, not the file's own times",)


def test_a_rate_for_a_file_without_times() -> None:
    data = XIO.replace("Time (s)", "Packet number") + "\n" + "".join(f"{i},0,0,0,0,0,1\n" for i in range(99))
    recording = read("walk.csv", data.encode(), Options(rate_hz=512.0))
    assert recording.sensors[0].rate_hz == pytest.approx(512)
    assert recording.assumed[0] == "512 Hz as told, the file has no times"


def test_one_foot_of_two() -> None:
    data = plain(still(10, foot="left") + still(10, foot="right", start_s=1))
    recording = read("walk.csv", data, Options(foot="right"))
    assert [(s.sensor, s.role, s.device_ns) for s in recording.sensors] == [("right", Role.RIGHT, 10**9)]
    with pytest.raises(InputError, match="foot=foot, but it holds left and right"):
        read("walk.csv", data, Options(foot="foot"))


def test_a_nameless_foot_is_named_and_a_named_one_is_not_renamed() -> None:
    recording = read("walk.csv", plain(still()), Options(foot="left"))
    assert [(s.sensor, s.role) for s in recording.sensors] == [("left", Role.LEFT)]
    with pytest.raises(InputError, match="foot=right, but it holds left"):
        read("walk.csv", plain(still(foot="left")), Options(foot="right"))


def test_a_device_tells_the_range() -> None:
    one_peak = "1.5,foot,0,0,-48.9,0,0,0,,,\n"
    data = plain(still(100) + one_peak)
    assert not read("walk.csv", data).sensors[0].saturation.any()
    assert read("walk.csv", data, Options(device="gx1")).sensors[0].saturation[100] == 4


# --- whatever the bytes -------------------------------------------------------------------------------


def obeys(recording: Recording) -> None:
    """The promises of ``Samples``."""
    assert recording.sensors
    for samples in recording.sensors:
        assert len(samples) > 0
        assert samples.matrix.shape == (len(samples), 10)
        assert samples.matrix[0, 0] == 0.0
        assert np.all(np.diff(samples.matrix[:, 0]) > 0)
        assert np.isfinite(samples.matrix[:, :7]).all()
        whole = np.isfinite(samples.matrix[:, 7:])
        assert np.all(whole.all(axis=1) | ~whole.any(axis=1))
        assert samples.saturation.shape == (len(samples),)
    assert math.isfinite(recording.duration_s)


def reads_or_says_why(data: bytes) -> None:
    try:
        obeys(read("x", data))
    except InputError as error:
        assert "\n" not in str(error)
        assert str(error).startswith("x: ")


@given(st.binary(max_size=300))
def test_any_bytes(data: bytes) -> None:
    reads_or_says_why(data)


HEADERS = [
    HEADER,
    XIO,
    XIO.replace("Time (s)", "Packet number"),
    "Time," + ",".join(f"inertial-1.2:scaled{q}{a}" for q in ("Accel", "Gyro", "Mag") for a in "XYZ"),
    ",index,acc_x,acc_y,acc_z,gyr_x,gyr_y,gyr_z",
    ",left_sensor" * 6 + "\n,acc_x,acc_y,acc_z,gyr_x,gyr_y,gyr_z",
]
CELL = st.one_of(
    st.floats().map(repr),
    st.integers(-(10**20), 10**20).map(str),
    st.sampled_from(
        ["", "left", "right", "foot", "-9.8", "0", "1", "12:00:01.5", "1e5", "\x00", "é", '"', "#", "1_0"]
    ),
)
ROWS = st.lists(st.lists(CELL, min_size=6, max_size=12).map(",".join), max_size=8).map("\n".join)


@given(st.sampled_from(HEADERS), ROWS)
def test_any_cells_under_a_known_header(header: str, rows: str) -> None:
    reads_or_says_why(f"{header}\n{rows}".encode())


VALID = [
    plain(still(20) + still(5, foot="left", start_s=1)),
    f"{XIO}\n".encode() + b"".join(b"%d,0,0,0,0,0,1\n" % i for i in range(20)),
    f"{HEADERS[3]}\n".encode() + b"".join(b"%d,0,0,-1,0,0,0,0.2,0,0.4\n" % i for i in range(20)),
    f"{HEADERS[4]}\n".encode() + b"".join(b"%d,%d,0,0,9.8,0,0,0\n" % (i, i) for i in range(20)),
]


@given(
    st.sampled_from(VALID),
    st.lists(st.tuples(st.floats(0, 1), st.integers(0, 3), st.binary(max_size=4)), max_size=6),
)
def test_damaged_files(data: bytes, damages: list[tuple[float, int, bytes]]) -> None:
    for place, removed, inserted in damages:
        at = int(place * len(data))
        data = data[:at] + inserted + data[at + removed :]
    reads_or_says_why(data)


@pytest.mark.parametrize("data", VALID)
def test_the_undamaged_ones_are_read(data: bytes) -> None:
    obeys(read("x", data))
