"""Heart: readings in a device's axes and SI made into samples, and taken apart again for the wire.

A decoder scales; this turns the axes by the mounting, flags what touches the range and counts.
"""

from __future__ import annotations

import math

import numpy as np

from app.formats.mounting import Axes, rotation
from app.formats.saturation import Range
from app.motion.basics import G_MPS2, Quaternion, Vector
from app.motion.samples import Sample
from app.rotation import conjugate, multiply

Z_UP: Axes = ((0, 1), (1, -1), (2, -1))  # a board with z up and x ahead
RAD_PER_DEG = math.pi / 180.0
#: More no inertial sensor reads (200 g, 7000 °/s): a digit or a bit was damaged where no checksum tells.
MOST_MPS2, MOST_RADPS = 2000.0, 120.0
#: Less no sensor reads but nothing at all (g, deg/s): single precision leaves more of any difference.
LEAST = 1e-9
_NEAR_RANGE = 0.98  # flagged from here on, as in recordings
_HALF = math.sqrt(0.5)

#: Earth frames that devices refer to, each as the quaternion that takes it into north–east–down.
NED: Quaternion = (1.0, 0.0, 0.0, 0.0)
NWU: Quaternion = (0.0, 1.0, 0.0, 0.0)
ENU: Quaternion = (0.0, _HALF, _HALF, 0.0)


def _possible(v: Vector, most: float) -> bool:
    """Finite and within ±``most``."""
    return -most <= v[0] <= most and -most <= v[1] <= most and -most <= v[2] <= most


def measurable(v: Vector) -> bool:
    """Whether a sensor can have read this, g or deg/s; a float whose exponent was damaged may be far less."""
    return all(x == 0.0 or abs(x) >= LEAST for x in v)


def measured(v: Vector) -> Vector:
    """What of v, g or deg/s, a sensor would read: no remainders of somebody's arithmetic."""
    x, y, z = v
    return (x if abs(x) >= LEAST else 0.0, y if abs(y) >= LEAST else 0.0, z if abs(z) >= LEAST else 0.0)


def scaled(v: Vector, factor: float) -> Vector:
    """v times ``factor``."""
    return (v[0] * factor, v[1] * factor, v[2] * factor)


class Maker:
    """Makes one sensor's samples: knows its name, its mounting, its range and how many there were.

    ``earth`` takes the frame that the device's quaternions refer to into north–east–down.
    """

    def __init__(self, sensor: str, axes: Axes, full_scale: Range, earth: Quaternion = NED) -> None:
        self._sensor, self._axes, self._earth = sensor, axes, earth
        self._seq = 0
        self._limits = tuple(
            _NEAR_RANGE * limit for limit in (full_scale.force, full_scale.rate, full_scale.field)
        )
        self._q_db = device_from_body(axes)
        self._orientation(NED)  # the products are compiled on their first call: no sample waits for it

    def make(
        self,
        device_ns: int,
        host_ns: int,
        force_d: Vector,
        rate_d: Vector,
        field_d: Vector | None = None,
        saturation_d: int = 0,
        q_ed: Quaternion | None = None,
    ) -> Sample | None:
        """A sample of force m/s², rate rad/s, field µT in device axes; None if no sensor reads that.

        ``saturation_d`` are the channels (bits as in ``Sample``) that the device itself calls clipped;
        ``q_ed`` is its orientation, taking device vectors into its earth frame.
        """
        if not (_possible(force_d, MOST_MPS2) and _possible(rate_d, MOST_RADPS)):
            return None
        if field_d is not None and not math.isfinite(sum(field_d)):
            field_d = None
        force_b, rate_b = self._turn(force_d), self._turn(rate_d)
        field_b = None if field_d is None else self._turn(field_d)
        saturation = self._turn_bits(saturation_d) if saturation_d else 0
        saturation |= self._flags(force_b, 0) | self._flags(rate_b, 1)
        if field_b is not None:
            saturation |= self._flags(field_b, 2)
        q_nb = None if q_ed is None else self._orientation(q_ed)
        seq = self._seq
        self._seq += 1
        return Sample(self._sensor, seq, device_ns, host_ns, force_b, rate_b, field_b, saturation, q_nb)

    def _turn(self, v: Vector) -> Vector:
        (i, a), (j, b), (k, c) = self._axes
        return (a * v[i], b * v[j], c * v[k])

    def _flags(self, v: Vector, group: int) -> int:
        limit = self._limits[group]
        if -limit < min(v) and max(v) < limit:
            return 0
        return sum(1 << (3 * group + i) for i in range(3) if abs(v[i]) >= limit)

    def _turn_bits(self, bits_d: int) -> int:
        return sum(
            (bits_d >> (3 * group + index) & 1) << (3 * group + i)
            for group in range(3)
            for i, (index, _) in enumerate(self._axes)
        )

    def _orientation(self, q_ed: Quaternion) -> Quaternion | None:
        norm = math.sqrt(sum(part * part for part in q_ed))
        if not 0.95 < norm < 1.05:  # also false for NaN
            return None
        unit = (q_ed[0] / norm, q_ed[1] / norm, q_ed[2] / norm, q_ed[3] / norm)
        return multiply(multiply(self._earth, unit), self._q_db)


class Taker:
    """The inverse of a ``Maker``: what the device itself reads, for encoders."""

    def __init__(self, axes: Axes, full_scale: Range, earth: Quaternion = NED) -> None:
        self._axes, self._full_scale = axes, full_scale
        self._earth_inverse = conjugate(earth)
        self._q_bd = conjugate(device_from_body(axes))

    def force(self, sample: Sample) -> Vector:
        """Specific force in device axes, m/s², clipped as the sensor clips."""
        return self._turn_back(sample.specific_force_b, self._full_scale.force)

    def rate(self, sample: Sample) -> Vector:
        """Angular rate in device axes, rad/s, clipped."""
        return self._turn_back(sample.angular_rate_b, self._full_scale.rate)

    def field(self, sample: Sample) -> Vector:
        """Field in device axes, µT or relative, clipped; zeros where the sample has none."""
        return self._turn_back(sample.field_b or (0.0, 0.0, 0.0), self._full_scale.field)

    def orientation(self, sample: Sample) -> Quaternion:
        """The quaternion from device axes into the device's earth frame; identity where there is none."""
        if sample.device_q_nb is None:
            return (1.0, 0.0, 0.0, 0.0)
        return multiply(multiply(self._earth_inverse, sample.device_q_nb), self._q_bd)

    def saturation(self, sample: Sample) -> int:
        """The clipped channels, bits as in ``Sample``, of the device's axes."""
        return sum(
            (sample.saturation >> (3 * group + i) & 1) << (3 * group + index)
            for group in range(3)
            for i, (index, _) in enumerate(self._axes)
        )

    def _turn_back(self, v_b: Vector, limit: float) -> Vector:
        v = [0.0, 0.0, 0.0]
        for value, (index, sign) in zip(v_b, self._axes, strict=True):
            v[index] = sign * min(max(value, -limit), limit)
        return (v[0], v[1], v[2])


def device_from_body(axes: Axes) -> Quaternion:
    """The quaternion that takes shoe vectors into the device's axes."""
    m = rotation(axes).T
    # the eigenvector of the greatest eigenvalue (Bar-Itzhack): no case by case for half turns
    k = np.array(
        [
            [m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
            [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
            [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]],
        ]
    )
    x, y, z, w = (float(part) for part in np.linalg.eigh(k)[1][:, -1])
    return (w, x, y, z)


def quantised(value: float, lsb: float, bits: int = 16) -> int:
    """The nearest signed code of ``bits`` bits, held inside its range."""
    most = (1 << (bits - 1)) - 1
    return min(max(round(value / lsb), -most - 1), most)


def in_g(force: Vector) -> Vector:
    """m/s² in g."""
    return scaled(force, 1.0 / G_MPS2)
