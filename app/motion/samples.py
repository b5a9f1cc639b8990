"""Heart: what a sensor says: one sample, or all of them in columns, and how its clock runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import Floats, Quaternion, Role, Vector

#: Two stamps further apart than this are two segments: nothing is integrated across.
GAP_NS = 250_000_000
#: m/s², rad/s or µT: no sensor reads that, and its square would spoil every sum.
MOST_READ = 1e6
#: Why a sample is dropped, in words, from a file and live.
NOT_FINITE, REPEATED, BACKWARD = "not a finite number", "repeated time", "time went backward"


class Sample(NamedTuple):
    """One reading of one sensor, in the shoe's axes. ``seq`` counts per sensor.

    ``specific_force_b`` is what an accelerometer reads: (0, 0, −g) m/s² at rest, pointing up.
    ``saturation`` has bit i set when channel i (force xyz, rate xyz, field xyz) is at its range.
    ``device_q_nb`` is the orientation the sensor computed itself, if it does.
    """

    sensor: str
    seq: int
    device_ns: int
    host_ns: int
    specific_force_b: Vector  # m/s²
    angular_rate_b: Vector  # rad/s
    field_b: Vector | None = None  # µT; relative (about 1) where the device has no unit
    saturation: int = 0
    device_q_nb: Quaternion | None = None


class Column(IntEnum):
    """Columns of a sample matrix, float64 [n, 10]: the form the compiled steps read.

    ``ELAPSED_NS`` is whole nanoseconds since the sensor's first sample: exact up to 104 days.
    A missing magnetometer is NaN.
    """

    ELAPSED_NS = 0
    FX = 1
    FY = 2
    FZ = 3
    WX = 4
    WY = 5
    WZ = 6
    MX = 7
    MY = 8
    MZ = 9


SAMPLE_WIDTH = len(Column)


@dataclass(frozen=True)
class Samples:
    """All samples of one sensor in columns: what an importer makes and a batch reads.

    Stamps increase strictly and every force and rate is finite: ``formats.clean`` dropped the
    rest and says how many. ``matrix`` is [n, 10] by ``Column``; ``device_ns`` is the first stamp.
    """

    sensor: str
    role: Role
    device_ns: int
    matrix: Floats
    saturation: NDArray[np.uint16]
    dropped: Mapping[str, int] = field(default_factory=dict)  # reason in words → rows
    device_q_nb: Floats | None = None  # [n, 4] what the sensor itself computed, NaN where it did not

    def __len__(self) -> int:
        return len(self.matrix)

    @property
    def duration_s(self) -> float:
        """Seconds from the first stamp to the last; 0 with fewer than two."""
        return float(self.matrix[-1, 0] - self.matrix[0, 0]) * 1e-9 if len(self) > 1 else 0.0

    @property
    def rate_hz(self) -> float:
        """Median sample rate; 0 with fewer than two samples."""
        return 1e9 / float(np.median(np.diff(self.matrix[:, 0]))) if len(self) > 1 else 0.0


class Rows(NamedTuple):
    """Rows ``first`` to ``last`` (exclusive) of a sensor's samples."""

    samples: Samples
    first: int
    last: int


class ClockLine(NamedTuple):
    """Where a sensor's clock showed ``device_ns`` the host's showed ``host_ns``, and how they part."""

    device_ns: int
    host_ns: int
    slope: float = 0.0  # host seconds gained on each second of the sensor's

    def host(self, device_ns: int) -> int:
        """A stamp on the host's clock, as if no sample had been delayed more than the least delayed."""
        passed = device_ns - self.device_ns
        return self.host_ns + passed + round(passed * self.slope)

    @property
    def drift_ppm(self) -> float:
        """How much too fast the sensor's clock runs; negative: too slow."""
        return (1.0 / (1.0 + self.slope) - 1.0) * 1e6


class GyroBias(NamedTuple):
    """A sensor's gyro bias as found once: what it reads at rest, in its axes, and σ of each, rad/s."""

    rate_b: Vector
    doubt_radps: Vector
