"""Shell: a recording in other people's formats: samples, ways, strides, maps, orientations."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.formats import geo, plain
from app.formats.sto import sto
from app.motion.basics import InputError
from app.motion.estimate import ATTITUDE, POSITION
from app.motion.recording import Recording
from app.outputs import tables
from app.outputs.files import write_new
from app.sources.opening import open_recording
from app.sources.spec import parse_spec

MAPS = {"gpx": geo.gpx, "kml": geo.kml, "geojson": geo.geojson}
_ENDINGS = {"strides": "_strides.csv", "csv": "_samples.csv"}
_POINTS_HZ = 10.0  # on a map


@dataclass(frozen=True)
class Wish:
    """What the command line says. ``declination_deg``: how far magnetic north lies east of true north."""

    kind: str
    out: Path | None
    origin: str | None
    declination_deg: float

    def place(self) -> geo.Origin | None:
        """The origin; ``InputError`` if a map is asked for without one."""
        if not abs(self.declination_deg) <= 180.0:
            raise InputError(f"--declination {self.declination_deg:g}: expected degrees east, −180 to 180")
        if self.kind in MAPS and self.origin is None:
            raise InputError(
                f"--format {self.kind}: a walk knows no place, expected --origin LATITUDE,LONGITUDE"
            )
        return geo.parse_origin(self.origin) if self.origin is not None else None

    def path(self, spec: str) -> Path:
        """Where to: beside the recording if nothing is said."""
        target = Path(parse_spec(spec).target)
        return self.out or target.with_name(target.stem + _ENDINGS.get(self.kind, f".{self.kind}"))


def samples(spec: str, wish: Wish) -> list[Path]:
    """The samples as plain CSV, which `process` and `walk` open."""
    recording, _ = open_recording(parse_spec(spec))
    return _write({wish.path(spec): plain.encode(recording)})


def walk(spec: str, wish: Wish, recording: Recording, feet: Sequence[tables.FootTable]) -> list[Path]:
    """The estimated walk; a file that exists is ``InputError``."""
    place, path = wish.place(), wish.path(spec)
    if wish.kind == "strides":
        return _write({path: _lines([tables.STRIDES, *tables.stride_lines(feet)])})
    if wish.kind == "tum":
        return _write({_of_foot(path, foot.foot, len(feet)): _lines(tables.tum_lines(foot)) for foot in feet})
    if wish.kind == "sto":
        roles = {samples.sensor: samples.role for samples in recording.sensors}
        ways = {roles[foot.foot]: (foot.t_s, foot.rows[:, ATTITUDE]) for foot in feet}
        return _write({path: sto(recording.sensors[0].rate_hz, ways)})
    assert place is not None
    every = [max(1, round(samples.rate_hz / _POINTS_HZ)) for samples in recording.sensors]
    paths = [
        geo.on_earth(foot.foot, foot.rows[::step, POSITION], place, math.radians(wish.declination_deg))
        for foot, step in zip(feet, every, strict=True)
    ]
    return _write({path: MAPS[wish.kind](recording.name, paths)})


def _of_foot(path: Path, foot: str, feet: int) -> Path:
    return path.with_name(f"{path.stem}_{foot}{path.suffix}") if feet > 1 else path


def _write(files: Mapping[Path, bytes]) -> list[Path]:
    for path, data in files.items():
        write_new(path, data)
    return list(files)


def _lines(lines: Iterable[str]) -> bytes:
    return "".join(line + "\n" for line in lines).encode()
