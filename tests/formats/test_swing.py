import numpy as np
import pytest

from app.formats.mounting import AS_GIVEN, Axes, parse_axes, rotation
from app.formats.reading import read
from app.formats.swing import face_forward
from app.motion.basics import Floats, Role
from app.motion.samples import Samples
from tests.formats.test_mounting import write_axes

FROM_ABOVE = ["x,y,z", "y,-x,z", "-x,-y,z", "-y,x,z"]


def walk(down_deg: float, up_deg: float, rate_hz: float = 100.0) -> Floats:
    """ω [n, 3] in body axes, 20 strides of a second: stance, toe down, toe up, stance."""
    t_s = np.arange(round(20 * rate_hz)) / rate_hz
    corners = ([0.0, 0.4, 0.6, 0.9, 1.0], np.radians([0.0, 0.0, -down_deg, up_deg, 0.0]))
    pitch = np.interp(t_s % 1.0, *corners)
    roll = np.radians(10) * np.where(t_s % 1.0 > 0.4, np.sin(2 * np.pi * (t_s % 1.0 - 0.4) / 0.6), 0.0)
    return np.column_stack([np.gradient(roll, t_s), np.gradient(pitch, t_s), np.zeros_like(t_s)])


def samples(rate: Floats, axes: Axes, rate_hz: float = 100.0) -> Samples:
    """As a sensor mounted this way reads it."""
    matrix = np.full((len(rate), 10), np.nan)
    matrix[:, 0] = np.arange(len(rate)) * round(1e9 / rate_hz)
    matrix[:, 4:7] = rate @ rotation(axes)
    return Samples("foot", Role.FOOT, 0, matrix, np.zeros(len(rate), np.uint16))


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 400.0])
@pytest.mark.parametrize("text", FROM_ABOVE)
def test_the_toe_is_found_whichever_way_the_sensor_looks(text: str, rate_hz: float) -> None:
    foot = samples(walk(60, 20, rate_hz), parse_axes(text), rate_hz)
    found = face_forward(foot, AS_GIVEN)
    assert found is not None
    assert write_axes(found) == text


@pytest.mark.parametrize(("down_deg", "up_deg"), [(40, 35), (15, 5), (0, 0)])
def test_an_unclear_swing_tells_nothing(down_deg: float, up_deg: float) -> None:
    assert face_forward(samples(walk(down_deg, up_deg), AS_GIVEN), AS_GIVEN) is None


def test_a_pendulum_tells_nothing() -> None:
    """It tilts to one side only, but does not stand between its swings."""
    t_s = np.arange(1000) / 100
    rate = np.outer(np.where(t_s < 1.0, 0.0, 5.0 * np.sin(2 * np.pi * t_s)), [0.0, 1.0, 0.0])
    assert face_forward(samples(rate, AS_GIVEN), AS_GIVEN) is None


def test_a_foot_that_never_stands_tells_nothing() -> None:
    spinning = walk(60, 20) + [0.0, 5.0, 0.0]
    assert face_forward(samples(spinning, AS_GIVEN), AS_GIVEN) is None


@pytest.mark.parametrize("name", ["31", "33", "34", "36", "38", "40"])
def test_the_toe_leads_to_the_first_footprints(shared_data, name: str) -> None:
    """Measured footprints start along the sensor's x: forward in two of these walks, backward in four."""
    path = shared_data / "hallway_gcp" / f"SensorConnectData_{name}.csv"
    prints = np.loadtxt(
        path.with_name(f"{path.stem}_strideIndex_timestamp_gcpX_gcpY.csv"), delimiter=",", skiprows=1
    )
    raw = np.loadtxt(path, delimiter=",", skiprows=1, usecols=1, max_rows=1)
    (foot,) = read(path.name, path.read_bytes()).sensors
    along_x = np.sign(foot.matrix[0, 1] * raw)  # +1 where the toe is the sensor's x
    assert along_x == np.sign(prints[2, 2])


def test_no_measured_walk_is_turned_about(shared_data) -> None:
    """On the sets whose x is known to be forward the swing agrees."""
    for path in sorted((shared_data / "pyshoe_vicon").glob("*.mat")):
        said = " ".join(read(path.name, path.read_bytes()).assumed)
        assert "toe = x," in said
