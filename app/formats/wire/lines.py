"""Heart: text lines as hobby boards print them: columns by header, ``name:value`` pairs, or JSON.

Lines have no checksum (but ``$…*hh`` has), so a line is believed only when the end of the line before
it was seen: the rest of a line joined in the middle could pass for a row; and only with the decimals that
the board always prints (``decimals``). Units come from the header or
from the user; force and time are otherwise told by the numbers, the rate's unit never can be at rest and is
then assumed to be deg/s. Until they are settled, rows are kept and given late.
Axes: taken as z up, x ahead: say axes= otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from statistics import median

from app.formats.mounting import Axes
from app.formats.saturation import RANGES, Range
from app.formats.wire.cells import (
    are_words,
    flat_object,
    force_unit,
    is_broken,
    is_torn,
    named_cells,
    nanoseconds,
    number,
    quad,
    time_unit,
    triple,
    unwrapped,
    word_before,
)
from app.formats.wire.columns import UNITS, Columns, find_columns, is_unit, spelt
from app.formats.wire.counting import Count
from app.formats.wire.decimals import Decimals
from app.formats.wire.layouts import Layouts
from app.formats.wire.making import NED, Z_UP, Maker, Taker, scaled
from app.formats.wire.stream import NO_PACKET, UNKNOWN_YET, Frames, find_first
from app.formats.wire.ticks import ArrivalClock, DeviceClock
from app.formats.wire.warmth import believed, warming
from app.motion.basics import InputError, Quaternion
from app.motion.samples import Sample

FASTEST_HZ = 1000.0
BAUDS = (115200, 9600, 921600, 460800, 230400, 57600, 38400)
NATIVE = "#moves,v1"

_LONGEST = 1024
_TEXT = bytes([9, 10, 13, *range(32, 127), *range(128, 256)])
_CONTROL = bytes(byte for byte in range(256) if byte not in _TEXT)
_KEPT = 50  # rows to settle units by
_TICKS_NS = {"s": 10**9, "sec": 10**9, "ms": 10**6, "us": 1000, "µs": 1000, "μs": 1000, "ns": 1}
_NATIVE_COLUMNS = ["seq", "t", "ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz"]
_NATIVE_KEYS = {"acc": "force", "gyr": "rate", "mag": "field", "t": "time"}

Row = tuple[Columns, list[str], int, bytes]  # its columns, cells, arrival and line


def frames() -> Frames:
    """The lines of a stream, an empty one included; control characters make a line rubbish."""
    return Frames(
        find_first(_TEXT), _size, lambda line: len(line.translate(None, _CONTROL)) == len(line), _LONGEST
    )


def _size(data: bytes, at: int) -> int:
    end = data.find(b"\n", at, at + _LONGEST)
    if end < 0:
        return UNKNOWN_YET if len(data) - at < _LONGEST else NO_PACKET
    return end + 1 - at


class LinesDecoder:
    """Samples out of text lines.

    ``columns`` names them where no header does; ``units`` gives any of ``force``, ``rate``,
    ``field``, ``time`` that the header does not. A quaternion is taken as device axes into
    ``earth``, w first as named. Raises ``InputError`` for columns or units that it does not know.
    """

    def __init__(
        self,
        sensor: str,
        axes: Axes = Z_UP,
        columns: str | None = None,
        units: Mapping[str, str] | None = None,
        full_scale: Range = RANGES["csv"],
        rate_hz: float | None = None,
        earth: Quaternion = NED,
    ) -> None:
        self.notes: list[str] = []
        self._frames = frames()
        self.counters = self._frames.counters
        self._maker = Maker(sensor, axes, full_scale, earth)
        self._said = {kind: spelt(unit) for kind, unit in (units or {}).items()}
        for kind, unit in self._said.items():
            if kind not in ("force", "rate", "field", "time") or not is_unit(kind, unit):
                raise InputError(
                    f"unit {kind}={unit}: expected units of force, rate, field or time, such as force=g"
                )
        self._columns = None if columns is None else find_columns(columns.split(","))
        if columns is not None and self._columns is None:
            raise InputError(f"columns={columns}: expected names with ax,ay,az and gx,gy,gz among them")
        self._named: dict[tuple[str, ...], Columns | None] = {}
        self._layouts = Layouts()
        self._first: Row | None = None  # of a layout that is not believed yet
        self._line_seen = False
        self._units: dict[str, str] = {}  # settled
        self._factors = (1.0, 1.0, 1.0)
        self._kept: list[Row] = []
        self._clock: DeviceClock | None = None
        self._arrival = ArrivalClock(rate_hz)
        self._whole = False  # the clock counts whole milli- or microseconds
        self._count = Count(32)
        self._decimals = Decimals()
        self._newest: Row | None = None

    @property
    def temperature_c(self) -> float | None:
        """What the newest row says in a column named so, °C."""
        if self._newest is None or (place := self._newest[0].temperature) is None:
            return None
        return believed(number(self._newest[1][place]))

    def feed(self, data: bytes, host_ns: int) -> list[Sample]:
        """The samples that ``data``, arrived at ``host_ns``, completes; a datagram of lines is such data."""
        samples = []
        for i, line in enumerate(self._frames.feed(data)):
            follows = self._line_seen and i not in self._frames.breaks
            self._line_seen = True
            row = self._row(line, follows, host_ns)
            for each in self._agreed(row) if row is not None else ():
                samples += self._take(each)
        return samples

    # --- a line into a row ---

    def _row(self, raw: bytes, follows: bool, host_ns: int) -> Row | None:
        line = raw.decode("utf-8", "replace").strip()
        if not line:
            return None
        if line.startswith("{"):
            names, cells = flat_object(line)
        elif line.startswith("#"):
            self._comment(line)
            return None
        else:
            checked = unwrapped(line)
            if checked is None:
                self._frames.spoil(raw)
                return None
            names, cells = named_cells(checked)
            if self._columns and len(cells) == self._columns.count + 1 and not cells[-1]:
                cells = cells[:-1]
            header = find_columns(cells) if not names and are_words(cells) else None
            if header is not None:
                self._columns, self._units, self._decimals = header, {}, Decimals()
                return None
            if not follows or not checked.isascii():
                if not self._is_torn(raw, line, cells):
                    self.counters.dropped += 1
                return None
        columns = self._by_name(tuple(names)) if names else self._columns
        if columns is None or len(cells) != columns.count:
            if self._is_torn(raw, line, cells):
                return None
            self.counters.unknown += 1
            if not self._columns and not names:
                self._note(
                    "no header seen yet: reset the board so that it prints its header, or give columns="
                )
            return None
        if not self._decimals.hold(cells):
            self._frames.spoil(raw)
            return None
        return columns, cells, host_ns, raw

    def _is_torn(self, raw: bytes, line: str, cells: list[str]) -> bool:
        """Whether it was a row before it was damaged, which is then counted."""
        if self._newest is None:
            return False
        columns, _, _, sound = self._newest
        alike = word_before(line) == word_before(sound.decode("ascii", "replace"))
        torn = alike and is_torn(line, cells, columns.count)
        if torn:
            self._frames.spoil(raw)
        return torn

    def _by_name(self, names: tuple[str, ...]) -> Columns | None:
        if names not in self._named:
            if len(self._named) >= 16:  # a device has few layouts; rubbish must not be remembered
                self._named.clear()
            self._named[names] = find_columns(names)
        return self._named[names]

    def _comment(self, line: str) -> None:
        if not line.startswith(NATIVE):
            return
        self._columns = find_columns(_NATIVE_COLUMNS)
        for part in line.split(",")[2:]:
            key, _, unit = part.partition("=")
            kind = _NATIVE_KEYS.get(key, "")
            if kind and is_unit(kind, spelt(unit)):
                self._said.setdefault(kind, spelt(unit))

    def _agreed(self, row: Row) -> list[Row]:
        """The row, if its layout is believed, and before it the first of that layout, kept for it."""
        columns, first = row[0], self._first
        if columns is self._columns:  # a header's
            return [row]
        known = self._layouts.usual
        if not self._layouts.fits(columns):
            self._first = None if known else row
            if known or first:
                self._frames.spoil(row[3] if known or first is None else first[3])
            return []
        if self._layouts.usual is not known:
            self._units = {}
        self._first = None
        return [row] if first is None else [first, row]

    # --- a row into a sample ---

    def _take(self, row: Row) -> list[Sample]:
        if self._units:
            return self._read(row)
        columns = row[0]
        known = self._said | columns.units
        self._kept.append(row)
        needs_time = "time" not in known and columns.time is not None
        if ("force" not in known or needs_time) and len(self._kept) < _KEPT:
            return []
        kept, self._kept = self._kept, []
        settled = self._settle(known, kept)
        if settled is None:
            self.counters.dropped += len(kept)
            return []
        self._units = settled
        self._factors = (
            UNITS["force"][settled["force"]],
            UNITS["rate"][settled["rate"]],
            UNITS["field"][settled["field"]],
        )
        return [sample for each in kept for sample in self._read(each)]

    def _settle(self, known: Mapping[str, str], kept: list[Row]) -> dict[str, str] | None:
        """All four units; None where the force at rest fits none."""
        units = {kind: unit for kind, unit in known.items() if is_unit(kind, unit)}
        if "force" not in units:
            forces = [v for columns, cells, _, _ in kept if (v := triple(cells, columns.force)) is not None]
            unit = force_unit(median(math.hypot(*v) for v in forces)) if forces else None
            if unit is None:
                self._note(
                    "the unit of the accelerometer cannot be told: hold the sensor still, or give its unit"
                )
                return None
            units["force"] = unit
            self._note(f"accelerometer in {unit}: told by its reading at rest")
        if "rate" not in units:
            units["rate"] = "dps"
            self._note("gyroscope assumed in deg/s: its header does not say")
        if "field" not in units:
            units["field"] = "ut"
            self._note("magnetometer assumed in µT: its header does not say")
        if "time" not in units:
            units["time"] = time_unit(
                [cells[columns.time] for columns, cells, _, _ in kept if columns.time is not None]
            )
            self._note(f"time in {units['time']}: told by its steps")
        return units

    def _read(self, row: Row) -> list[Sample]:
        columns, cells, host_ns, _ = row
        force, rate = triple(cells, columns.force), triple(cells, columns.rate)
        field = None if columns.field is None else triple(cells, columns.field)
        sample = None
        missing = force is None or rate is None or (field is None and columns.field is not None)
        if missing and self._is_broken(row):
            return []
        if force is not None and rate is not None:
            self._newest = row
            self._count_lost(columns, cells)
            device_ns = self._stamp(columns, cells, host_ns)
            if device_ns is not None:
                f, w, m = self._factors
                field = None if field is None else scaled(field, m)
                q = quad(cells, columns.orientation)
                sample = self._maker.make(device_ns, host_ns, scaled(force, f), scaled(rate, w), field, 0, q)
        self.counters.dropped += sample is None
        return [] if sample is None else [sample]

    def _is_broken(self, row: Row) -> bool:
        """Whether a number of it was damaged, which is then counted."""
        columns, cells, _, raw = row
        broken = any(is_broken(cells[at]) for at in (*columns.force, *columns.rate, *(columns.field or ())))
        if broken:
            self._frames.spoil(raw)
        return broken

    def _stamp(self, columns: Columns, cells: list[str], host_ns: int) -> int | None:
        if columns.time is None:
            return self._arrival.stamp(host_ns)
        tick_ns = _TICKS_NS[self._units["time"]]
        cell = cells[columns.time]
        whole = cell.isascii() and cell.isdigit() and len(cell) <= 20 and tick_ns in (1000, 10**6)
        ticks = int(cell) if whole else nanoseconds(cell, tick_ns)
        if ticks is None:
            return None
        if self._clock is None:  # whole milli- and microseconds count in 32 bits and wrap
            self._clock = DeviceClock(tick_ns, 32) if whole else DeviceClock(1, 64)
            self._whole = whole
        return self._clock.stamp(ticks, host_ns) if whole == self._whole else None

    def _count_lost(self, columns: Columns, cells: list[str]) -> None:
        if columns.seq is None or not (cells[columns.seq].isascii() and cells[columns.seq].isdigit()):
            return
        self.counters.lost += self._count.missing(int(cells[columns.seq][:20]))

    def _note(self, sentence: str) -> None:
        if sentence not in self.notes:
            self.notes.append(sentence)


class LinesEncoder:
    """Samples as lines: a header that says every unit, then rows; or one JSON object a line.

    Six decimals. What every row has is chosen once: field, quaternion and temperature, or not.
    ``temperature_c`` is what its thermometer reads.
    """

    def __init__(
        self,
        axes: Axes = Z_UP,
        style: str = "csv",
        with_field: bool = True,
        with_orientation: bool = False,
        with_temperature: bool = False,
    ) -> None:
        self._taker = Taker(axes, RANGES["csv"])
        self._json = style == "json"
        self._names = ["t_us", *(f"a{axis}_mps2" for axis in "xyz"), *(f"g{axis}_radps" for axis in "xyz")]
        self._parts: list[Callable[[Sample], tuple[float, ...]]] = [self._taker.force, self._taker.rate]
        if with_field:
            self._names += [f"m{axis}_ut" for axis in "xyz"]
            self._parts.append(self._taker.field)
        if with_orientation:
            self._names += ["qw", "qx", "qy", "qz"]
            self._parts.append(self._taker.orientation)
        self.temperature_c = 25.0
        if with_temperature:
            self._names += ["temp_c"]
            self._parts.append(lambda _: (self.temperature_c,))
        self._begun = self._json

    def encode(self, sample: Sample) -> bytes:
        """The sample's line, and before the first the header."""
        numbers = [f"{number:.6f}" for part in self._parts for number in part(sample)]
        cells = [str(round(sample.device_ns / 1000)), *numbers]
        if self._json:
            inside = ",".join(f'"{name}":{cell}' for name, cell in zip(self._names, cells, strict=True))
            return b"{" + inside.encode() + b"}\n"
        header = "" if self._begun else ",".join(self._names) + "\r\n"
        self._begun = True
        return f"{header}{','.join(cells)}\r\n".encode()


class LinesDevice:
    """A board that prints: it takes nothing; its header comes once, at power-up."""

    rate_hz = FASTEST_HZ

    def __init__(self, axes: Axes = Z_UP, style: str = "csv") -> None:
        self._encoder = LinesEncoder(axes, style, with_temperature=True)

    def receive(self, _: bytes) -> bytes:
        """It does not listen."""
        return b""

    def measure(self, sample: Sample) -> bytes:
        """The line of a new measurement."""
        self._encoder.temperature_c = warming(sample.device_ns)
        return self._encoder.encode(sample)
