"""Heart: ROS 2 messages as CDR, each packed by one struct: Imu, MagneticField, Temperature, PoseStamped.

Little-endian, plain CDR (version 1): four bytes of encapsulation, a header (stamp, frame), doubles.
"""

from __future__ import annotations

import math
import struct
from functools import cache

from app.motion.basics import Floats, Quaternion, Vector

_HEADER = """
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
_VECTOR = """================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""
_QUATERNION = """================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"""
_POINT = """================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
"""
IMU = "sensor_msgs/msg/Imu"
MAGNETIC_FIELD = "sensor_msgs/msg/MagneticField"
TEMPERATURE = "sensor_msgs/msg/Temperature"
POSE = "geometry_msgs/msg/PoseStamped"
#: Name of a message → its definition, as other tools need it to read the doubles.
DEFINITIONS = {
    IMU: "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
    "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
    "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance"
    + _HEADER
    + _QUATERNION
    + _VECTOR,
    MAGNETIC_FIELD: "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\n"
    "float64[9] magnetic_field_covariance" + _HEADER + _VECTOR,
    TEMPERATURE: "std_msgs/Header header\nfloat64 temperature\nfloat64 variance" + _HEADER,
    POSE: "std_msgs/Header header\ngeometry_msgs/Pose pose" + _HEADER + _POINT + _QUATERNION,
}

_UNKNOWN = (0.0,) * 9  # ROS: an unknown covariance is all zeros
_ABSENT = (-1.0, *_UNKNOWN[1:])  # ROS: −1 first means that there is no such reading
_NO_Q = (0.0, 0.0, 0.0, 1.0)


@cache
def _packer(frame: bytes, doubles: int) -> struct.Struct:
    """Encapsulation, stamp, frame with its NUL, padding to 8, doubles."""
    padding = -(12 + len(frame)) % 8
    return struct.Struct(f"<4siII{len(frame)}s{padding}x{doubles}d")


def _pack(stamp_ns: int, frame: str, doubles: tuple[float, ...]) -> bytes:
    name = frame.encode() + b"\0"
    sec, nanosec = divmod(stamp_ns, 1_000_000_000)
    if not -(2**31) <= sec < 2**31:  # the sensor's own clock need not fit; it is kept beside the message
        sec, nanosec = 0, 0
    packer = _packer(name, len(doubles))
    return packer.pack(b"\0\1\0\0", sec, nanosec, len(name), name, *doubles)


def imu(stamp_ns: int, frame: str, q_nb: Quaternion | None, rate_b: Vector, force_b: Vector) -> bytes:
    """``sensor_msgs/Imu``; ``q_nb`` wxyz is the device's own orientation, None where it has none."""
    turned = _NO_Q if q_nb is None else (*q_nb[1:], q_nb[0])
    first = _ABSENT if q_nb is None else _UNKNOWN
    return _pack(stamp_ns, frame, (*turned, *first, *rate_b, *_UNKNOWN, *force_b, *_UNKNOWN))


def imu_columns(doubles: Floats) -> tuple[Floats, Floats, Floats]:
    """Of doubles [n, 11], ``IMU_COLUMNS``: q_nb [n, 4] wxyz (NaN for none), rate [n, 3], force [n, 3]."""
    q_nb = doubles[:, [3, 0, 1, 2]]
    q_nb[doubles[:, 4] == -1.0] = math.nan
    return q_nb, doubles[:, 5:8].copy(), doubles[:, 8:11].copy()


IMU_DOUBLES = 37
#: Those of them that say anything: orientation xyzw, whether there is one, rate, force.
IMU_COLUMNS = (0, 1, 2, 3, 4, 13, 14, 15, 25, 26, 27)


def magnetic_field(stamp_ns: int, frame: str, field_t: Vector) -> bytes:
    """``sensor_msgs/MagneticField`` of a field in tesla, see ``tesla``."""
    return _pack(stamp_ns, frame, (*field_t, *_UNKNOWN))


MAGNETIC_DOUBLES = 12


def tesla(field_ut: Vector) -> Vector:
    """A field in tesla such that ``microtesla`` gives the same doubles again; the nearest where none does."""
    x, y, z = field_ut
    return _tesla(x), _tesla(y), _tesla(z)


def _tesla(value_ut: float) -> float:
    nearest = value_ut * 1e-6
    if nearest * 1e6 == value_ut:
        return nearest
    for candidate in (math.nextafter(nearest, math.inf), math.nextafter(nearest, -math.inf)):
        if candidate * 1e6 == value_ut:
            return candidate
    return nearest


def comes_back(field_ut: Vector, field_t: Vector) -> bool:
    """Whether a field in µT survived the way through tesla to the bit."""
    return all(t * 1e6 == ut or ut != ut for t, ut in zip(field_t, field_ut, strict=True))


def microtesla(doubles: Floats) -> Floats:
    """Field [n, 3] in µT of doubles [n, 12]."""
    field: Floats = doubles[:, :3] * 1e6
    return field


def temperature(stamp_ns: int, frame: str, celsius: float) -> bytes:
    """``sensor_msgs/Temperature``, °C; its variance is unknown: 0."""
    return _pack(stamp_ns, frame, (celsius, 0.0))


TEMPERATURE_DOUBLES = 2


def pose(stamp_ns: int, frame: str, position_n: Vector, q_nb: Quaternion) -> bytes:
    """``geometry_msgs/PoseStamped``: a place and an orientation (wxyz in, xyzw in the message)."""
    return _pack(stamp_ns, frame, (*position_n, *q_nb[1:], q_nb[0]))
