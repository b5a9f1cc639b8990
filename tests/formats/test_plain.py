import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.formats.clean import clean
from app.formats.plain import HEADER, encode, parse
from app.formats.reading import read
from app.formats.table import read_head
from app.motion.basics import InputError, Role, role_of
from app.motion.recording import Recording
from app.motion.samples import Samples

READING = st.floats(-1e5, 1e5, allow_nan=False)
FIELD = st.floats(-1e5, 1e5, allow_nan=False)


@st.composite
def samples_of(draw: st.DrawFn, sensor: str) -> Samples:
    steps = draw(st.lists(st.integers(1, 10**10), min_size=0, max_size=8))
    count = len(steps) + 1
    matrix = np.full((count, 10), np.nan)
    matrix[:, 0] = np.cumsum([0, *steps])
    matrix[:, 1:7] = draw(hnp.arrays(float, (count, 6), elements=READING))
    with_field = draw(hnp.arrays(bool, count))
    matrix[with_field, 7:] = draw(hnp.arrays(float, (count, 3), elements=FIELD))[with_field]
    start = draw(st.integers(-(10**12), 2 * 10**18))
    return Samples(sensor, role_of(sensor), start, matrix, np.zeros(count, np.uint16))


def decoded(data: bytes) -> dict[str, Samples]:
    parsed = parse("x.csv", data, read_head(data))
    return {raw.sensor: clean(raw)[0] for raw in parsed.feet}


@given(samples_of("left"), samples_of("right"))
def test_what_is_written_reads_back_to_the_bit(left: Samples, right: Samples) -> None:
    feet = decoded(encode(Recording("x", "plain CSV", (left, right))))
    for samples in (left, right):
        assert feet[samples.sensor].device_ns == samples.device_ns
        np.testing.assert_array_equal(feet[samples.sensor].matrix, samples.matrix)
        assert not feet[samples.sensor].dropped


@given(samples_of("foot"))
def test_rows_are_in_time_order_and_well_formed(samples: Samples) -> None:
    lines = encode(Recording("x", "plain CSV", (samples,))).decode().splitlines()
    assert lines[0] == HEADER
    assert {line.count(",") for line in lines} == {10}
    assert len(lines) == 1 + len(samples)


def test_the_spec_in_the_first_comment_comes_back(foot) -> None:
    data = plain(foot)
    recording = read("walk.csv", b"# spec: sim:walk?path=oval&seed=3\n# by hand\n" + data)
    assert recording.spec == "sim:walk?path=oval&seed=3"
    assert encode(recording).startswith(b"# spec: sim:walk?path=oval&seed=3\nt_s,foot,")


def test_sensors_with_names_of_their_own_are_written_by_their_feet() -> None:
    def named(sensor: str, role: Role) -> Samples:
        return Samples(sensor, role, 0, np.zeros((3, 10)), np.zeros(3, np.uint16))

    shoes = Recording("x", "plain CSV", (named("imu-7", Role.LEFT), named("imu-9", Role.RIGHT)))
    assert list(decoded(encode(shoes))) == ["left", "right"]
    alike = Recording("x", "plain CSV", (named("imu-7", Role.FOOT), named("imu-9", Role.FOOT)))
    assert b",imu-7," in encode(alike)
    assert b",imu-9," in encode(alike)


def plain(foot, name: str = "left", times: np.ndarray | None = None) -> bytes:
    """The foot of conftest as plain CSV."""
    t_s = foot.t_s if times is None else times
    rows = np.column_stack([foot.force, foot.rate, foot.field / 100]).tolist()
    lines = [f"{t!r},{name}," + ",".join(map(repr, row)) for t, row in zip(t_s.tolist(), rows, strict=True)]
    return "\n".join([HEADER, *lines, ""]).encode()


def test_units_axes_and_roles(foot) -> None:
    recording = read("walk.csv", plain(foot))
    (left,) = recording.sensors
    assert (left.sensor, left.role, recording.format) == ("left", Role.LEFT, "plain CSV")
    np.testing.assert_array_equal(left.matrix[:, 1:4], foot.force)
    np.testing.assert_array_equal(left.matrix[:, 4:7], foot.rate)
    np.testing.assert_allclose(left.matrix[:, 7:], foot.field, rtol=1e-15)
    assert recording.assumed == ()


def test_both_feet_mixed_and_comments_between(foot) -> None:
    left, right = plain(foot).splitlines()[1:], plain(foot, "right", foot.t_s + 0.003).splitlines()[1:]
    mixed = [line for pair in zip(left, right, strict=True) for line in pair]
    data = b"\n".join([HEADER.encode(), *mixed[:100], b"# a marker", *mixed[100:]])
    recording = read("walk.csv", data)
    assert [(s.sensor, len(s)) for s in recording.sensors] == [("left", 400), ("right", 400)]
    assert recording.sensors[1].device_ns == 3_000_000
    assert recording.duration_s == pytest.approx(3.993)
    assert recording.dropped_rows == 0


def test_empty_magnetometer_cells_are_no_field_and_no_loss(foot) -> None:
    rows = [line.rsplit(b",", 3)[0] + b",,," for line in plain(foot).splitlines()[1:]]
    recording = read("walk.csv", b"\n".join([HEADER.encode(), *rows]))
    assert len(recording.sensors[0]) == 400
    assert np.isnan(recording.sensors[0].matrix[:, 7:]).all()


def test_clock_time_since_1970_keeps_its_nanoseconds(foot) -> None:
    stamps = 1_700_000_000_123_456_789 + 10_000_001 * np.arange(400)
    rows = [line.split(b",", 1)[1] for line in plain(foot).splitlines()[1:]]
    lines = [b"%d.%09d,%b" % (*divmod(int(ns), 10**9), row) for ns, row in zip(stamps, rows, strict=True)]
    (left,) = read("walk.csv", b"\n".join([HEADER.encode(), *lines])).sensors
    assert left.device_ns == stamps[0]
    np.testing.assert_array_equal(left.matrix[:, 0].astype(int), stamps - stamps[0])


def test_a_missing_column_is_named(foot) -> None:
    data = plain(foot).replace(b"wy_radps", b"wy", 1)
    with pytest.raises(InputError, match="walk.csv: the header has no column 'wy_radps', expected t_s,foot"):
        read("walk.csv", data)


def test_a_foot_of_another_name_is_counted(foot) -> None:
    data = plain(foot).replace(b"0.5,left", b"0.5,hand", 1)
    recording = read("walk.csv", data)
    assert len(recording.sensors[0]) == 399
    assert recording.sensors[0].dropped == {"neither left, right nor foot": 1}
    with pytest.raises(InputError, match="'hand', expected left, right or foot"):
        read("walk.csv", plain(foot, "hand"))
