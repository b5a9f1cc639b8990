"""Orientations for OpenSim."""

from __future__ import annotations

import numpy as np

from app.formats.sto import sto
from app.motion.basics import Role


def test_two_feet_share_one_clock_by_the_nearest_sample() -> None:
    left = (np.array([0.0, 0.01, 0.02]), np.eye(4)[:3])
    right = (np.array([0.004, 0.012]), np.array([[1.0, 0, 0, 0], [0, 0, 0, 1.0]]))
    lines = sto(100.0, {Role.LEFT: left, Role.RIGHT: right}).decode().splitlines()
    assert lines[:2] == ["DataRate=100.000000", "DataType=Quaternion"]
    assert lines[lines.index("endheader") + 1] == "time\tcalcn_l_imu\tcalcn_r_imu"
    cells = [line.split("\t") for line in lines[-3:]]
    assert [float(row[0]) for row in cells] == [0.0, 0.01, 0.02]
    assert [[float(x) for x in row[1].split(",")] for row in cells] == np.eye(4)[:3].tolist()
    assert [row[2].split(",")[0][0] for row in cells] == ["1", "0", "0"]


def test_a_foot_of_one_sample_is_enough() -> None:
    one = (np.array([0.0]), np.array([[1.0, 0, 0, 0]]))
    assert (
        sto(0.0, {Role.FOOT: one})
        .decode()
        .endswith("0.000000000\t1.000000000,0.000000000,0.000000000,0.000000000\n")
    )
