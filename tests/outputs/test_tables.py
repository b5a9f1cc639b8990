"""What ``process --out`` writes: headers, orders, units and the order of both feet."""

from __future__ import annotations

import csv
import math
import resource
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.motion.basics import InputError
from app.outputs import tables
from app.settings import Settings
from app.shell import batch
from tests.estimator.walks import estimate, foot, rows_of

HEADER = "t_s,foot,north_m,east_m,down_m,vn_mps,ve_mps,vd_mps,qw,qx,qy,qz,phase"
STRIDES = "foot,start_s,end_s,length_m,duration_s,swing_s,stance_s,lift_m,turn_deg"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two feet around a square, written."""
    out = tmp_path_factory.mktemp("out") / "new" / "deep"
    done = batch.process("sim:walk?path=square&feet=2&rate_hz=100", Settings())
    written = batch.write(done, out)
    assert {p.name for p in written} == {
        "trajectory.csv", "strides.csv", "trajectory_left.tum", "trajectory_right.tum",
    }  # fmt: skip
    return out


def read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_the_headers_are_those_that_scripts_read(folder: Path) -> None:
    assert (folder / "trajectory.csv").read_text().split("\n")[0] == HEADER
    assert (folder / "strides.csv").read_text().split("\n")[0] == STRIDES


@pytest.mark.parametrize(("side", "number"), [("left", 0), ("right", 1)])
def test_one_row_per_sample_and_every_number_to_the_bit(folder: Path, side: str, number: int) -> None:
    samples = foot("path=square&feet=2&rate_hz=100", number)
    rows = rows_of(estimate(samples))
    found = [r for r in read(folder / "trajectory.csv") if r["foot"] == side]
    values = np.array([[float(r[name]) for name in HEADER.split(",")[2:12]] for r in found])
    assert values.tobytes() == np.ascontiguousarray(rows[:, :10]).tobytes()
    assert [r["phase"] for r in found] == ["swing" if p else "stance" for p in rows[:, 10]]
    assert np.allclose([float(r["t_s"]) for r in found], samples.matrix[:, 0] * 1e-9, rtol=0, atol=1e-9)


def test_a_disk_that_gets_full_leaves_no_half_table(tmp_path: Path) -> None:
    done = batch.process("sim:walk?strides=20", Settings())
    (tmp_path / "strides.csv").write_text("kept")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))  # Python ignores the signal that comes with it
    try:
        with pytest.raises(InputError, match="too large"):
            batch.write(done, tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert [path.name for path in tmp_path.iterdir()] == ["strides.csv"]


def test_both_feet_are_in_time_order(folder: Path) -> None:
    for name, key in (("trajectory.csv", "t_s"), ("strides.csv", "end_s")):
        rows = read(folder / name)
        times = [float(r[key]) for r in rows]
        assert times == sorted(times)
        assert {r["foot"] for r in rows} == {"left", "right"}


def test_tum_has_the_scalar_last(folder: Path) -> None:
    rows = [r for r in read(folder / "trajectory.csv") if r["foot"] == "left"]
    tum = np.loadtxt(folder / "trajectory_left.tum")
    assert tum.shape == (len(rows), 8)
    for row, line in list(zip(rows, tum, strict=True))[::97]:
        assert line[1:4] == pytest.approx([float(row[k]) for k in ("north_m", "east_m", "down_m")], abs=1e-8)
        assert line[4:] == pytest.approx([float(row[k]) for k in ("qx", "qy", "qz", "qw")], abs=1e-8)
    middle = Rotation.from_quat(tum[len(tum) // 2, 4:])  # SciPy: scalar last too
    assert np.isfinite(middle.as_matrix()).all()


def test_a_square_to_the_right_turns_by_minus_360_degrees(folder: Path) -> None:
    """Positive to the left, opposite to NED yaw."""
    for side in ("left", "right"):
        rows = [r for r in read(folder / "trajectory.csv") if r["foot"] == side]
        yaw = [
            math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
            for w, x, y, z in ([float(r[k]) for k in ("qw", "qx", "qy", "qz")] for r in rows)
        ]
        clockwise = math.degrees(np.unwrap(yaw)[-1] - yaw[0])
        turned = sum(float(r["turn_deg"]) for r in read(folder / "strides.csv") if r["foot"] == side)
        assert abs(turned) == pytest.approx(360.0, abs=5.0)
        assert turned == pytest.approx(-clockwise, abs=1.0)


def test_strides_are_the_trackers(folder: Path) -> None:
    strides = estimate(foot("path=square&feet=2&rate_hz=100", 1)).strides
    found = [r for r in read(folder / "strides.csv") if r["foot"] == "right"]
    assert len(found) == len(strides)
    for row, stride in zip(found, strides, strict=True):
        for name in ("start_s", "end_s", "length_m", "duration_s", "swing_s", "stance_s", "lift_m"):
            assert float(row[name]) == pytest.approx(getattr(stride, name), abs=1e-6)
        assert float(row["turn_deg"]) == pytest.approx(math.degrees(stride.turn_rad), abs=1e-5)


def test_a_foot_that_starts_later_is_late_in_the_files(tmp_path: Path) -> None:
    samples = foot("strides=3")
    tracker = estimate(samples)
    t_s = samples.matrix[:, 0] * 1e-9 + 1.5
    table = tables.FootTable("right", t_s, rows_of(tracker), tracker.strides, 1.5)
    tables.write(tmp_path, [table])
    assert float(read(tmp_path / "trajectory.csv")[0]["t_s"]) == 1.5
    assert float(read(tmp_path / "strides.csv")[0]["start_s"]) == pytest.approx(
        tracker.strides[0].start_s + 1.5
    )


def test_nothing_to_tell_is_headers_only(tmp_path: Path) -> None:
    tables.write(tmp_path, [])
    assert (tmp_path / "trajectory.csv").read_text() == HEADER + "\n"
    assert (tmp_path / "strides.csv").read_text() == STRIDES + "\n"


def test_a_folder_that_cannot_be_made_is_one_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for bad in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(InputError, match="--out .*cannot be written"):
            tables.write(bad, [])
