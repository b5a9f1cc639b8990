"""Heart: what a Lab Streaming Layer stream's meta-data say of its channels, and what ours say.

LSL fixes no names for inertial channels; these are the usual ones (labels acc_x … mag_z, types ACC, GYRO,
MAGN), and any labels that ``columns`` knows are read.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.formats.mounting import AS_GIVEN, Axes
from app.formats.saturation import Range
from app.formats.wire.columns import UNITS, find_columns, spelt
from app.formats.wire.making import Z_UP, Maker, scaled
from app.formats.wire.ticks import DeviceClock
from app.motion.basics import Vector
from app.motion.samples import Sample

TYPE = "IMU"
#: What our own streams say of their axes, so that they are not turned a second time.
SHOE_AXES = "toe,right,down"

#: Stamps are told in whole nanoseconds below this; no machine has been on for 146 years.
_CLOCK_BITS = 62

_CELL = {"ACC": ("acc", "m/s^2"), "GYRO": ("gyr", "rad/s"), "MAGN": ("mag", "uT")}
_ASSUMED = {"force": "m/s^2", "rate": "rad/s", "field": "ut"}


@dataclass(frozen=True)
class Channel:
    """One channel's label, unit and type, as its stream tells them; empty where it does not."""

    label: str
    unit: str
    kind: str = ""


#: Ours, in their order; the last three only with a magnetometer.
CHANNELS = tuple(
    Channel(f"{stem}_{axis}", unit, kind) for kind, (stem, unit) in _CELL.items() for axis in "xyz"
)


def row(sample: Sample, channels: int) -> list[float]:
    """A sample as our channels, 6 or 9; a field that it does not have is NaN."""
    numbers = [*sample.specific_force_b, *sample.angular_rate_b]
    if channels > len(numbers):
        numbers += sample.field_b or (float("nan"),) * 3
    return numbers


class StreamReader:
    """Rows of one stream into samples. ``usable`` is False where it has no force and rate by name."""

    def __init__(self, sensor: str, channels: Sequence[Channel], axes_told: str, axes: Axes | None) -> None:
        self.notes: list[str] = []
        self.rejected = 0
        self._columns = find_columns([channel.label for channel in channels])
        self._clock = DeviceClock(1, _CLOCK_BITS)
        if axes is None:
            axes = AS_GIVEN if axes_told == SHOE_AXES else Z_UP
            if axes_told != SHOE_AXES:
                self.notes.append(f"{sensor}: taken as x ahead and z up: the stream does not say its axes")
        self._maker = Maker(sensor, axes, Range())
        if self._columns is not None:
            firsts = {"force": self._columns.force, "rate": self._columns.rate, "field": self._columns.field}
            self._factors = {
                kind: self._factor(sensor, kind, channels[places[0]].unit)
                for kind, places in firsts.items()
                if places is not None
            }

    def _factor(self, sensor: str, kind: str, unit: str) -> float:
        unit = spelt({"microteslas": "uT", "microtesla": "uT"}.get(unit.lower(), unit))
        if unit not in UNITS[kind]:
            self.notes.append(
                f"{sensor}: {kind} taken in {_ASSUMED[kind]}: the stream says {unit or 'no unit'!r}"
            )
            unit = _ASSUMED[kind]
        return UNITS[kind][unit]

    @property
    def usable(self) -> bool:
        """Whether samples can be made of it."""
        return self._columns is not None

    def read(self, stamp_s: float, numbers: Sequence[float], host_ns: int) -> Sample | None:
        """One row; None where it is not finite, or where its stamp does not follow those before it.

        A lone wild stamp costs its own row; a clock that was really set anew goes on behind a gap.
        """
        columns = self._columns
        stamp_ns = None
        if columns is not None and len(numbers) >= columns.count and 0.0 <= stamp_s * 1e9 < 2**_CLOCK_BITS:
            stamp_ns = self._clock.stamp(round(stamp_s * 1e9), host_ns)
        if columns is None or stamp_ns is None:
            self.rejected += 1
            return None
        force = scaled(_three(numbers, columns.force), self._factors["force"])
        rate = scaled(_three(numbers, columns.rate), self._factors["rate"])
        field = None
        if columns.field is not None:
            field = scaled(_three(numbers, columns.field), self._factors["field"])
        sample = self._maker.make(stamp_ns, host_ns, force, rate, field)
        self.rejected += sample is None
        return sample


def _three(numbers: Sequence[float], places: tuple[int, int, int]) -> Vector:
    return (float(numbers[places[0]]), float(numbers[places[1]]), float(numbers[places[2]]))


def sensor_of(told: str, name: str) -> str:
    """The sensor's name: as the stream says its foot, or as its own name lets see."""
    for foot in ("left", "right"):
        if told.lower() == foot or (not told and foot in name.lower()):
            return foot
    return "foot"
