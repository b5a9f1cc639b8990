from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.columns import find_columns

AXES = "xyz"


@pytest.mark.parametrize(
    "header",
    [
        "t,ax,ay,az,gx,gy,gz",
        "time,accX,accY,accZ,gyrX,gyrY,gyrZ",
        "timestamp_ms,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z",
        "micros,AccelX,AccelY,AccelZ,wx,wy,wz",
        "ts,accelerometer_x,accelerometer_y,accelerometer_z,rx,ry,rz",
        "Time (s),Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g),Gyroscope X (deg/s),"
        "Gyroscope Y (deg/s),Gyroscope Z (deg/s)",
    ],
)
def test_the_names_people_use(header: str) -> None:
    columns = find_columns(header.split(","))
    assert columns is not None
    assert (columns.time, columns.force, columns.rate) == (0, (1, 2, 3), (4, 5, 6))
    assert (columns.field, columns.orientation) == (None, None)


def test_our_own_recordings_header() -> None:
    header = "t_s,foot,fx_mps2,fy_mps2,fz_mps2,wx_radps,wy_radps,wz_radps,mx_gauss,my_gauss,mz_gauss"
    columns = find_columns(header.split(","))
    assert columns is not None
    assert columns.units == {"time": "s", "force": "mps2", "rate": "radps", "field": "gauss"}
    assert (columns.count, columns.field) == (11, (8, 9, 10))


@pytest.mark.parametrize(("micros", "time", "unit"), [("", 1, "s"), ("micros,", 2, "us")])
def test_openlog_artemis(micros: str, time: int, unit: str) -> None:
    header = f"rtcDate,rtcTime,{micros}aX,aY,aZ,gX,gY,gZ,mX,mY,mZ,imu_degC,output_Hz"
    columns = find_columns(header.split(","))
    assert columns is not None
    assert columns.time == time
    assert columns.units["time"] == unit
    assert [columns.units[kind] for kind in ("force", "rate", "field")] == ["mg", "dps", "ut"]


@pytest.mark.parametrize("names", ["qw,qx,qy,qz", "q0,q1,q2,q3", "real,i,j,k"])
def test_quaternions_by_any_name(names: str) -> None:
    columns = find_columns(f"ax,ay,az,gx,gy,gz,{names}".split(","))
    assert columns is not None
    assert columns.orientation == (6, 7, 8, 9)


@given(st.permutations(["ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz", "t", "temp", "note"]))
def test_any_order(cells: list[str]) -> None:
    columns = find_columns(cells)
    assert columns is not None
    assert columns.field is not None
    assert [cells[i] for i in columns.force + columns.rate + columns.field] == [
        k + a for k in "agm" for a in AXES
    ]
    assert columns.time == cells.index("t")


@given(st.lists(st.text(max_size=12), max_size=20))
def test_other_words_are_no_header(cells: list[str]) -> None:
    assert find_columns(cells) is None


def test_half_a_header_is_none() -> None:
    assert find_columns(["ax", "ay", "az", "gx", "gy"]) is None
